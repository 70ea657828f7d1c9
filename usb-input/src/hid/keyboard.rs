//! A keyboard's report to a boot keyboard's.

use super::field::{Field, bits};
use super::inputs::Input;

const KEYBOARD_PAGE: u32 = 0x07;
/// Left Control; seven more modifiers follow.
const FIRST_MODIFIER: u32 = 0xE0;
const LAST_MODIFIER: u32 = 0xE7;
/// Usages from here up to the first key are errors: too many keys, or a fault (HID Usage Tables, page 0x07).
const FIRST_ERROR: u32 = 0x01;
const FIRST_KEY: u32 = 0x04;
const BOOT_LENGTH: usize = 8;
/// Bitmaps of keys that are kept: modifiers and the other keys, with room for one that is split.
const BITMAPS_MAXIMUM: usize = 3;

/// Where a keyboard's report has its keys.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct KeyboardLayout {
    /// Keys as a bit for each usage.
    bitmaps: [Option<Bitmap>; BITMAPS_MAXIMUM],
    /// Keys as a list of usages.
    list: Option<List>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Bitmap {
    bit: u32,
    first: u16,
    count: u16,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct List {
    /// The first of them.
    field: Field,
    count: u16,
    /// The usage that the least value stands for.
    usage: u16,
}

impl KeyboardLayout {
    /// Tells whether it has any keys.
    pub(super) fn is_usable(&self) -> bool {
        self.list.is_some() || self.bitmaps.iter().flatten().any(|bitmap| u32::from(bitmap.first) < FIRST_MODIFIER)
    }

    /// Takes in an item if it is about keys, and tells whether it is.
    pub(super) fn add(&mut self, input: &Input<'_>) -> bool {
        let about_keys = |&(first, last): &(u32, u32)| first >> 16 == KEYBOARD_PAGE && first <= last;
        let Some((first, last)) = input.range().filter(about_keys) else {
            return false;
        };
        if input.variable && input.size == 1 {
            let count = (last - first + 1).min(input.count).min(0x100) as u16;
            let bitmap = Bitmap { bit: input.bit, first: first as u16, count };
            if let Some(slot) = self.bitmaps.iter_mut().find(|slot| slot.is_none()) {
                *slot = Some(bitmap);
            }
        } else if !input.variable {
            let Input { bit, size, minimum, maximum, .. } = *input;
            let (field, count) = (Field { bit, size, minimum, maximum }, input.count.min(0x100) as u16);
            self.list = self.list.or(Some(List { field, count, usage: first as u16 }));
        }
        true
    }

    /// Translates a report, without its id, to a boot keyboard's; keys beyond six are left out. If it says that it
    /// cannot tell which keys are down, so does the translation.
    pub(crate) fn boot_report(&self, report: &[u8]) -> [u8; BOOT_LENGTH] {
        let mut keys = Keys { report: [0; BOOT_LENGTH], count: 0, unknown: false };
        for bitmap in self.bitmaps.iter().flatten() {
            for index in 0..u32::from(bitmap.count) {
                if bits(report, bitmap.bit.saturating_add(index), 1) == Some(1) {
                    keys.press(u32::from(bitmap.first) + index);
                }
            }
        }
        if let Some(List { mut field, count, usage }) = self.list {
            for _ in 0..count {
                if let Some(value) = field.read(report).filter(|value| (field.minimum..=field.maximum).contains(value))
                {
                    keys.press(u32::from(usage).saturating_add(value.wrapping_sub(field.minimum) as u32));
                }
                field.bit = field.bit.saturating_add(field.size);
            }
        }
        if keys.unknown {
            keys.report[2..].fill(FIRST_ERROR as u8);
        }
        keys.report
    }
}

/// A boot keyboard's report, as it is being made.
struct Keys {
    report: [u8; BOOT_LENGTH],
    count: usize,
    /// It cannot tell which keys are down.
    unknown: bool,
}

impl Keys {
    /// Presses the key of a usage, if it is one.
    #[inline(never)]
    fn press(&mut self, usage: u32) {
        let (used, free) = self.report[2..].split_at_mut(self.count);
        match usage {
            FIRST_MODIFIER..=LAST_MODIFIER => self.report[0] |= 1 << (usage - FIRST_MODIFIER),
            FIRST_ERROR..FIRST_KEY => self.unknown = true,
            FIRST_KEY..=0xFF if !used.contains(&(usage as u8)) => {
                if let Some(place) = free.first_mut() {
                    *place = usage as u8;
                    self.count += 1;
                }
            }
            _ => {}
        }
    }
}
