//! The FPGA manager: tells whether the FPGA is configured, and configures it from the processor.
//!
//! Configuration follows U-Boot's sequence (`drivers/fpga/socfpga_gen5.c`), a step out of order is
//! refused. What the bits of a bitstream mean nobody but the device knows, so the board is told
//! which bitstream is the right one ([`FpgaManager::expects`]), and any other pulls nSTATUS low.

use super::{Answer, no_register, read_only};

/// STAT.mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// Held in reset by nCONFIG.
    Reset = 1,
    /// Takes a bitstream.
    Configuration = 2,
    /// Starts up.
    Initialisation = 3,
    /// Runs the design.
    User = 4,
}

const CONTROL_ENABLE: u32 = 1 << 0;
const CONTROL_NOT_CHIP_ENABLE: u32 = 1 << 1;
const CONTROL_PULL_CONFIG: u32 = 1 << 2;
const CONTROL_AXI: u32 = 1 << 8;
const CONTROL_RATIO: u32 = 0b11 << 6;
const CONTROL_WIDE: u32 = 1 << 9;

const MONITOR_STATUS: u32 = 1 << 0;
const MONITOR_DONE: u32 = 1 << 1;
const MONITOR_INIT_DONE: u32 = 1 << 2;
const MONITOR_POWER: u32 = 1 << 11;

/// DCLK pulses that take the FPGA from configuration to user mode.
const START_UP_CLOCKS: u32 = 4;

/// The manager and, behind it, the FPGA's configuration pins.
pub struct FpgaManager {
    mode: Mode,
    msel: u32,
    control: u32,
    expected: Option<Vec<u8>>,
    taken: usize,
    failed: bool,
    done: bool,
    clocks_done: bool,
    general_output: u32,
    interrupt_enable: u32,
}

impl FpgaManager {
    /// Returns the manager of an FPGA that is configured, or not, with the MSEL switch as given.
    pub fn new(configured: bool, msel: u32) -> Self {
        Self {
            mode: if configured { Mode::User } else { Mode::Configuration },
            msel: msel & 0x1F,
            control: CONTROL_WIDE,
            expected: None,
            taken: 0,
            failed: false,
            done: configured,
            clocks_done: false,
            general_output: 0,
            interrupt_enable: 0,
        }
    }

    /// Says which bitstream configures the FPGA; what fills its last word is not looked at.
    pub fn expects(&mut self, bitstream: &[u8]) {
        self.expected = Some(bitstream.to_vec());
    }

    /// Configures the FPGA, or takes its configuration away, from outside (JTAG, power).
    pub fn set_configured(&mut self, configured: bool) {
        self.mode = if configured { Mode::User } else { Mode::Configuration };
        (self.done, self.failed, self.taken) = (configured, false, 0);
    }

    /// Starts over with the processor; the FPGA stays as it is.
    pub fn restart(&mut self) {
        let (expected, configured) = (self.expected.take(), self.configured());
        *self = Self { expected, ..Self::new(configured, self.msel) };
    }

    /// Returns whether the design runs.
    pub fn configured(&self) -> bool {
        self.mode == Mode::User
    }

    fn monitor(&self) -> u32 {
        let flag = |bits: u32, set: bool| if set { bits } else { 0 };
        let status = !self.failed && self.mode != Mode::Reset;
        // Pins 8 to 10 follow nCONFIG, nSTATUS and CONF_DONE.
        MONITOR_POWER
            | flag(MONITOR_STATUS | 1 << 9, status)
            | flag(MONITOR_DONE | 1 << 10, self.done)
            | flag(MONITOR_INIT_DONE, self.mode == Mode::User)
            | flag(1 << 8, self.mode != Mode::Reset)
    }

    /// Reads a register.
    ///
    /// # Errors
    /// What the access lacked.
    pub fn read(&self, offset: u32) -> Answer<u32> {
        Ok(match offset {
            0x000 => self.msel << 3 | self.mode as u32,
            0x004 => self.control,
            0x008 => 0,
            0x00C => self.clocks_done.into(),
            0x010 => self.general_output,
            0x014 => 0,
            0x830 => self.interrupt_enable,
            0x834..=0x844 => 0,
            0x850 => self.monitor(),
            _ => return no_register(offset),
        })
    }

    /// Writes a register.
    ///
    /// # Errors
    /// What the access lacked.
    pub fn write(&mut self, offset: u32, value: u32) -> Answer<()> {
        match offset {
            0x004 => self.write_control(value)?,
            0x008 => self.pulse(value)?,
            0x00C => self.clocks_done &= value & 1 == 0,
            0x010 => self.general_output = value,
            0x000 | 0x014 | 0x850 => return read_only("the register"),
            0x830..=0x840 if value != 0 => return Err("the monitor's interrupts are not modelled".into()),
            0x830..=0x840 | 0x84C => {}
            _ => return no_register(offset),
        }
        Ok(())
    }

    fn write_control(&mut self, value: u32) -> Answer<()> {
        if value & CONTROL_ENABLE != 0 && value & CONTROL_NOT_CHIP_ENABLE != 0 {
            return Err("nCE low before EN: the FPGA listens to the manager only then".into());
        }
        self.control = value & 0x3FF;
        if self.control & CONTROL_ENABLE == 0 {
            return Ok(());
        }
        if self.control & CONTROL_PULL_CONFIG != 0 {
            self.mode = Mode::Reset;
            (self.done, self.failed, self.taken) = (false, false, 0);
        } else if self.mode == Mode::Reset {
            self.mode = Mode::Configuration;
        }
        Ok(())
    }

    /// CFGWDTH and CDRATIO that MSEL asks for (U-Boot's table), or `None` where it leaves the
    /// processor out.
    fn settings(&self) -> Option<u32> {
        let ratio = |code: u32| code << 6;
        Some(match self.msel {
            0b00000 | 0b00100 => ratio(0),
            0b00001 | 0b00101 => ratio(1),
            0b00010 | 0b00110 => ratio(2),
            0b01000 | 0b01100 => CONTROL_WIDE | ratio(0),
            0b01001 | 0b01101 => CONTROL_WIDE | ratio(2),
            0b01010 | 0b01110 => CONTROL_WIDE | ratio(3),
            _ => return None,
        })
    }

    /// Takes a word of the bitstream.
    ///
    /// # Errors
    /// What the step lacked.
    pub fn write_data(&mut self, word: u32) -> Answer<()> {
        let Some(settings) = self.settings() else {
            return Err(format!(
                "an MSEL switch that lets the processor configure the FPGA; it stands at {:#07b}",
                self.msel
            ));
        };
        if self.control & (CONTROL_RATIO | CONTROL_WIDE) != settings {
            return Err(format!(
                "CFGWDTH and CDRATIO as MSEL {:#07b} wants them: {settings:#x}, not {:#x}",
                self.msel,
                self.control & (CONTROL_RATIO | CONTROL_WIDE)
            ));
        }
        if self.control & (CONTROL_ENABLE | CONTROL_AXI) != CONTROL_ENABLE | CONTROL_AXI {
            return Err("CTRL.EN and CTRL.AXICFGEN: the manager drives the configuration only then".into());
        }
        if self.mode != Mode::Configuration {
            return Err(format!("mode 2 (configuration); the FPGA is in mode {}", self.mode as u32));
        }
        let Some(expected) = &self.expected else {
            self.failed = true;
            return Ok(());
        };
        let bytes = expected.get(self.taken..).unwrap_or_default();
        self.failed |= bytes.is_empty() || bytes.iter().zip(word.to_le_bytes()).any(|(wanted, found)| *wanted != found);
        self.taken += 4;
        self.done = !self.failed && self.taken >= expected.len();
        Ok(())
    }

    fn pulse(&mut self, count: u32) -> Answer<()> {
        if self.control & CONTROL_AXI != 0 {
            return Err("CTRL.AXICFGEN off before DCLK is pulsed".into());
        }
        self.clocks_done = true;
        self.mode = match self.mode {
            Mode::Configuration if self.done && count >= START_UP_CLOCKS => Mode::Initialisation,
            Mode::Initialisation => Mode::User,
            mode => mode,
        };
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BITSTREAM: [u8; 10] = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10];

    fn configure(manager: &mut FpgaManager, words: &[u32]) -> Answer<()> {
        let base = CONTROL_WIDE | 3 << 6;
        manager.write(0x004, base | CONTROL_NOT_CHIP_ENABLE)?;
        manager.write(0x004, base)?;
        manager.write(0x004, base | CONTROL_ENABLE)?;
        manager.write(0x004, base | CONTROL_ENABLE | CONTROL_PULL_CONFIG)?;
        assert_eq!(manager.read(0x000)? & 7, 1);
        manager.write(0x004, base | CONTROL_ENABLE)?;
        assert_eq!(manager.read(0x000)? & 7, 2);
        manager.write(0x004, base | CONTROL_ENABLE | CONTROL_AXI)?;
        for word in words {
            manager.write_data(*word)?;
        }
        if manager.read(0x850)? & MONITOR_DONE == 0 {
            return Err(format!("monitor {:#x}", manager.read(0x850)?));
        }
        manager.write(0x004, base | CONTROL_ENABLE)?;
        manager.write(0x008, 4)?;
        assert_eq!(manager.read(0x00C)?, 1);
        manager.write(0x00C, 1)?;
        manager.write(0x008, 0x5000)?;
        manager.write(0x004, base)
    }

    #[test]
    fn the_right_bitstream_in_the_right_order_configures() {
        let mut manager = FpgaManager::new(false, 0b01010);
        manager.expects(&BITSTREAM);
        assert!(!manager.configured());
        configure(&mut manager, &[0x0403_0201, 0x0807_0605, 0xFFFF_0A09]).unwrap();
        assert!(manager.configured());
        assert_eq!(manager.read(0x850).unwrap() & 7, 7);
        assert_eq!(manager.read(0x000), Ok(0b01010 << 3 | 4));
    }

    #[test]
    fn a_damaged_bitstream_pulls_nstatus() {
        let mut manager = FpgaManager::new(false, 0b01010);
        manager.expects(&BITSTREAM);
        configure(&mut manager, &[0x0403_0201, 0x0807_0600, 0x0A09]).unwrap_err();
        assert_eq!(manager.read(0x850).unwrap() & MONITOR_STATUS, 0);
    }

    #[test]
    fn the_switch_can_forbid_it() {
        let mut manager = FpgaManager::new(false, 0b10010);
        manager.expects(&BITSTREAM);
        assert!(configure(&mut manager, &[0x0403_0201]).unwrap_err().contains("0b10010"));
    }
}
