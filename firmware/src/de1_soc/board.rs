//! The board's drivers, set up and handed over once; and what happens after a fault.

use core::cell::Cell;
use core::fmt::Write as _;

use critical_section::Mutex;
use dwc2_host::SpeedLimit;
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::OutputPin;
use heapless::spsc::Queue;

use super::arguments::{self, ArgumentError, Asked, UsbWishes};
use super::blink::Blink;
use super::bridges::Bridges;
use super::fpga::Fpga;
use super::fpga_manager::FpgaManager;
use super::front_panel::FrontPanel;
use super::gpio::{Input, Output};
use super::history::{Note, Stage, Verdict};
use super::interrupts::{self, Sources};
use super::memory_map::{
    CLUSTER, FPGA_MANAGER, GPIO1, INTERCONNECT, KEY_BIT, LED_BIT, REGIONS, RESET_MANAGER, SYSTEM_MANAGER, UART,
    UART_HERTZ, UART_INTERRUPT, USB, USB_INTERRUPT, USB_MEMORY, WATCHDOG,
};
use super::reset_cause::ResetCause;
use super::reset_manager::{Peripheral, ResetManager};
use super::system_manager::SystemManager;
use super::uart16550::Uart16550;
use super::watchdog::Watchdog;
use crate::armv7a::exceptions::{Hooks, park};
use crate::armv7a::start::arguments_of_go;
use crate::armv7a::translation_table::TranslationTable;
use crate::cortex_a9::gic::{Distributor, Interface, InterruptId};
use crate::cortex_a9::global_timer::{Delay, GlobalTimer};
use crate::cortex_a9::l2c310::L2c310;
use crate::cortex_a9::private_timer::PrivateTimer;
use crate::cortex_a9::start;
use crate::mmio::Registers;
use crate::serial::{Config, Console, Link};
use crate::usb::{self, Dwc2Core, Now, Room, Service, TICK_MICROSECONDS};

/// Bytes that the link queues: about a third of a second at 115,200 baud.
const LINK_QUEUE: usize = 4096;
const SERIAL: Config = Config { clock_hertz: UART_HERTZ, baud: 115_200 };
/// The tick that ends every sleep, and at which the time is looked at.
const TICKS_PER_SECOND: u32 = (1_000_000 / TICK_MICROSECONDS) as u32;
/// How long the USB core is held in reset: it wants twelve clocks of its PHY, 60 MHz, at least
/// (Intel's HPS manual 683126, §19.4.4).
const USB_RESET_US: u32 = 10;

static TAKEN: Mutex<Cell<bool>> = Mutex::new(Cell::new(false));

/// The board's drivers, and what was found at the start.
pub(super) struct Board {
    /// Text on UART0.
    pub(super) console: Console<Uart16550>,
    /// Bytes on UART0, between the text.
    pub(super) link: Link<Uart16550>,
    /// Time since the start.
    pub(super) clock: GlobalTimer,
    /// The HPS LED.
    pub(super) led: Output,
    /// The HPS key; low is pressed.
    pub(super) key: Input,
    /// The FPGA, its bridges closed.
    pub(super) fpga: Fpga,
    /// The FPGA's keys, switches, LEDs and displays. Not to be touched while the bridges are closed.
    pub(super) panel: FrontPanel,
    /// How far the processor's start came.
    pub(super) start: start::Report,
    /// Why the board was reset.
    pub(super) cause: ResetCause,
    /// What follows from the last run's end.
    pub(super) verdict: Verdict,
    /// What U-Boot's `go` was told.
    pub(super) asked: Result<Asked, ArgumentError>,
}

impl Now for GlobalTimer {
    fn microseconds(self) -> u64 {
        self.microseconds()
    }
}

impl Board {
    /// Sets everything up and returns the drivers, `None` at every call but the first.
    ///
    /// Call it first of all, on the core that came from `_start`. Interrupts are on afterwards.
    #[must_use]
    pub(super) fn take() -> Option<Self> {
        // No atomic exchange: no MMU is on yet. The section masks interrupts, and the other core is in reset.
        if critical_section::with(|section| TAKEN.borrow(section).replace(true)) {
            return None;
        }
        // SAFETY: the MMU is off.
        let asked = arguments::asked(&unsafe { arguments::of_go(arguments_of_go()) });
        let resets = resets();
        resets.hold_core_1();
        // First, so that a fault has somewhere to be told.
        resets.release(Peripheral::Uart0);
        uart().configure(&SERIAL);
        let hooks = Hooks { write: write_last_words, stop: stop_after_fault };
        // Made here and not by the compiler: 16 KiB less to load.
        static mut TABLE: TranslationTable = TranslationTable::EMPTY;
        // SAFETY: the first call, so nobody else refers to the table, and `_start` was just before; the map is
        // this board's.
        let start = unsafe {
            let table = &mut *(&raw mut TABLE);
            table.map(REGIONS);
            start::bring_up(&CLUSTER, table, hooks)
        };
        // SAFETY: the first call, so these are the only drivers.
        Some(unsafe { Self::drivers(start, asked) })
    }

    /// # Safety
    /// Called once, with the MMU on and UART0 set up.
    unsafe fn drivers(start: start::Report, asked: Result<Asked, ArgumentError>) -> Self {
        static mut LINK_BYTES: Queue<u8, LINK_QUEUE> = Queue::new();
        static USB_ROOM: Room<GlobalTimer> = Room::new();

        let (resets, system) = (resets(), system());
        let cause = resets.take_cause();
        let verdict = Verdict::of(cause, system.note().and_then(Note::from_word));
        system.leave_note(Note { stage: Stage::Idle, failures: verdict.failures }.to_word());
        resets.release(Peripheral::Gpio1);

        // SAFETY: this function runs once, so nobody else refers to the queue; the addresses
        // are the board's, and each device gets one driver.
        unsafe {
            let clock = GlobalTimer::at(CLUSTER.global_timer(), CLUSTER.timer_hertz);
            clock.start();
            let (link, link_interrupt) = Link::new(uart(), (*&raw mut LINK_BYTES).split());
            let mut timer = PrivateTimer::at(CLUSTER.private_timer(), CLUSTER.timer_hertz);
            timer.stop();

            let mut interface = Interface::at(CLUSTER.interrupt_interface());
            interface.configure();
            let mut distributor = Distributor::at(CLUSTER.interrupt_distributor());
            distributor.configure();
            resets.hold(Peripheral::Usb1);
            Delay::new(clock).delay_us(USB_RESET_US);
            resets.release(Peripheral::Usb1);
            let core = Dwc2Core::at(USB, USB_MEMORY, clock, drain_to_memory);
            // What cannot be followed is told once there is a console.
            let wishes = asked.as_ref().map(|asked| asked.usb).unwrap_or_default();
            let usb = Service::new(&USB_ROOM, core, usb_config(wishes), clock).expect("the room is taken once");

            for interrupt in [InterruptId::PRIVATE_TIMER, UART_INTERRUPT, USB_INTERRUPT] {
                distributor.enable(interrupt);
            }
            interrupts::install(Sources {
                interface,
                distributor,
                timer: timer.interrupt(),
                link: link_interrupt,
                usb,
            });
            timer.start_periodic(TICKS_PER_SECOND);
            // Not inside a critical section: every one above has ended.
            cortex_ar::interrupt::enable();

            let pins = Registers::at(GPIO1);
            let fpga = Fpga::new(
                FpgaManager::new(Registers::at(FPGA_MANAGER)),
                Bridges::new(Registers::at(INTERCONNECT), resets, system),
                Watchdog::new(Registers::at(WATCHDOG), resets),
                system,
                verdict.failures,
            );
            Self {
                console: Console::new(uart()),
                link,
                clock,
                led: Output::new(pins, LED_BIT),
                key: Input::new(pins, KEY_BIT),
                fpga,
                panel: FrontPanel::new(Registers::at(fpga_regs::de1_soc::BOARD_IO)),
                start,
                cause,
                verdict,
                asked,
            }
        }
    }
}

fn usb_config(UsbWishes { full_speed, pulse }: UsbWishes) -> usb::Config {
    let limit = if full_speed { SpeedLimit::Full } else { SpeedLimit::High };
    usb::Config {
        controller: dwc2_host::Config::new().with_speed_limit(limit),
        devices: usb_input::Config { pulse_on_freeze: pulse, ..usb_input::Config::default() },
    }
}

/// Returns when what was stored in uncached memory has left the processor's and the L2 cache's write buffers, and
/// nothing that follows is loaded before.
fn drain_to_memory() {
    cortex_ar::asm::dsb();
    // SAFETY: the controller answers there; draining its buffers disturbs nobody.
    let mut cache = unsafe { L2c310::at(CLUSTER.l2_cache_controller) };
    // One that is stuck is off since the start.
    let _ = cache.drain();
}

/// The UART. Its drivers are this module's: console and link, and the last words after both.
fn uart() -> Uart16550 {
    // SAFETY: UART0 answers there, out of reset since `take`.
    Uart16550::new(unsafe { Registers::at(UART) })
}

/// The reset manager. Its changes never come from two places at once: there is one core, and no
/// interrupt handler has it.
fn resets() -> ResetManager {
    // SAFETY: it always answers.
    ResetManager::new(unsafe { Registers::at(RESET_MANAGER) })
}

/// The system manager, as the reset manager.
fn system() -> SystemManager {
    // SAFETY: it always answers.
    SystemManager::new(unsafe { Registers::at(SYSTEM_MANAGER) })
}

/// Writes to the console whatever state its driver is in.
fn write_last_words(text: &str) {
    // A bus master that nobody serves any more.
    resets().hold(Peripheral::Usb1);
    // The program ends; what was being written no longer matters.
    let _ = Console::new(uart()).write_str(text);
}

/// Resets the board after a fault or a panic was told, so that it runs again; but not for ever: after
/// [`FAILURES`](super::history::FAILURES) in a row it stays, its LED fast.
fn stop_after_fault() -> ! {
    let note = Note::of_fault(system().note().and_then(Note::from_word));
    system().leave_note(note.to_word());
    let stays = note.is_last();
    let what = if stays { "it happened too often: reset the board by hand" } else { "the board is reset" };
    write_last_words(what);
    write_last_words("\n");
    let _ = Console::new(uart()).flush();
    if !stays {
        resets().request_warm_reset();
        park();
    }
    // A watchdog that runs would reset the board after all.
    resets().hold(Peripheral::Watchdog0);
    resets().release(Peripheral::Gpio1);
    // SAFETY: the program ends, and nobody else drives the LED or sets the clock.
    let (pins, clock) = unsafe { (Registers::at(GPIO1), GlobalTimer::at(CLUSTER.global_timer(), CLUSTER.timer_hertz)) };
    let mut led = Output::new(pins, LED_BIT);
    // It may not have been started yet.
    clock.start();
    loop {
        let _ = led.set_state(Blink::Fault.is_lit(clock.microseconds() / 1_000).into());
    }
}
