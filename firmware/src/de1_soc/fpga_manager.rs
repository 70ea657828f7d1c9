//! The FPGA manager: what the FPGA does, and its configuration
//! (Intel's HPS manual 683126, chapter 5; registers of `alt_fpgamgr.h`).

mod configure;
mod status;

pub use configure::{ConfigureError, ImageSink};
pub use status::{Mode, Status, Switch};

use crate::mmio::{Bus, Mmio, Register, Registers};

/// Registers of the FPGA manager.
#[derive(Debug, Clone, Copy)]
pub enum Offset {
    /// STAT: mode and MSEL.
    Status = 0x000,
    /// CTRL.
    Control = 0x004,
    /// DCLKCNT: clocks to send to the FPGA.
    ClockCount = 0x008,
    /// DCLKSTAT: they were sent; a one clears.
    ClockDone = 0x00C,
    /// GPIO_PORTA_EOI: clears what the monitor has latched.
    PinsClear = 0x84C,
    /// GPIO_EXT_PORTA: the FPGA's configuration pins.
    Pins = 0x850,
}

impl Register for Offset {
    fn offset(self) -> usize {
        self as usize
    }
}

/// Pins: the FPGA found no fault in its image.
const PIN_NSTATUS: u32 = 1 << 0;
/// Pins: the image is complete.
const PIN_CONF_DONE: u32 = 1 << 1;
/// Pins: the design runs.
const PIN_INIT_DONE: u32 = 1 << 2;

/// The FPGA manager.
pub struct FpgaManager<B = Mmio> {
    registers: Registers<Offset, B>,
}

impl<B: Bus> FpgaManager<B> {
    /// Returns the driver of an FPGA manager.
    #[must_use]
    pub const fn new(registers: Registers<Offset, B>) -> Self {
        Self { registers }
    }

    /// Reads what the FPGA does. Safe at any time: nothing goes through a bridge.
    ///
    /// INIT_DONE counts when two reads in a row find it.
    #[must_use]
    pub fn status(&self) -> Status {
        let first = self.pins() & PIN_INIT_DONE != 0;
        let init_done = first && self.pins() & PIN_INIT_DONE != 0;
        Status::new(self.registers.read(Offset::Status), init_done)
    }

    fn pins(&self) -> u32 {
        self.registers.read(Offset::Pins)
    }
}
