//! The board's own inputs and outputs: keys, slide switches, red LEDs and hex displays.
//!
//! An agent of its own on the lightweight bridge, apart from the rasterizer: a board without these
//! leaves it out. 32-bit accesses only. Inputs are what they are two to three bus clocks later; the
//! board debounces its keys, its switches nobody does.

word! {
    /// KEYS: the push buttons.
    Keys {
        /// A bit for each button, KEY0 in bit 0; 1 while it is pressed.
        pressed / with_pressed: [3:0] u8,
    }
}

word! {
    /// SWITCHES: the slide switches.
    Switches {
        /// A bit for each switch, SW0 in bit 0; 1 while it is up.
        up / with_up: [9:0] u16,
    }
}

word! {
    /// LEDS: the red LEDs.
    Leds {
        /// A bit for each LED, LEDR0 in bit 0; 1 lights it.
        lit / with_lit: [9:0] u16,
    }
}

word! {
    /// HEX_LOW: the four right displays. In each byte bit 0 is segment a, bit 6 is g; 1 lights it.
    HexLow {
        /// HEX0, the rightmost.
        hex0 / with_hex0: [6:0] u8,
        /// HEX1.
        hex1 / with_hex1: [14:8] u8,
        /// HEX2.
        hex2 / with_hex2: [22:16] u8,
        /// HEX3.
        hex3 / with_hex3: [30:24] u8,
    }
}

word! {
    /// HEX_HIGH: the two left displays, segments as in HEX_LOW.
    HexHigh {
        /// HEX4.
        hex4 / with_hex4: [6:0] u8,
        /// HEX5, the leftmost.
        hex5 / with_hex5: [14:8] u8,
    }
}

registers! {
    /// The registers as they lie in memory. Never made: a pointer to the real ones is.
    BoardIoBlock
    /// A register by name; the discriminant is its byte offset.
    BoardRegister BOARD_REGISTERS;
    /// Push buttons: which are pressed.
    0x00 KEYS Keys keys: RO ReadOnly None, Keys::FIELDS;
    /// Slide switches: which are up.
    0x04 SWITCHES Switches switches: RO ReadOnly None, Switches::FIELDS;
    /// Red LEDs: which are lit.
    0x08 LEDS Leds leds: RW ReadWrite Some(0), Leds::FIELDS;
    /// Segments of HEX0 to HEX3.
    0x0c HEX_LOW HexLow hex_low: RW ReadWrite Some(0), HexLow::FIELDS;
    /// Segments of HEX4 and HEX5.
    0x10 HEX_HIGH HexHigh hex_high: RW ReadWrite Some(0), HexHigh::FIELDS;
}

/// Segments of the digits 0 to F, bit 0 = a (top), clockwise to f, bit 6 = g (middle).
pub const DIGITS: [u8; 16] =
    [0x3f, 0x06, 0x5b, 0x4f, 0x66, 0x6d, 0x7d, 0x07, 0x7f, 0x6f, 0x77, 0x7c, 0x39, 0x5e, 0x79, 0x71];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_in_offset_order_and_its_fields_share_no_bit() {
        for (index, register) in BoardRegister::ALL.iter().enumerate() {
            let info = register.info();
            assert_eq!((info.offset, *register as usize), (index * 4, index * 4));
            let masks = info.fields.iter().map(|field| crate::layout::mask(field.high, field.low) << field.low);
            assert_eq!(masks.clone().sum::<u32>(), masks.fold(0, |all, mask| all | mask), "{}", info.name);
        }
        assert_eq!(core::mem::size_of::<BoardIoBlock>(), BoardRegister::ALL.len() * 4);
    }

    /// Draws the digits, three rows high, as a person would.
    #[test]
    fn digits_look_like_digits() {
        let segment = |digit: usize, bit: u32, stroke: char| if DIGITS[digit] >> bit & 1 == 1 { stroke } else { ' ' };
        let row = |bits: [(u32, char); 3]| {
            (0..16).map(move |digit| bits.map(|(bit, stroke)| segment(digit, bit, stroke)).iter().collect::<String>())
        };
        let never = 7;
        let rows = [
            row([(never, ' '), (0, '_'), (never, ' ')]),
            row([(5, '|'), (6, '_'), (1, '|')]),
            row([(4, '|'), (3, '_'), (2, '|')]),
        ];
        let picture = rows.map(|row| row.collect::<String>());
        assert_eq!(
            picture,
            [
                " _     _  _     _  _  _  _  _  _     _     _  _ ",
                "| |  | _| _||_||_ |_   ||_||_||_||_ |   _||_ |_ ",
                "|_|  ||_  _|  | _||_|  ||_| _|| ||_||_ |_||_ |  ",
            ]
        );
    }
}
