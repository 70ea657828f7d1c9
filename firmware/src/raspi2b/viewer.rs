//! The board as the application wants it.

use embedded_io::{Read, ReadReady, Write};

use super::Board as Drivers;
use super::framebuffer::Framebuffer;
use super::mini_uart::Console;
use super::system_timer::{Alarm, HERTZ, SystemTimer};
use crate::app::{Application, Memory};
use crate::armv7a::sleep::sleep_unless;
use crate::board::Board;
use crate::intake::Intake;
use crate::pl011::Link;
use crate::software_fpga::{self, ClockWait, ModelMemory, ModelPort, StartError};

/// What the FPGA's VGA output shows, nearly: 59.94 frames in a second.
const FRAME_MICROSECONDS: u64 = 16_667;

/// The board, without its display, which the FPGA's stand-in has.
pub struct ViewerBoard {
    console: Console,
    link: Link,
    clock: SystemTimer,
    alarm: Alarm,
    /// When the next frame is due.
    next_frame: u64,
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
    let Drivers { console, link, display, clock, alarm } = drivers;
    let board = ViewerBoard { console, link, clock, alarm, next_frame: 0 };
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

    fn poll_controllers(&mut self, _: &mut Intake) -> u32 {
        0
    }

    fn read_link(&mut self, buffer: &mut [u8]) -> usize {
        self.link.read(buffer).unwrap_or(0)
    }

    fn write_link(&mut self, bytes: &[u8]) {
        if let Err(error) = self.link.write_all(bytes) {
            let _ = core::fmt::Write::write_fmt(&mut self.console, format_args!("link: {error}\n"));
        }
    }

    fn picture_checksum(&mut self, port: &mut Self::Port) -> Option<u32> {
        Some(port.checksum())
    }

    fn pace(&mut self) {
        let due = self.next_frame;
        let (clock, alarm) = (self.clock, self.alarm);
        // Other interrupts end a sleep, too.
        while clock.microseconds() < due && alarm.set(due) {
            sleep_unless(|| clock.microseconds() >= due);
        }
        let now = clock.microseconds();
        // A frame that comes late puts the later ones off, so that they do not come in a burst.
        self.next_frame = if now > due + FRAME_MICROSECONDS { now } else { due } + FRAME_MICROSECONDS;
    }

    fn heartbeat(&mut self, _: u32) {}

    fn sleep(&mut self) {
        sleep_unless(|| self.link.read_ready().unwrap_or(false));
    }
}
