//! String descriptors (USB 2.0 §9.6.7).

use crate::Text;
use crate::setup::descriptor;

/// Bytes of a string descriptor that are asked for: as many characters as are kept.
pub(crate) const STRING_BYTES: usize = 2 + 2 * Text::LENGTH_MAXIMUM;

/// Reads the first language that a device's strings are in, from its string descriptor 0.
pub(crate) fn language(bytes: &[u8]) -> Option<u16> {
    match *bytes {
        [4..=255, descriptor::STRING, low, high, ..] => Some(u16::from_le_bytes([low, high])),
        _ => None,
    }
}

/// Reads a string, as much as there is room for.
pub(crate) fn text(bytes: &[u8]) -> Text {
    let mut text = Text::default();
    if let [length, descriptor::STRING, units @ ..] = bytes {
        let length = usize::from(length.saturating_sub(2)).min(units.len());
        for unit in units[..length].chunks_exact(2) {
            text.push(u16::from_le_bytes([unit[0], unit[1]]));
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::{language, text};
    use std::string::ToString;

    #[test]
    fn a_name_is_read() {
        assert_eq!(text(&[8, 3, b'S', 0, b'o', 0, 0xE9, 0]).to_string(), "So?");
        assert_eq!(language(&[4, 3, 9, 4]), Some(0x0409));
    }

    #[test]
    fn nonsense_is_empty_or_cut() {
        for bytes in [&[][..], &[4], &[0, 3], &[1, 3, b'a', 0], &[4, 2, b'a', 0]] {
            assert!(text(bytes).is_empty(), "{bytes:?}");
        }
        assert_eq!(text(&[6, 3, 27, 0, 10, 0]).to_string(), "??");
        assert_eq!(text(&[255, 3, b'a', 0, b'b']).to_string(), "a");
        let mut long = [b'x'; 200];
        long[1] = 3;
        assert_eq!(text(&long).to_string().len(), 32);
        assert_eq!([language(&[]), language(&[2, 3]), language(&[3, 3, 9, 4]), language(&[4, 3, 9])], [None; 4]);
    }
}
