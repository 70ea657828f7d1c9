//! Which usage is where in which report.

use super::item::{Item, Items};

/// Report ids of which the length is kept, 0 (for no id) among them.
const IDS_MAXIMUM: usize = 16;
/// Usages of one item that are kept; longer lists are ranges in practice.
const USAGES_MAXIMUM: usize = 16;
/// How deep PUSH goes.
const STACK_DEPTH: usize = 4;

/// What global items say, until they say otherwise: by their tag.
type Globals = [Item; 10];

/// Which of the globals says what: a tag's high half.
const PAGE: usize = 0;
const MINIMUM: usize = 1;
const MAXIMUM: usize = 2;
const SIZE: usize = 7;
const ID: usize = 8;
const COUNT: usize = 9;

/// What local items say, for the next main item.
#[derive(Debug, Clone, Copy, Default)]
struct Locals {
    usages: [u32; USAGES_MAXIMUM],
    count: usize,
    first: Option<u32>,
    last: Option<u32>,
}

/// Input of one item: some numbers of the same size in a row.
#[derive(Debug, Clone, Copy)]
pub(super) struct Input<'a> {
    /// What the collection at the top is for: page in the high half, usage in the low.
    pub(super) application: u32,
    /// The report's id, 0 if reports have none.
    pub(super) id: u8,
    /// Where the first is, in bits from the report's first, its id not counted.
    pub(super) bit: u32,
    /// Bits of each.
    pub(super) size: u32,
    pub(super) count: u32,
    pub(super) minimum: i32,
    pub(super) maximum: i32,
    /// Each number is a control; else each holds a control's usage.
    pub(super) variable: bool,
    page: u32,
    usages: &'a [u32],
    range: Option<(u32, u32)>,
}

impl Input<'_> {
    /// Returns the usage of a number: page in the high half. The last usage stands for all that follow
    /// (HID 1.11 §6.2.2.8).
    pub(super) fn usage(&self, index: u32) -> Option<u32> {
        match (self.range(), self.usages) {
            (Some((first, last)), []) => first.checked_add(index).filter(|&usage| usage <= last),
            (_, usages) => usages.get(index as usize).or(usages.last()).map(|&usage| on_page(usage, self.page)),
        }
    }

    /// Returns the first usage and the last of a range, likewise.
    pub(super) fn range(&self) -> Option<(u32, u32)> {
        self.range.map(|(first, last)| (on_page(first, self.page), on_page(last, self.page)))
    }
}

/// Reads a report descriptor and hands on what is input; returns the lengths of input reports.
pub(super) fn inputs(descriptor: &[u8], each: &mut dyn FnMut(&Input<'_>)) -> Lengths {
    let mut globals = Globals::default();
    let mut locals = Locals::default();
    let mut stack = [Globals::default(); STACK_DEPTH];
    let (mut depth, mut pushed, mut application) = (0_u32, 0, 0);
    let mut lengths = Lengths::default();
    for item in Items(descriptor) {
        match item.tag {
            Item::PUSH => {
                if let Some(slot) = stack.get_mut(pushed) {
                    *slot = globals;
                    pushed += 1;
                }
            }
            Item::POP if pushed > 0 => {
                pushed -= 1;
                globals = stack[pushed];
            }
            Item::USAGE => locals.push(item.value),
            Item::USAGE_MINIMUM => locals.first = Some(item.value),
            Item::USAGE_MAXIMUM => locals.last = Some(item.value),
            tag if tag & Item::TYPE == Item::GLOBAL => {
                if let Some(global) = globals.get_mut(usize::from(tag >> 4)) {
                    *global = item;
                }
            }
            tag if tag & Item::TYPE == Item::MAIN => {
                let [page, id] = [PAGE, ID].map(|which| globals[which].value);
                match tag {
                    Item::COLLECTION => {
                        if depth == 0 {
                            application = on_page(locals.usages[0], page);
                        }
                        depth = depth.saturating_add(1);
                    }
                    Item::END_COLLECTION => depth = depth.saturating_sub(1),
                    Item::INPUT => {
                        let [size, count] = [SIZE, COUNT].map(|which| globals[which].value);
                        if let Some(bit) = lengths.advance(id as u8, size.saturating_mul(count))
                            && item.value & CONSTANT == 0
                            && (1..=32).contains(&size)
                        {
                            let minimum = globals[MINIMUM].signed();
                            // A maximum below the minimum was meant without a sign: 0 to 255 in one byte.
                            let signed = globals[MAXIMUM].signed();
                            let maximum = if signed < minimum { globals[MAXIMUM].value as i32 } else { signed };
                            each(&Input {
                                application,
                                id: id as u8,
                                bit,
                                size,
                                count,
                                minimum,
                                maximum,
                                variable: item.value & VARIABLE != 0,
                                page,
                                usages: &locals.usages[..locals.count],
                                range: locals.first.zip(locals.last),
                            });
                        }
                    }
                    _ => {}
                }
                locals = Locals::default();
            }
            _ => {}
        }
    }
    lengths
}

/// Bits of an input item (HID 1.11 §6.2.2.5).
const CONSTANT: u32 = 1;
const VARIABLE: u32 = 1 << 1;

/// Puts the page into a usage that brought none: the last one before the main item (HID 1.11 §6.2.2.8).
fn on_page(usage: u32, page: u32) -> u32 {
    if usage >> 16 == 0 { page << 16 | usage } else { usage }
}

impl Locals {
    fn push(&mut self, usage: u32) {
        if let Some(slot) = self.usages.get_mut(self.count) {
            *slot = usage;
            self.count += 1;
        }
    }
}

/// How long the input reports are, by their id.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Lengths {
    bits: [(u8, u32); IDS_MAXIMUM],
    ids: usize,
}

impl Lengths {
    /// Makes a report longer, and returns how long it was; `None` for an id that there is no room for.
    fn advance(&mut self, id: u8, bits: u32) -> Option<u32> {
        let known = self.bits[..self.ids].iter().position(|&(known, _)| known == id);
        let index = known.unwrap_or(self.ids);
        let entry = self.bits.get_mut(index)?;
        if known.is_none() {
            *entry = (id, 0);
            self.ids += 1;
        }
        let before = entry.1;
        entry.1 = before.saturating_add(bits);
        Some(before)
    }

    /// Returns how many bytes a report has, its id counted.
    pub(super) fn bytes(&self, id: u8) -> usize {
        let bits = self.bits[..self.ids].iter().find(|&&(known, _)| known == id).map_or(0, |&(_, bits)| bits);
        bits.div_ceil(8) as usize + usize::from(id != 0)
    }
}
