//! The board as the application wants it.

use core::fmt::Write as _;

use embedded_io::{Read, ReadReady, Write as _};

use super::Board as Drivers;
use super::framebuffer::Framebuffer;
use super::interrupts::{sleep_a_tick_unless, start_ticking, stop_ticking, unexpected_interrupts, with_usb};
use super::memory_map::MESH_FILE;
use super::mini_uart::Console;
use super::system_timer::{HERTZ, SystemTimer};
use crate::app::{Application, Memory};
use crate::board::Board;
use crate::intake::Intake;
use crate::left_in_memory;
use crate::pl011::Pl011;
use crate::serial::Link;
use crate::software_fpga::{self, ClockWait, ModelMemory, ModelPort, StartError};
use crate::usb::{Service, Taken, take_in};
use usb_input::Merge;

/// What the FPGA's VGA output shows, nearly: 59.94 frames in a second.
const FRAME_MICROSECONDS: u64 = 16_667;

/// The board, without its display, which the FPGA's stand-in has.
pub struct ViewerBoard {
    console: Console,
    link: Link<Pl011>,
    clock: SystemTimer,
    merge: Merge,
    /// When the next frame is due.
    next_frame: u64,
    /// Interrupts that nobody asked for, as far as the console was told.
    unexpected: u32,
}

/// Returns the application on this board.
///
/// # Errors
/// What did not start.
pub fn application(
    drivers: Drivers,
    model_memory: &'static mut ModelMemory,
    memory: &'static mut Memory,
) -> Result<Application<'static, ViewerBoard, ClockWait<SystemTimer>>, StartError> {
    let Drivers { console, link, display, clock } = drivers;
    let board = ViewerBoard { console, link, clock, merge: Merge::default(), next_frame: 0, unexpected: 0 };
    software_fpga::application(board, display, clock, model_memory, memory)
}

impl Board for ViewerBoard {
    const NAME: &'static str = "raspi2b";
    const LACKS: &'static str = "no FPGA here, the software model draws";
    const TICKS_PER_SECOND: u32 = HERTZ;
    type Console = Console;
    type Port = ModelPort<Framebuffer>;

    fn ticks(&self) -> u64 {
        self.clock.microseconds()
    }

    fn console(&mut self) -> &mut Console {
        &mut self.console
    }

    fn poll_controllers(&mut self, intake: &mut Intake) -> u32 {
        let next = || with_usb(Service::next_news).flatten();
        let Taken { unreadable, .. } = take_in(next, &mut self.merge, intake, &mut self.console);
        let unexpected = unexpected_interrupts();
        if unexpected != self.unexpected {
            self.unexpected = unexpected;
            let _ = writeln!(self.console, "{unexpected} interrupts came that nobody asked for, and are kept back");
        }
        let frozen = intake.state().frozen;
        with_usb(|usb| usb.set_frozen(frozen));
        unreadable
    }

    fn read_link(&mut self, buffer: &mut [u8]) -> usize {
        self.link.read(buffer).unwrap_or(0)
    }

    fn write_link(&mut self, bytes: &[u8]) {
        if let Err(error) = self.link.write_all(bytes) {
            let _ = writeln!(self.console, "link: {error}");
        }
    }

    fn picture_checksum(&mut self, port: &mut Self::Port) -> Option<u32> {
        Some(port.checksum())
    }

    fn mesh_file(&mut self) -> Option<&'static [u8]> {
        // SAFETY: the table maps the window, and nobody writes to it.
        unsafe { left_in_memory::window(MESH_FILE) }
    }

    fn pace(&mut self) {
        start_ticking();
        let (clock, due) = (self.clock, self.next_frame);
        while clock.microseconds() < due {
            sleep_a_tick_unless(|| clock.microseconds() >= due);
        }
        let now = clock.microseconds();
        // A frame that comes late puts the later ones off, so that they do not come in a burst.
        self.next_frame = if now > due + FRAME_MICROSECONDS { now } else { due } + FRAME_MICROSECONDS;
    }

    fn heartbeat(&mut self, _: u32) {}

    fn sleep(&mut self) {
        // A PC steps the frames: no tick may come in between and be counted with them.
        start_ticking();
        sleep_a_tick_unless(|| self.link.read_ready().unwrap_or(false));
        stop_ticking();
    }
}
