//! The board, set up and handed over once.

use super::framebuffer::{Framebuffer, FramebufferError};
use super::interrupt_controller::InterruptController;
use super::interrupts::{self, Sources};
use super::mailbox::Mailbox;
use super::memory_map::{
    AUXILIARY, CONSOLE_HERTZ, GPU_MEMORY, GPU_MEMORY_END, INTERRUPT_CONTROLLER, LINK, LINK_HERTZ, LINK_INTERRUPT,
    MAILBOX, MAILBOX_MESSAGE, SYSTEM_TIMER, TIMER_INTERRUPT, TRANSLATION_TABLE, USB, USB_INTERRUPT, USB_MEMORY,
};
use super::mini_uart::Console;
use super::system_timer::SystemTimer;
use crate::armv7a::exceptions::Hooks;
use crate::armv7a::semihosting;
use crate::cortex_a7;
use crate::pl011::Pl011;
use crate::serial::{Config, Link};
use crate::usb::{self, Dwc2Core, Now, Room, Service, TICK_MICROSECONDS};
use core::cell::Cell;
use core::fmt::Write;
use critical_section::Mutex;
use heapless::spsc::Queue;

/// Exit code of a program that panicked or faulted (what a Rust program on a PC has, too).
const FAILED: u32 = 101;
/// Bytes that the link queues: about a third of a second at 115,200 baud.
const LINK_QUEUE: usize = 4096;
const BAUD: u32 = 115_200;
/// QEMU's model lets a channel run for ever whose device has gone, or is one of the PC's and has
/// nothing to say: neither is a fault.
const USB_CONTROLLER: dwc2_host::Config = dwc2_host::Config::new().with_patient_interrupts(true);

static TAKEN: Mutex<Cell<bool>> = Mutex::new(Cell::new(false));

/// The board's drivers.
pub struct Board {
    /// Text on the mini UART.
    pub console: Console,
    /// Bytes on UART0.
    pub link: Link<Pl011>,
    /// 640 × 480 pixels.
    pub display: Framebuffer,
    /// Time since power on, and delays.
    pub clock: SystemTimer,
}

impl Now for SystemTimer {
    fn microseconds(self) -> u64 {
        self.microseconds()
    }
}

impl Board {
    /// Sets everything up and returns the drivers, `None` at every call but the first.
    ///
    /// Call it first of all, on the core that came from `_start`: until then, no MMU is on, and
    /// an atomic exchange may hang. Interrupts are on afterwards.
    ///
    /// # Errors
    /// [`FramebufferError`] when there is no display.
    #[must_use]
    pub fn take() -> Option<Result<Self, FramebufferError>> {
        if critical_section::with(|section| TAKEN.borrow(section).replace(true)) {
            return None;
        }
        let hooks = Hooks { write: write_last_words, stop: || exit(FAILED) };
        // SAFETY: the first call, so `_start` was just before; the map is this board's. These are
        // then the only drivers.
        Some(unsafe {
            cortex_a7::bring_up(&TRANSLATION_TABLE, hooks);
            Self::drivers()
        })
    }

    /// # Safety
    /// Called once, with the MMU on.
    unsafe fn drivers() -> Result<Self, FramebufferError> {
        static mut LINK_BYTES: Queue<u8, LINK_QUEUE> = Queue::new();
        static USB_ROOM: Room<SystemTimer> = Room::new();

        // SAFETY: this function runs once, so nobody else refers to the queue; the addresses
        // are the board's, and each device gets one driver. The table maps the GPU's memory.
        unsafe {
            // First, so that a fault has somewhere to be told.
            let console = Console::new(AUXILIARY, CONSOLE_HERTZ, BAUD);
            let serial = Config { clock_hertz: LINK_HERTZ, baud: BAUD };
            let (link, link_interrupt) = Link::new(Pl011::new(LINK, &serial), (*&raw mut LINK_BYTES).split());
            let clock = SystemTimer::at(SYSTEM_TIMER);
            let display = Framebuffer::new(Mailbox::at(MAILBOX, MAILBOX_MESSAGE), GPU_MEMORY..GPU_MEMORY_END)?;

            let controller = InterruptController::at(INTERRUPT_CONTROLLER);
            controller.configure();
            let core = Dwc2Core::at(USB, USB_MEMORY, clock, cortex_ar::asm::dsb);
            let config = usb::Config { controller: USB_CONTROLLER, devices: usb_input::Config::default() };
            let usb = Service::new(&USB_ROOM, core, config, clock).expect("the room is taken once");
            let ticker = clock.ticker(TICK_MICROSECONDS);
            interrupts::install(Sources { controller, ticker, link: link_interrupt, usb });
            for interrupt in [TIMER_INTERRUPT, LINK_INTERRUPT, USB_INTERRUPT] {
                controller.enable(interrupt);
            }
            // Not inside a critical section: every one above has ended.
            cortex_ar::interrupt::enable();
            Ok(Self { console, link, display, clock })
        }
    }
}

/// Ends the emulator with an exit code, when it runs with `-semihosting`; else sleeps for ever.
pub fn exit(code: u32) -> ! {
    semihosting::exit(code)
}

/// Writes to the console whatever state its driver is in.
fn write_last_words(text: &str) {
    // SAFETY: the program ends; what its driver was writing no longer matters.
    let mut console = unsafe { Console::steal(AUXILIARY) };
    let _ = console.write_str(text);
}
