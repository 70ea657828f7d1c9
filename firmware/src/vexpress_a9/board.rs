//! The board, set up and handed over once.

use super::interrupts::{self, Sources};
use super::leds::Led;
use super::log;
use super::memory_map::{
    CLUSTER, CONSOLE, DISPLAY, FRAMES, KEYBOARD, KEYBOARD_HERTZ, KEYBOARD_INTERRUPT, LINK, LINK_INTERRUPT,
    TRANSLATION_TABLE, UART_HERTZ, USER_LEDS,
};
use super::pl050::Keyboard;
use super::pl111::Pl111;
use crate::armv7a::exceptions::Hooks;
use crate::armv7a::semihosting;
use crate::cortex_a9::gic::{Distributor, Interface, InterruptId};
use crate::cortex_a9::global_timer::{Delay, GlobalTimer};
use crate::cortex_a9::private_timer::PrivateTimer;
use crate::cortex_a9::start;
use crate::pl011::Pl011;
use crate::serial::{Config, Console, Link};
use core::cell::Cell;
use core::fmt::Write;
use critical_section::Mutex;
use heapless::spsc::Queue;

/// Exit code of a program that panicked or faulted (what a Rust program on a PC has, too).
const FAILED: u32 = 101;
/// Bytes that the link queues: about a third of a second at 115,200 baud.
const LINK_QUEUE: usize = 4096;
/// Bytes that the keyboard queues.
const KEYBOARD_QUEUE: usize = 64;

const SERIAL: Config = Config { clock_hertz: UART_HERTZ, baud: 115_200 };

static TAKEN: Mutex<Cell<bool>> = Mutex::new(Cell::new(false));

/// The board's drivers. The log has none: `defmt`'s macros reach it from anywhere.
pub struct Board {
    /// Text on UART0.
    pub console: Console<Pl011>,
    /// Bytes on UART1.
    pub link: Link<Pl011>,
    /// The PS/2 keyboard.
    pub keyboard: Keyboard,
    /// 640 × 480 pixels.
    pub display: Pl111,
    /// Time since start.
    pub clock: GlobalTimer,
    /// Delays.
    pub delay: Delay,
    /// Periodic interrupt, counted by [`ticks`](super::ticks), or stopwatch. Stopped.
    pub timer: PrivateTimer,
    /// User LEDs, off.
    pub leds: [Led; 8],
    /// How far the processor's start came.
    pub start: start::Report,
}

impl Board {
    /// Sets everything up and returns the drivers, `None` at every call but the first.
    ///
    /// Call it first of all, on the core that came from `_start`: until then, no MMU is on, and
    /// an atomic exchange may hang. Interrupts are on afterwards.
    #[must_use]
    pub fn take() -> Option<Self> {
        if critical_section::with(|section| TAKEN.borrow(section).replace(true)) {
            return None;
        }
        let hooks = Hooks { write: write_last_words, stop: || exit(FAILED) };
        // SAFETY: the first call, so `_start` was just before; the map is this board's.
        let start = unsafe { start::bring_up(&CLUSTER, &TRANSLATION_TABLE, hooks) };
        // SAFETY: the first call, so these are the only drivers.
        Some(unsafe { Self::drivers(start) })
    }

    /// # Safety
    /// Called once, with the MMU on.
    unsafe fn drivers(start: start::Report) -> Self {
        static mut LINK_BYTES: Queue<u8, LINK_QUEUE> = Queue::new();
        static mut KEYBOARD_BYTES: Queue<u8, KEYBOARD_QUEUE> = Queue::new();

        // SAFETY: this function runs once, so nobody else refers to the queues; the addresses
        // are the board's, and each device gets one driver.
        unsafe {
            let clock = GlobalTimer::at(CLUSTER.global_timer(), CLUSTER.timer_hertz);
            clock.start();
            log::start();
            let console = Console::new(Pl011::new(CONSOLE, &SERIAL));
            let (link, link_interrupt) = Link::new(Pl011::new(LINK, &SERIAL), (*&raw mut LINK_BYTES).split());
            let (keyboard, keyboard_interrupt) =
                Keyboard::new(KEYBOARD, KEYBOARD_HERTZ, (*&raw mut KEYBOARD_BYTES).split());
            let mut timer = PrivateTimer::at(CLUSTER.private_timer(), CLUSTER.timer_hertz);
            timer.stop();

            let mut interface = Interface::at(CLUSTER.interrupt_interface());
            interface.configure();
            interrupts::install(Sources {
                interface,
                timer: timer.interrupt(),
                link: link_interrupt,
                keyboard: keyboard_interrupt,
            });
            let mut distributor = Distributor::at(CLUSTER.interrupt_distributor());
            distributor.configure();
            for interrupt in [InterruptId::PRIVATE_TIMER, LINK_INTERRUPT, KEYBOARD_INTERRUPT] {
                distributor.enable(interrupt);
            }
            // Not inside a critical section: every one above has ended.
            cortex_ar::interrupt::enable();

            Self {
                console,
                link,
                keyboard,
                display: Pl111::new(DISPLAY, FRAMES),
                clock,
                delay: Delay::new(clock),
                timer,
                leds: Led::all(USER_LEDS),
                start,
            }
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
    let mut console = Console::new(unsafe { Pl011::steal(CONSOLE) });
    let _ = console.write_str(text);
}
