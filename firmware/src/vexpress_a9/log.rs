//! The log: defmt frames on UART2, in defmt's default encoding (rzCOBS).

use super::memory_map::{CLUSTER, LOG, UART_HERTZ};
use crate::cortex_a9::global_timer::GlobalTimer;
use crate::pl011::Pl011;
use crate::serial::{Config, Transmitter};
use core::cell::{Cell, RefCell};
use critical_section::{CriticalSection, Mutex, RestoreState};
use defmt::Encoder;
use embedded_io::Write;

#[defmt::global_logger]
struct Logger;

struct State {
    line: RefCell<Option<Transmitter<Pl011>>>,
    encoder: RefCell<Encoder>,
    /// What to restore when the frame that is open ends; `None` while none is.
    open: Cell<Option<RestoreState>>,
}

static STATE: Mutex<State> =
    Mutex::new(State { line: RefCell::new(None), encoder: RefCell::new(Encoder::new()), open: Cell::new(None) });

defmt::timestamp!("{=u64:us}", now());

/// Microseconds since start.
fn now() -> u64 {
    // SAFETY: this copy reads the time, and writes nothing.
    unsafe { GlobalTimer::at(CLUSTER.global_timer(), CLUSTER.timer_hertz) }.microseconds()
}

/// Opens the line; what was logged before is lost.
///
/// # Safety
/// Called once; nothing else drives UART2.
pub(super) unsafe fn start() {
    // SAFETY: the caller's promise is the same.
    let uart = unsafe { Pl011::new(LOG, &Config { clock_hertz: UART_HERTZ, baud: 115_200 }) };
    let line = Transmitter::new(uart);
    critical_section::with(|section| STATE.borrow(section).line.replace(Some(line)));
}

impl State {
    /// Sends encoded bytes. A line that is stuck loses them: the log must not stop the program.
    fn send(&self, bytes: &[u8]) {
        if let Some(line) = self.line.borrow_mut().as_mut() {
            let _ = line.write_all(bytes);
        }
    }
}

/// Runs `work` on the logger's state.
///
/// # Safety
/// Between `acquire` and `release`, so inside a critical section.
unsafe fn with_open_frame(work: impl FnOnce(&State, &mut Encoder)) {
    // SAFETY: the caller says so.
    let section = unsafe { CriticalSection::new() };
    let state = STATE.borrow(section);
    work(state, &mut state.encoder.borrow_mut());
}

// SAFETY: a critical section lasts from `acquire` to `release`, so frames never mix; a second
// `acquire` inside it panics, as the trait demands.
unsafe impl defmt::Logger for Logger {
    fn acquire() {
        // SAFETY: `release` gives back what is kept here.
        let restore = unsafe { critical_section::acquire() };
        // SAFETY: the section was entered one line above.
        let section = unsafe { CriticalSection::new() };
        let state = STATE.borrow(section);
        assert!(state.open.replace(Some(restore)).is_none(), "a log message inside a log message");
        state.encoder.borrow_mut().start_frame(|bytes| state.send(bytes));
    }

    unsafe fn flush() {
        // SAFETY: defmt calls this between `acquire` and `release`.
        unsafe {
            with_open_frame(|state, _| {
                if let Some(line) = state.line.borrow_mut().as_mut() {
                    let _ = line.flush();
                }
            });
        }
    }

    unsafe fn release() {
        // SAFETY: defmt calls this after `acquire`.
        let section = unsafe { CriticalSection::new() };
        let state = STATE.borrow(section);
        state.encoder.borrow_mut().end_frame(|bytes| state.send(bytes));
        if let Some(restore) = state.open.take() {
            // SAFETY: what `acquire` got, given back once.
            unsafe { critical_section::release(restore) };
        }
    }

    unsafe fn write(bytes: &[u8]) {
        // SAFETY: defmt calls this between `acquire` and `release`.
        unsafe { with_open_frame(|state, encoder| encoder.write(bytes, |sent| state.send(sent))) };
    }
}
