//! The whole device: registers, FIFO, and what is behind them.

use core::fmt;

use fpga_regs::layout::{Field, mask};
use fpga_regs::registers::{
    Capabilities, Control, Errors, ID_HALF, Register, Screen, Status, VERSION_MAJOR, VERSION_MINOR, Version,
};
use fpga_regs::screen::{HEIGHT, WIDTH};
use fpga_regs::{Counters, Port};

use crate::decoder::MidPacket;
use crate::engine::Engine;
use crate::fifo::Fifo;
use crate::memory::{Memory, SizeError};

/// The FPGA, as software sees it.
///
/// It starts as it is after reset: disabled, with buffer 0 in front.
///
/// **Without a clock.** While CONTROL.enable is 1, a word is taken as soon as it is pushed, so the
/// FIFO is empty between calls and cannot overflow. While it is 0, no word leaves the FIFO, not
/// even one of a packet whose header has been taken; setting it takes all that waits, at once.
///
/// | register or bit | in the model |
/// | --- | --- |
/// | CAPABILITIES | the lent FIFO's depth, 1 pixel unit, no interrupt line unless [`with_interrupt`](Device::with_interrupt) says so |
/// | CONTROL | bits without a meaning read 0; `reset` is done at once and reads 0; the other bits of the same write take effect after it |
/// | CONTROL.reset | clears LOW_WATER and FENCE too; the front buffer stays in front |
/// | STATUS.busy | the stream stands inside a packet, or the FIFO holds words |
/// | STATUS.vertical_blank | 1: a swap never has to wait |
/// | STATUS.swap_pending | 0 |
/// | INTERRUPTS.low_water | raised by a push of more than LOW_WATER words while enabled (the level rises above the mark, then falls to 0), and by enabling a FIFO that holds more than LOW_WATER words |
/// | INTERRUPTS.error | raised by every bad packet and every overflow, even if the flag in ERRORS is already set |
/// | BUSY_CYCLES, STALLED_CYCLES | 0 |
///
/// `INTERRUPTS.low_water` and those two counters are where a comparison with hardware must look away;
/// STATUS as well, unless the hardware has come to rest.
pub struct Device<'a> {
    engine: Engine<'a>,
    fifo: Fifo<'a>,
    control: Control,
    low_water: u32,
    interrupt_wired: bool,
}

impl<'a> Device<'a> {
    /// Returns a device that draws in `memory` and keeps the words it may not yet take in `fifo`.
    ///
    /// The length of `fifo`, 22…65,535 words, is what CAPABILITIES gives as its depth.
    ///
    /// # Errors
    /// [`SizeError::Fifo`] when `fifo` has another length.
    pub fn new(memory: Memory<'a>, fifo: &'a mut [u32]) -> Result<Self, SizeError> {
        Ok(Self {
            engine: Engine::new(memory),
            fifo: Fifo::new(fifo)?,
            control: Control::default(),
            low_water: 0,
            interrupt_wired: false,
        })
    }

    /// Returns the device with CAPABILITIES.interrupt as given.
    ///
    /// Set it where something looks at [`interrupt_pending`](Device::interrupt_pending).
    #[must_use]
    pub fn with_interrupt(self, wired: bool) -> Self {
        Self { interrupt_wired: wired, ..self }
    }

    /// Takes words as if written to the FIFO's aperture, in order.
    ///
    /// They may be any words and end inside a packet. While the device is disabled, words that do
    /// not fit the FIFO are dropped and `ERRORS.fifo_overflow` is set.
    pub fn push(&mut self, words: &[u32]) {
        if !self.control.enable() {
            if self.fifo.push(words) {
                self.engine.raise_error(Errors::default().with_fifo_overflow(true));
            }
            return;
        }
        self.engine.take(words);
        self.level_fell_from(words.len());
    }

    /// Reads a register. No read changes anything.
    pub fn read(&self, register: Register) -> u32 {
        let counters = &self.engine.counters;
        match register {
            Register::Id => ID_HALF,
            Register::Version => Version::default().with_major(VERSION_MAJOR).with_minor(VERSION_MINOR).0,
            Register::Capabilities => self.capabilities().0,
            Register::Screen => Screen::default().with_width(WIDTH as u16).with_height(HEIGHT as u16).0,
            Register::Control => self.control.0,
            Register::Status => self.status().0,
            Register::LowWater => self.low_water,
            Register::Interrupts => self.engine.interrupts.0,
            Register::Errors => self.engine.errors.0,
            Register::Fence => self.engine.fence,
            Register::Triangles => counters.triangles,
            Register::PixelsTested => counters.pixels_tested,
            Register::PixelsWritten => counters.pixels_written,
            Register::BusyCycles => counters.busy_cycles,
            Register::StalledCycles => counters.stalled_cycles,
            Register::FramesShown => counters.frames_shown,
            Register::BadPackets => counters.bad_packets,
        }
    }

    /// Writes a register; a write to a read-only one is ignored.
    pub fn write(&mut self, register: Register, value: u32) {
        match register {
            Register::Control => self.write_control(Control(value & bits_of(Control::FIELDS))),
            Register::LowWater => self.low_water = value,
            Register::Interrupts => self.engine.interrupts.0 &= !value,
            Register::Errors => self.engine.errors.0 &= !value,
            _ => {}
        }
    }

    /// Returns whether the interrupt line is up: some bit of INTERRUPTS is set and CONTROL
    /// enables its interrupt.
    pub fn interrupt_pending(&self) -> bool {
        let (happened, enabled) = (self.engine.interrupts, self.control);
        happened.low_water() && enabled.low_water_interrupt()
            || happened.swap() && enabled.swap_interrupt()
            || happened.fence() && enabled.fence_interrupt()
            || happened.error() && enabled.error_interrupt()
    }

    /// Returns where the stream stands inside a packet, or `None` between packets.
    ///
    /// Words that still wait in the FIFO of a disabled device do not count.
    pub fn mid_packet(&self) -> Option<MidPacket> {
        self.engine.decoder.mid_packet()
    }

    /// Returns the counters, as the driver would read them.
    pub fn counters(&self) -> Counters {
        self.engine.counters
    }

    /// Returns the buffer that shows: a byte of RGB332 a pixel, row 0 on top.
    pub fn front(&self) -> &[u8] {
        self.engine.memory.front()
    }

    /// Returns the buffer that is drawn to, in the shape of [`front`](Device::front).
    pub fn back(&self) -> &[u8] {
        self.engine.memory.back()
    }

    /// Returns the depth buffer, in the order of [`front`](Device::front); 0 is near.
    pub fn depth(&self) -> &[u16] {
        self.engine.memory.depth()
    }

    fn capabilities(&self) -> Capabilities {
        Capabilities::default()
            .with_fifo_depth(self.fifo.depth() as u16)
            .with_pixel_units(1)
            .with_interrupt(self.interrupt_wired)
    }

    fn status(&self) -> Status {
        let mid_packet = self.mid_packet().is_some();
        Status::default()
            .with_fifo_free((self.fifo.depth() - self.fifo.level()) as u16)
            .with_busy(mid_packet || self.fifo.level() > 0)
            .with_front_buffer(self.engine.memory.front_index() == 1)
            .with_vertical_blank(true)
            .with_error(self.engine.errors.0 != 0)
            .with_mid_packet(mid_packet)
    }

    fn write_control(&mut self, control: Control) {
        if control.reset() {
            self.engine.reset();
            self.fifo.drain();
            self.low_water = 0;
        }
        self.control = control.with_reset(false);
        if control.enable() {
            let waiting = self.fifo.level();
            self.engine.take(self.fifo.drain());
            self.level_fell_from(waiting);
        }
    }

    /// Raises the low-water interrupt if a level of `words` was above the mark; now it is 0.
    fn level_fell_from(&mut self, words: usize) {
        if words > self.low_water as usize {
            self.engine.interrupts = self.engine.interrupts.with_low_water(true);
        }
    }
}

impl Port for Device<'_> {
    fn read(&mut self, register: Register) -> u32 {
        Device::read(self, register)
    }

    fn write(&mut self, register: Register, value: u32) {
        Device::write(self, register, value);
    }

    fn push(&mut self, words: &[u32]) {
        Device::push(self, words);
    }
}

impl fmt::Debug for Device<'_> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.debug_struct("Device")
            .field("control", &self.control)
            .field("status", &self.status())
            .field("counters", &self.engine.counters)
            .field("mid_packet", &self.mid_packet())
            .finish_non_exhaustive()
    }
}

/// Returns a word with ones wherever a field is.
fn bits_of(fields: &[Field]) -> u32 {
    fields.iter().fold(0, |bits, field| bits | mask(field.high, field.low) << field.low)
}
