//! The items that a report descriptor is made of (HID 1.11 §6.2.2.2).

/// An item: `tag` is its type and tag, as in its first byte without the length.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Item {
    pub(super) tag: u8,
    /// Its data, 0 for none.
    pub(super) value: u32,
    /// How many bytes of data it has: 0, 1, 2, 4.
    pub(super) length: usize,
}

impl Item {
    /// The bits of a tag that tell its type.
    pub(super) const TYPE: u8 = 0x0C;
    pub(super) const MAIN: u8 = 0x00;
    pub(super) const GLOBAL: u8 = 0x04;
    pub(super) const INPUT: u8 = 0x80;
    pub(super) const COLLECTION: u8 = 0xA0;
    pub(super) const END_COLLECTION: u8 = 0xC0;
    pub(super) const PUSH: u8 = 0xA4;
    pub(super) const POP: u8 = 0xB4;
    pub(super) const USAGE: u8 = 0x08;
    pub(super) const USAGE_MINIMUM: u8 = 0x18;
    pub(super) const USAGE_MAXIMUM: u8 = 0x28;
    /// A long item; the format has no use for any yet.
    const LONG: u8 = 0xFE;

    /// Its data as a number that may be negative.
    pub(super) const fn signed(self) -> i32 {
        match self.length {
            1 => self.value as u8 as i8 as i32,
            2 => self.value as u16 as i16 as i32,
            _ => self.value as i32,
        }
    }
}

/// Goes through items; ends where one is cut off.
pub(super) struct Items<'a>(pub(super) &'a [u8]);

impl Iterator for Items<'_> {
    type Item = Item;

    fn next(&mut self) -> Option<Item> {
        loop {
            let (&head, rest) = self.0.split_first()?;
            if head == Item::LONG {
                let (&length, rest) = rest.split_first()?;
                // The tag's byte, then the data.
                self.0 = rest.get(1 + usize::from(length)..)?;
                continue;
            }
            let length = [0, 1, 2, 4][usize::from(head & 3)];
            let (data, rest) = rest.split_at_checked(length)?;
            self.0 = rest;
            let value = data.iter().rev().fold(0, |value, &byte| value << 8 | u32::from(byte));
            return Some(Item { tag: head & !3, value, length });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Item, Items};
    use std::vec::Vec;

    #[test]
    fn items_are_read_in_every_length() {
        let bytes = [0xC0, 0x05, 0x01, 0x26, 0xFF, 0x7F, 0x17, 0, 0, 0, 0x80, 0xFE, 2, 9, 1, 2, 0x15, 0x81];
        let items: Vec<_> = Items(&bytes).map(|item| (item.tag, item.value, item.signed())).collect();
        assert_eq!(
            items,
            [
                (Item::END_COLLECTION, 0, 0),
                (0x04, 1, 1),
                (0x24, 0x7FFF, 0x7FFF),
                (0x14, 0x8000_0000, i32::MIN),
                (0x14, 0x81, -127),
            ]
        );
    }

    #[test]
    fn what_is_cut_off_is_left_out() {
        for bytes in
            [&[][..], &[0x05], &[0x26, 1], &[0x17, 1, 2, 3], &[0xFE], &[0xFE, 1], &[0xFE, 1, 0], &[0xFE, 255, 0, 0]]
        {
            assert_eq!(Items(bytes).next(), None, "{bytes:?}");
        }
    }
}
