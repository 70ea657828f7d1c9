//! The FPGA's registers and FIFO, for a renderer that asks first.

use core::ptr::NonNull;

use fpga_regs::error::NotConfigured;
use fpga_regs::registers::Register;
use fpga_regs::{MmioPort, Port, de1_soc};

use super::fpga_manager::FpgaManager;

/// A [`Port`] on the board's two bridges.
///
/// An access to an FPGA that has lost its design stops the processor for good, and somebody may load another over
/// JTAG at any time. So each access asks the FPGA manager first, which takes as long as a third of a read. One to
/// an FPGA that does not run has no effect and reads 0: the driver's time-outs and its next start then say so.
pub struct BridgePort {
    port: MmioPort,
    manager: FpgaManager,
}

impl BridgePort {
    /// Returns the port. Touches nothing.
    ///
    /// # Safety
    /// - The bridges are open whenever the port is used, but for [`configured`](Port::configured).
    /// - No other port is made on the FPGA. `manager` only reads.
    #[must_use]
    pub unsafe fn new(manager: FpgaManager) -> Self {
        let at = |address| NonNull::new(core::ptr::with_exposed_provenance_mut::<u8>(address));
        let [registers, aperture] =
            [de1_soc::REGISTERS, de1_soc::FIFO_APERTURE].map(|address| at(address).expect("no agent is at address 0"));
        // SAFETY: the FPGA's project has its agents there, and the board's table maps them; the caller vouches for
        // the bridges.
        Self { port: unsafe { MmioPort::new(registers.cast(), aperture.cast()) }, manager }
    }
}

impl Port for BridgePort {
    fn configured(&mut self) -> Result<(), NotConfigured> {
        self.manager.status().check()
    }

    fn read(&mut self, register: Register) -> u32 {
        if self.configured().is_ok() { self.port.read(register) } else { 0 }
    }

    fn write(&mut self, register: Register, value: u32) {
        if self.configured().is_ok() {
            self.port.write(register, value);
        }
    }

    fn push(&mut self, words: &[u32]) {
        if self.configured().is_ok() {
            self.port.push(words);
        }
    }
}
