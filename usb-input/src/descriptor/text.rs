//! String descriptors (USB 2.0 §9.6.7).

use heapless::String;

use crate::TEXT_BYTES;
use crate::setup::descriptor;

/// Bytes of a string descriptor that are asked for: more characters than are kept.
pub(crate) const STRING_BYTES: usize = 2 + 2 * TEXT_BYTES;

/// Reads the first language that a device's strings are in, from its string descriptor 0.
pub(crate) fn language(bytes: &[u8]) -> Option<u16> {
    match *bytes {
        [4..=255, descriptor::STRING, low, high, ..] => Some(u16::from_le_bytes([low, high])),
        _ => None,
    }
}

/// Reads a string: as much as there is room for, without what would upset a console.
pub(crate) fn text(bytes: &[u8]) -> String<TEXT_BYTES> {
    let mut text = String::new();
    let [length, descriptor::STRING, ..] = *bytes else {
        return text;
    };
    let length = usize::from(length).min(bytes.len()).max(2);
    let units = bytes[2..length].chunks_exact(2).map(|unit| u16::from_le_bytes([unit[0], unit[1]]));
    // Half of a pair is no character.
    for character in units.filter_map(|unit| char::from_u32(unit.into())).filter(|character| !character.is_control()) {
        if text.push(character).is_err() {
            break;
        }
    }
    text.truncate(text.trim_end_matches(' ').len());
    text
}

#[cfg(test)]
mod tests {
    use super::{language, text};

    #[test]
    fn a_name_is_read() {
        assert_eq!(text(&[12, 3, b'S', 0, b'o', 0, 0xE9, 0, b' ', 0, b' ', 0]), "Soé");
        assert_eq!(language(&[4, 3, 9, 4]), Some(0x0409));
    }

    #[test]
    fn nonsense_is_empty_or_cut() {
        for bytes in
            [&[][..], &[4], &[0, 3], &[1, 3, b'a', 0], &[4, 2, b'a', 0], &[4, 3, 0, 0xD8], &[6, 3, 27, 0, 10, 0]]
        {
            assert_eq!(text(bytes), "", "{bytes:?}");
        }
        assert_eq!(text(&[255, 3, b'a', 0, b'b']), "a");
        let mut long = [b'x'; 70];
        long[1] = 3;
        assert!(text(&long).len() <= 32);
        assert_eq!([language(&[]), language(&[2, 3]), language(&[3, 3, 9, 4]), language(&[4, 3, 9])], [None; 4]);
    }
}
