//! What is said and done when the program cannot go on: a fault or a panic.
//!
//! The board says where the words go and how to stop ([`Hooks`]); before it did, a fault parks the
//! core. A report looks like
//!
//! ```text
//! data abort: write to 0x50000000: nothing is mapped there
//!   instruction at 0x600012a4, DFSR 0x00000805
//! ```

use super::fault_status::FaultStatus;
use core::cell::Cell;
use core::fmt::{self, Write};
use core::panic::PanicInfo;
use cortex_a_rt::exception;
use cortex_ar::register::{Dfar, Dfsr, Ifar, Ifsr};
use critical_section::Mutex;

/// What a board does for a report.
#[derive(Clone, Copy)]
pub struct Hooks {
    /// Writes text to the console without interrupts and without waiting for ever.
    pub write: fn(&str),
    /// Stops the machine as failed.
    pub stop: fn() -> !,
}

/// Taken out by the first report, so that a fault inside a report stops at once.
static HOOKS: Mutex<Cell<Option<Hooks>>> = Mutex::new(Cell::new(None));

/// Says where reports go.
pub fn install(hooks: Hooks) {
    critical_section::with(|section| HOOKS.borrow(section).set(Some(hooks)));
}

/// The board's console, as far as a report needs it.
struct Console(fn(&str));

impl Write for Console {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        (self.0)(text);
        Ok(())
    }
}

/// Writes a report and stops.
fn report(text: fmt::Arguments<'_>) -> ! {
    cortex_ar::interrupt::disable();
    let Some(hooks) = critical_section::with(|section| HOOKS.borrow(section).take()) else { park() };
    // A console that fails has nobody to be told.
    let _ = writeln!(Console(hooks.write), "\n{text}");
    (hooks.stop)()
}

/// Sleeps for ever, with interrupts masked.
pub fn park() -> ! {
    cortex_ar::interrupt::disable();
    loop {
        cortex_ar::asm::wfi();
    }
}

#[exception(DataAbort)]
fn data_abort(instruction: usize) -> ! {
    let status = FaultStatus(Dfsr::read().raw_value());
    let (access, cause) = (if status.is_write() { "write to" } else { "read from" }, status.cause());
    let raw = status.0;
    if status.has_address() {
        let address = Dfar::read().0;
        report(format_args!(
            "data abort: {access} {address:#010x}: {cause}\n  instruction at {instruction:#010x}, DFSR {raw:#010x}"
        ))
    } else {
        report(format_args!("data abort: {cause}\n  noticed at {instruction:#010x}, DFSR {raw:#010x}"))
    }
}

#[exception(PrefetchAbort)]
fn prefetch_abort(instruction: usize) -> ! {
    let (address, raw) = (Ifar::read().0, Ifsr::read().raw_value());
    let cause = FaultStatus(raw).cause();
    report(format_args!(
        "prefetch abort: fetch from {address:#010x}: {cause}\n  instruction at {instruction:#010x}, IFSR {raw:#010x}"
    ))
}

#[exception(Undefined)]
fn undefined(instruction: usize) -> ! {
    report(format_args!("undefined instruction at {instruction:#010x}"))
}

/// Comes back: a semihosting call (SVC 0x123456) ends here when no emulator takes it.
#[exception(SupervisorCall)]
fn supervisor_call(_number: u32) {}

#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    match info.location() {
        Some(place) => {
            report(format_args!("panic at {}:{}:{}: {}", place.file(), place.line(), place.column(), info.message()))
        }
        None => report(format_args!("panic: {}", info.message())),
    }
}
