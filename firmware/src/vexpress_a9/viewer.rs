//! The board as the application wants it.

use controls::Report;
use embedded_hal::digital::OutputPin;
use embedded_io::{Read, ReadReady, Write};

use super::memory_map::MESH_FILE;
use super::pl050::Keyboard;
use super::pl111::Pl111;
use super::{Board as Drivers, leds::Led, ticks};
use crate::app::{Application, Memory};
use crate::armv7a::sleep::sleep_unless;
use crate::board::Board;
use crate::cortex_a9::global_timer::{Delay, GlobalTimer};
use crate::cortex_a9::private_timer::PrivateTimer;
use crate::intake::Intake;
use crate::left_in_memory;
use crate::pl011::Pl011;
use crate::serial::{Console, Link};
use crate::software_fpga::{self, ClockWait, ModelMemory, ModelPort, StartError};

/// What the FPGA's VGA output shows, nearly: 59.94 in a second.
const FRAMES_PER_SECOND: u32 = 60;
/// Frames between two lines in the log.
const FRAMES_A_LOG_LINE: u32 = 60;

/// The board, without its display, which the FPGA's stand-in has.
pub struct ViewerBoard {
    console: Console<Pl011>,
    link: Link<Pl011>,
    keyboard: Keyboard,
    clock: GlobalTimer,
    timer: PrivateTimer,
    heartbeat: Led,
    /// The timer's tick at which the last frame ended; `None` while it is stopped.
    last_tick: Option<u32>,
}

/// Returns the application on this board.
///
/// # Errors
/// What did not start.
pub fn application(
    drivers: Drivers,
    model_memory: &'static mut ModelMemory,
    memory: &'static mut Memory,
) -> Result<Application<'static, ViewerBoard, ClockWait<Delay>>, StartError> {
    let Drivers { console, link, keyboard, display, clock, delay, timer, leds: [heartbeat, ..], .. } = drivers;
    let board = ViewerBoard { console, link, keyboard, clock, timer, heartbeat, last_tick: None };
    software_fpga::application(board, display, delay, model_memory, memory)
}

impl Board for ViewerBoard {
    const NAME: &'static str = "vexpress-a9";
    const LACKS: &'static str = "no FPGA here, the software model draws; no USB, the keyboard is PS/2";
    const TICKS_PER_SECOND: u32 = super::memory_map::CLUSTER.timer_hertz;
    type Console = Console<Pl011>;
    type Port = ModelPort<Pl111>;

    fn ticks(&self) -> u64 {
        self.clock.ticks()
    }

    fn console(&mut self) -> &mut Self::Console {
        &mut self.console
    }

    fn poll_controllers(&mut self, intake: &mut Intake) -> u32 {
        let mut unreadable = 0;
        while let Some(report) = self.keyboard.poll() {
            unreadable += u32::from(intake.accept(Report::Keyboard(&report)).is_err());
        }
        unreadable
    }

    fn read_link(&mut self, buffer: &mut [u8]) -> usize {
        self.link.read(buffer).unwrap_or(0)
    }

    fn write_link(&mut self, bytes: &[u8]) {
        if let Err(error) = self.link.write_all(bytes) {
            defmt::error!("link: {}", defmt::Display2Format(&error));
        }
    }

    fn picture_checksum(&mut self, port: &mut ModelPort<Pl111>) -> Option<u32> {
        Some(port.checksum())
    }

    fn mesh_file(&mut self) -> Option<&'static [u8]> {
        // SAFETY: the table maps the window, and nobody writes to it.
        unsafe { left_in_memory::window(MESH_FILE) }
    }

    fn pace(&mut self) {
        match self.last_tick {
            None => self.timer.start_periodic(FRAMES_PER_SECOND),
            // Other interrupts end a sleep, too.
            Some(last) => {
                while ticks() == last {
                    sleep_unless(|| ticks() != last);
                }
            }
        }
        self.last_tick = Some(ticks());
    }

    fn heartbeat(&mut self, frame: u32) {
        let _ = self.heartbeat.set_state((frame & 16 != 0).into());
        if frame.is_multiple_of(FRAMES_A_LOG_LINE) {
            defmt::info!("{=u32} frames", frame);
        }
    }

    fn sleep(&mut self) {
        // A PC steps the frames: no tick may come in between and be counted with them.
        self.timer.stop();
        self.last_tick = None;
        sleep_unless(|| self.link.read_ready().unwrap_or(false));
    }
}
