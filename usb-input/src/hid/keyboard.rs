//! A keyboard's report to a boot keyboard's.

use super::field::{Field, bits};
use super::inputs::Input;

const KEYBOARD_PAGE: u32 = 0x07;
/// Left Control; seven more modifiers follow.
const FIRST_MODIFIER: u16 = 0xE0;
const LAST_MODIFIER: u16 = 0xE7;
/// Usages from here up to the first key are errors: too many keys, or a fault (HID Usage Tables, page 0x07).
const FIRST_ERROR: u16 = 0x01;
const FIRST_KEY: u16 = 0x04;
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
    first: Field,
    count: u16,
    /// The usage that the least value stands for.
    usage: u16,
}

impl KeyboardLayout {
    /// Tells whether it has any keys.
    pub(super) fn is_usable(&self) -> bool {
        self.list.is_some() || self.bitmaps.iter().flatten().any(|bitmap| bitmap.first < FIRST_MODIFIER)
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
            let first_field = Field { bit, size, minimum, maximum };
            let count = input.count.min(0x100) as u16;
            self.list = self.list.or(Some(List { first: first_field, count, usage: first as u16 }));
        }
        true
    }

    /// Translates a report, without its id, to a boot keyboard's; keys beyond six are left out. If it says that it
    /// cannot tell which keys are down, so does the translation.
    pub(crate) fn boot_report(&self, report: &[u8]) -> [u8; BOOT_LENGTH] {
        let mut boot = [0; BOOT_LENGTH];
        let (mut free, mut unknown) = (2, false);
        let mut press = |usage: u16| match usage {
            FIRST_MODIFIER..=LAST_MODIFIER => boot[0] |= 1 << (usage - FIRST_MODIFIER),
            FIRST_KEY..=0xFF if free < BOOT_LENGTH && !boot[2..free].contains(&(usage as u8)) => {
                boot[free] = usage as u8;
                free += 1;
            }
            FIRST_ERROR..FIRST_KEY => unknown = true,
            _ => {}
        };
        for bitmap in self.bitmaps.iter().flatten() {
            let held = |index: &u16| bits(report, bitmap.bit.saturating_add(u32::from(*index)), 1) == Some(1);
            (0..bitmap.count).filter(held).for_each(|index| press(bitmap.first.saturating_add(index)));
        }
        if let Some(List { first, count, usage }) = self.list {
            for index in 0..u32::from(count) {
                let field = Field { bit: first.bit.saturating_add(index.saturating_mul(first.size)), ..first };
                let Some(value) = field.read(report).filter(|value| (first.minimum..=first.maximum).contains(value))
                else {
                    continue;
                };
                let key = (i64::from(value) - i64::from(first.minimum)).saturating_add(i64::from(usage));
                press(u16::try_from(key).unwrap_or(0));
            }
        }
        if unknown {
            boot[2..].fill(FIRST_ERROR as u8);
        }
        boot
    }
}
