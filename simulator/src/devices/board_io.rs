//! Keys, switches, lights and displays on the FPGA's side of the board (`fpga/board_io.sv`).

use fpga_regs::board_io::{BoardRegister, DIGITS, HexHigh, HexLow, Keys, Leds, Switches};

use super::{Answer, no_register};

/// The agent, and what is at its pins.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct BoardIo {
    /// Which keys are pressed.
    pub keys: Keys,
    /// Which switches are up.
    pub switches: Switches,
    leds: Leds,
    hex_low: HexLow,
    hex_high: HexHigh,
}

impl BoardIo {
    /// Returns the red LEDs.
    pub fn leds(&self) -> Leds {
        self.leds
    }

    /// Returns the displays as a person reads them, HEX5 first: a digit, a blank or `?`.
    pub fn displays(&self) -> String {
        let Self { hex_low: low, hex_high: high, .. } = self;
        let segments = [high.hex5(), high.hex4(), low.hex3(), low.hex2(), low.hex1(), low.hex0()];
        let read = |segments: &u8| match DIGITS.iter().position(|digit| digit == segments) {
            Some(digit) => char::from_digit(digit as u32, 16).unwrap_or('?'),
            None if *segments == 0 => ' ',
            None if *segments == 1 << 6 => '-',
            None => '?',
        };
        segments.iter().map(read).collect()
    }

    /// Resets the agent: all lights off. Keys and switches stay as they are.
    pub fn reset(&mut self) {
        *self = Self { keys: self.keys, switches: self.switches, ..Self::default() };
    }

    /// Reads a register.
    ///
    /// # Errors
    /// What the access lacked.
    pub fn read(&self, offset: u32) -> Answer<u32> {
        Ok(match BoardRegister::at(offset as usize) {
            Some(BoardRegister::Keys) => self.keys.0,
            Some(BoardRegister::Switches) => self.switches.0,
            Some(BoardRegister::Leds) => self.leds.0,
            Some(BoardRegister::HexLow) => self.hex_low.0,
            Some(BoardRegister::HexHigh) => self.hex_high.0,
            None => return no_register(offset),
        })
    }

    /// Writes a register.
    ///
    /// # Errors
    /// What the access lacked.
    pub fn write(&mut self, offset: u32, value: u32) -> Answer<()> {
        match BoardRegister::at(offset as usize) {
            Some(BoardRegister::Leds) => self.leds = Leds::default().with_lit(Leds(value).lit()),
            Some(BoardRegister::HexLow) => self.hex_low = HexLow(value & 0x7F7F_7F7F),
            Some(BoardRegister::HexHigh) => self.hex_high = HexHigh(value & 0x7F7F),
            Some(register) => return super::read_only(register.info().name),
            None => return no_register(offset),
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn displays_are_read_as_a_person_reads_them() {
        let mut board = BoardIo::default();
        board.write(0x0C, u32::from_be_bytes([0, 0x40, DIGITS[4], DIGITS[2]])).unwrap();
        board.write(0x10, 0x01).unwrap();
        assert_eq!(board.displays(), " ? -42");
        board.reset();
        assert_eq!(board.displays(), "      ");
        assert!(board.write(0x00, 1).is_err());
    }
}
