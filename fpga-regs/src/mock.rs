//! A host stand-in for the FPGA, with a journal.
//!
//! [`Mock`] is both the [`Port`] and the [`Wait`] of a driver under test, and stays in the
//! test's hands as well (it is a shared handle). It models what a driver can notice: registers
//! that answer what they are told, and a FIFO that fills, drains at a set rate while the driver
//! waits (its interrupt never cuts a wait short), sticks, or reports errors. It draws nothing; the software model does that.

use std::cell::{Ref, RefCell};
use std::collections::VecDeque;
use std::rc::Rc;

use crate::error::NotConfigured;
use crate::packet::{Header, Packet};
use crate::port::{Port, Wait};
use crate::registers::{Capabilities, Control, Errors, Interrupts, Register, Screen, Status};
use crate::screen::{HEIGHT, WIDTH};

/// One thing that the driver did.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Access {
    /// Asked whether the FPGA is configured.
    Configured,
    /// Read a register and got this.
    Read(Register, u32),
    /// Wrote this to a register.
    Write(Register, u32),
    /// Pushed these words.
    Push(Vec<u32>),
    /// Waited this many microseconds at most.
    Wait(u32),
}

/// What the mock's device is like.
#[derive(Debug, Clone, Copy)]
pub struct Behaviour {
    /// What the FPGA manager says: 4 is configured.
    pub manager_mode: u8,
    /// FIFO depth in words.
    pub fifo_depth: u16,
    /// Words that leave the FIFO in a microsecond of waiting. 0 is a FIFO that never drains.
    pub words_per_microsecond: u32,
    /// Whether the interrupt line is wired.
    pub interrupt: bool,
    /// Whether CONTROL.reset stays 1 for ever.
    pub reset_sticks: bool,
}

impl Default for Behaviour {
    /// Returns a configured device with 1,024 words that drains 25 of them a microsecond.
    fn default() -> Self {
        Self { manager_mode: 4, fifo_depth: 1024, words_per_microsecond: 25, interrupt: true, reset_sticks: false }
    }
}

/// Registers that CONTROL.reset brings back to 0.
const CLEARED_BY_RESET: [Register; 11] = [
    Register::LowWater,
    Register::Interrupts,
    Register::Errors,
    Register::Fence,
    Register::Triangles,
    Register::PixelsTested,
    Register::PixelsWritten,
    Register::BusyCycles,
    Register::StalledCycles,
    Register::FramesShown,
    Register::BadPackets,
];

#[derive(Debug)]
struct State {
    behaviour: Behaviour,
    registers: Vec<u32>,
    fifo: VecDeque<u32>,
    taken: Vec<u32>,
    journal: Vec<Access>,
}

/// A shared handle on a mock FPGA. See the [module](self).
#[derive(Debug, Clone)]
pub struct Mock(Rc<RefCell<State>>);

impl Mock {
    /// Returns a mock whose registers hold what a right device has after reset.
    pub fn new(behaviour: Behaviour) -> Self {
        let mut registers: Vec<u32> = Register::ALL.iter().map(|register| register.info().reset.unwrap_or(0)).collect();
        registers[Register::Capabilities as usize / 4] = Capabilities::default()
            .with_fifo_depth(behaviour.fifo_depth)
            .with_pixel_units(1)
            .with_interrupt(behaviour.interrupt)
            .0;
        registers[Register::Screen as usize / 4] =
            Screen::default().with_width(WIDTH as u16).with_height(HEIGHT as u16).0;
        Self(Rc::new(RefCell::new(State {
            behaviour,
            registers,
            fifo: VecDeque::new(),
            taken: Vec::new(),
            journal: Vec::new(),
        })))
    }

    /// Makes a register answer `value` from now on.
    pub fn answer(&self, register: Register, value: u32) {
        self.0.borrow_mut().registers[register as usize / 4] = value;
    }

    /// Sets error flags, as the device does.
    pub fn raise(&self, errors: Errors) {
        self.0.borrow_mut().registers[Register::Errors as usize / 4] |= errors.0;
    }

    /// Changes the device's behaviour; what is in the FIFO stays there.
    pub fn behave(&self, change: impl FnOnce(&mut Behaviour)) {
        change(&mut self.0.borrow_mut().behaviour);
    }

    /// Returns what the driver did, in order.
    pub fn journal(&self) -> Ref<'_, [Access]> {
        Ref::map(self.0.borrow(), |state| state.journal.as_slice())
    }

    /// Empties the journal and returns what was in it.
    pub fn take_journal(&self) -> Vec<Access> {
        std::mem::take(&mut self.0.borrow_mut().journal)
    }

    /// Returns all words that were pushed and not dropped, drained or not, in order.
    pub fn stream(&self) -> Vec<u32> {
        let state = self.0.borrow();
        state.taken.iter().chain(&state.fifo).copied().collect()
    }
}

impl State {
    fn register(&mut self, register: Register) -> &mut u32 {
        &mut self.registers[register as usize / 4]
    }

    fn drain(&mut self, words: usize) {
        let enabled = Control(*self.register(Register::Control)).enable();
        let low_water = *self.register(Register::LowWater) as usize;
        for _ in 0..words.min(if enabled { self.fifo.len() } else { 0 }) {
            let before = self.fifo.len();
            self.taken.extend(self.fifo.pop_front());
            if before > low_water && self.fifo.len() <= low_water {
                *self.register(Register::Interrupts) |= Interrupts::default().with_low_water(true).0;
            }
        }
        self.pass_fences();
    }

    /// Sets FENCE to the tag of the last fence among the words taken so far.
    fn pass_fences(&mut self) {
        let mut at = 0;
        while at < self.taken.len() {
            let header = Header(self.taken[at]);
            let end = at + 1 + usize::from(header.length());
            if end > self.taken.len() {
                break;
            }
            if let Ok(Packet::Fence(fence)) = Packet::decode(header, &self.taken[at + 1..end]) {
                *self.register(Register::Fence) = fence.tag;
            }
            at = end;
        }
    }

    fn read(&mut self, register: Register) -> u32 {
        match register {
            Register::Status => {
                let free = self.behaviour.fifo_depth.saturating_sub(self.fifo.len() as u16);
                let error = *self.register(Register::Errors) != 0;
                Status(*self.register(Register::Status)).with_fifo_free(free).with_error(error).0
            }
            _ => *self.register(register),
        }
    }

    fn write(&mut self, register: Register, value: u32) {
        match register {
            Register::Control => {
                let control = Control(value);
                if control.reset() {
                    self.fifo.clear();
                    self.taken.clear();
                    for cleared in CLEARED_BY_RESET {
                        *self.register(cleared) = 0;
                    }
                }
                *self.register(register) = control.with_reset(control.reset() && self.behaviour.reset_sticks).0;
            }
            Register::Interrupts | Register::Errors => *self.register(register) &= !value,
            Register::LowWater => *self.register(register) = value,
            _ => {}
        }
    }
}

impl Port for Mock {
    fn configured(&mut self) -> Result<(), NotConfigured> {
        let mut state = self.0.borrow_mut();
        state.journal.push(Access::Configured);
        match state.behaviour.manager_mode {
            4 => Ok(()),
            mode => Err(NotConfigured { mode }),
        }
    }

    fn read(&mut self, register: Register) -> u32 {
        let mut state = self.0.borrow_mut();
        let value = state.read(register);
        state.journal.push(Access::Read(register, value));
        value
    }

    fn write(&mut self, register: Register, value: u32) {
        let mut state = self.0.borrow_mut();
        state.journal.push(Access::Write(register, value));
        state.write(register, value);
    }

    fn push(&mut self, words: &[u32]) {
        let mut state = self.0.borrow_mut();
        state.journal.push(Access::Push(words.to_vec()));
        let space = usize::from(state.behaviour.fifo_depth) - state.fifo.len();
        let taken = words.len().min(space);
        state.fifo.extend(&words[..taken]);
        if taken < words.len() {
            *state.register(Register::Errors) |= Errors::default().with_fifo_overflow(true).0;
        }
    }
}

impl Wait for Mock {
    const INTERRUPT: bool = true;

    fn wait(&mut self, micros: u32) -> u32 {
        let mut state = self.0.borrow_mut();
        state.journal.push(Access::Wait(micros));
        let words = micros as usize * state.behaviour.words_per_microsecond as usize;
        state.drain(words);
        micros
    }
}

/// The same mock waited for without its interrupt.
#[derive(Debug, Clone)]
pub struct Polled(pub Mock);

impl Wait for Polled {
    const INTERRUPT: bool = false;

    fn wait(&mut self, micros: u32) -> u32 {
        self.0.wait(micros)
    }
}
