//! How the driver starts, and what it refuses to start on.

use fpga_regs::error::NotConfigured;
use fpga_regs::registers::{Capabilities, Control, ID_HALF, Screen, VERSION_MAJOR, Version};
use fpga_regs::screen::{HEIGHT, WIDTH};

use super::*;

#[test]
fn the_start_is_this_and_nothing_else() {
    let mock = Mock::new(Behaviour::default());
    let version = Version::default().with_major(VERSION_MAJOR).0;
    let screen = HEIGHT << 16 | WIDTH;
    let capabilities = 1 << 24 | 1 << 16 | 1024;
    Renderer::new(mock.clone(), mock.clone(), Timeouts::default()).expect("the device is as it should be");
    // Reset is bit 1; enable bit 0, the four interrupts bits 8 to 11.
    let expected = [
        Access::Configured,
        Access::Read(Register::Id, ID_HALF),
        Access::Read(Register::Version, version),
        Access::Read(Register::Screen, screen),
        Access::Read(Register::Capabilities, capabilities),
        Access::Write(Register::Control, 0x002),
        Access::Read(Register::Control, 0),
        Access::Write(Register::LowWater, 512),
        Access::Write(Register::Control, 0xF01),
    ];
    assert_eq!(*mock.journal(), expected);
}

#[test]
fn interrupts_are_enabled_only_where_both_sides_have_them() {
    let last_control = |mock: &Mock| match mock.journal().last() {
        Some(Access::Write(Register::Control, value)) => Control(*value),
        other => panic!("the start ended with {other:?}"),
    };
    let expected = Control::default().with_enable(true);
    let mock = Mock::new(Behaviour { interrupt: false, ..Behaviour::default() });
    Renderer::new(mock.clone(), mock.clone(), Timeouts::default()).expect("it starts");
    assert_eq!(last_control(&mock), expected);
    let mock = Mock::new(Behaviour::default());
    Renderer::new(mock.clone(), Polled(mock.clone()), Timeouts::default()).expect("it starts");
    assert_eq!(last_control(&mock), expected);
}

#[test]
fn an_fpga_that_is_not_configured_is_not_touched() {
    for manager_mode in [0, 1, 2, 3, 5, 7] {
        let mock = Mock::new(Behaviour { manager_mode, ..Behaviour::default() });
        assert_eq!(refused(&mock), RenderError::NotConfigured(NotConfigured { mode: manager_mode }));
        assert_eq!(*mock.journal(), [Access::Configured], "mode {manager_mode}");
    }
}

#[test]
fn a_device_that_is_not_ours_is_read_up_to_where_it_differs_and_never_written() {
    let version = |major: u16, minor: u16| Version::default().with_major(major).with_minor(minor).0;
    let screen = |width: u16, height: u16| Screen::default().with_width(width).with_height(height).0;
    let capabilities = |depth: u16, units: u8| Capabilities::default().with_fifo_depth(depth).with_pixel_units(units).0;
    let cases = [
        (Register::Id, 0, RenderError::WrongId { found: 0 }, 1),
        (Register::Id, u32::MAX, RenderError::WrongId { found: u32::MAX }, 1),
        (Register::Id, ID_HALF.swap_bytes(), RenderError::WrongId { found: ID_HALF.swap_bytes() }, 1),
        (Register::Version, version(2, 0), RenderError::WrongVersion { major: 2, minor: 0 }, 2),
        (Register::Version, version(0, 9), RenderError::WrongVersion { major: 0, minor: 9 }, 2),
        (Register::Screen, screen(640, 480), RenderError::WrongScreen { width: 640, height: 480 }, 3),
        (Register::Screen, screen(240, 320), RenderError::WrongScreen { width: 240, height: 320 }, 3),
        (
            Register::Capabilities,
            capabilities(21, 1),
            RenderError::WrongCapabilities { fifo_depth: 21, pixel_units: 1 },
            4,
        ),
        (
            Register::Capabilities,
            capabilities(1024, 0),
            RenderError::WrongCapabilities { fifo_depth: 1024, pixel_units: 0 },
            4,
        ),
    ];
    for (register, answer, expected, reads) in cases {
        let mock = Mock::new(Behaviour::default());
        mock.answer(register, answer);
        assert_eq!(refused(&mock), expected);
        let journal = mock.take_journal();
        assert!(journal[1..].iter().all(|access| matches!(access, Access::Read(..))), "{expected:?}: {journal:?}");
        assert_eq!(journal.len(), 1 + reads, "{expected:?}: {journal:?}");
    }
}

#[test]
fn a_newer_minor_version_and_the_smallest_fifo_will_do() {
    let mock = Mock::new(Behaviour { fifo_depth: 34, ..Behaviour::default() });
    mock.answer(Register::Version, Version::default().with_major(VERSION_MAJOR).with_minor(999).0);
    assert!(Renderer::new(mock.clone(), mock.clone(), Timeouts::default()).is_ok());
}

#[test]
fn a_reset_that_sticks_is_given_up_after_its_time_and_not_before() {
    let mock = Mock::new(Behaviour { reset_sticks: true, ..Behaviour::default() });
    let error = Renderer::new(mock.clone(), Polled(mock.clone()), Timeouts::default()).expect_err("it sticks");
    assert_eq!(error, RenderError::ResetStuck { waited_us: 1_000 });
    assert_eq!(waited_us(&mock.journal()), 1_000);
}
