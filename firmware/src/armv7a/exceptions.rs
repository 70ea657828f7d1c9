//! What is said and done when the program cannot go on: a fault or a panic.
//!
//! The board says where the words go and how to stop ([`Hooks`]); before it did, a fault parks the
//! core. A report looks like
//!
//! ```text
//! data abort: write to 0x50000000: nothing is mapped there
//!   instruction at 0x600012a4, DFSR 0x00000805
//!   r0   50000000  r1   00000001  r2   60013b44  r3   00000000
//!   …
//! ```

use super::fault_frame::FaultFrame;
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

/// Writes a report, with the registers of the program where it was interrupted, and stops.
fn report(text: fmt::Arguments<'_>, frame: Option<&FaultFrame>) -> ! {
    cortex_ar::interrupt::disable();
    let Some(hooks) = critical_section::with(|section| HOOKS.borrow(section).take()) else { park() };
    // A console that fails has nobody to be told.
    let mut console = Console(hooks.write);
    let _ = writeln!(console, "\n{text}");
    if let Some(frame) = frame {
        let _ = write!(console, "{frame}");
    }
    (hooks.stop)()
}

/// Sleeps for ever, with interrupts masked.
pub fn park() -> ! {
    cortex_ar::interrupt::disable();
    loop {
        cortex_ar::asm::wfi();
    }
}

extern "C" fn data_abort(frame: &FaultFrame) -> ! {
    let (status, instruction) = (FaultStatus(Dfsr::read().raw_value()), frame.pc);
    let (access, cause) = (if status.is_write() { "write to" } else { "read from" }, status.cause());
    let raw = status.0;
    if status.has_address() {
        let address = Dfar::read().0;
        report(
            format_args!(
                "data abort: {access} {address:#010x}: {cause}\n  instruction at {instruction:#010x}, DFSR {raw:#010x}"
            ),
            Some(frame),
        )
    } else {
        report(format_args!("data abort: {cause}\n  noticed at {instruction:#010x}, DFSR {raw:#010x}"), Some(frame))
    }
}

extern "C" fn prefetch_abort(frame: &FaultFrame) -> ! {
    let (address, raw) = (Ifar::read().0, Ifsr::read().raw_value());
    let (cause, instruction) = (FaultStatus(raw).cause(), frame.pc);
    report(
        format_args!(
            "prefetch abort: fetch from {address:#010x}: {cause}\n  instruction at {instruction:#010x}, IFSR {raw:#010x}"
        ),
        Some(frame),
    )
}

extern "C" fn undefined(frame: &FaultFrame) -> ! {
    report(format_args!("undefined instruction at {:#010x}", frame.undefined_instruction()), Some(frame))
}

// The entries from the vectors, in place of cortex-a-rt's, which do not hand on the registers. They keep them in a
// `FaultFrame` on the stack of the exception's mode. The program runs in system mode alone.
core::arch::global_asm!(
    r#"
    .macro fault_entry name, behind, handler
    .section .text.\name, "ax"
    .global \name
    .type \name, %function
    \name:
        sub     lr, lr, #\behind            // where it happened
        sub     sp, sp, #72                 // 17 words, on a multiple of 8
        stmia   sp, {{r0-r12}}
        add     r0, sp, #52
        stmia   r0, {{sp, lr}}^               // system mode's
        nop
        mrs     r1, spsr
        str     lr, [sp, #60]
        str     r1, [sp, #64]
        mov     r0, sp
        bl      \handler
    .size \name, . - \name
    .endm

    fault_entry _asm_undefined_handler, 4, {undefined}
    fault_entry _asm_prefetch_abort_handler, 4, {prefetch_abort}
    fault_entry _asm_data_abort_handler, 8, {data_abort}
    "#,
    undefined = sym undefined,
    prefetch_abort = sym prefetch_abort,
    data_abort = sym data_abort,
);

/// Comes back: a semihosting call (SVC 0x123456) ends here when no emulator takes it.
#[exception(SupervisorCall)]
fn supervisor_call(_number: u32) {}

#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    match info.location() {
        Some(place) => report(
            format_args!("panic at {}:{}:{}: {}", place.file(), place.line(), place.column(), info.message()),
            None,
        ),
        None => report(format_args!("panic: {}", info.message()), None),
    }
}
