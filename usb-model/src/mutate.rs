//! Descriptors that are wrong.

use crate::leaf::Descriptors;
use crate::random::Random;

/// Numbers that break lengths, counts and sizes.
const EDGES: [u8; 12] = [0, 1, 2, 3, 7, 8, 9, 0x40, 0x7F, 0x80, 0xFE, 0xFF];

/// Makes a device's descriptors wrong, in one way or several.
pub fn mutate(descriptors: &mut Descriptors, random: &mut Random) {
    for _ in 0..1 + random.below(3) {
        let bytes = match random.below(6) {
            0 => &mut descriptors.device,
            1 | 2 => match descriptors.reports.first_mut() {
                Some(report) => report,
                None => &mut descriptors.device,
            },
            _ => &mut descriptors.configuration,
        };
        change(bytes, random);
    }
}

fn change(bytes: &mut Vec<u8>, random: &mut Random) {
    let length = bytes.len();
    if length == 0 {
        let count = random.below(64);
        bytes.extend(random.bytes(count));
        return;
    }
    let at = random.below(length);
    let edge = EDGES[random.below(EDGES.len())];
    match random.below(10) {
        // Too short, down to nothing.
        0 => bytes.truncate(at),
        // Too long.
        1 => {
            let more = random.below(600);
            bytes.extend(random.bytes(more));
        }
        // The same again and again, with a total that fits: more interfaces and endpoints than anybody has.
        2 => {
            let tail = bytes[9.min(length)..].to_vec();
            (0..random.below(40)).for_each(|_| bytes.extend(&tail));
            let total = bytes.len() as u16;
            set_total(bytes, total);
        }
        // A wrong total.
        3 => {
            let totals = [0, 1, 8, 9, 10, 0xFF, 0x100, 0x7FFF, 0xFFFF];
            set_total(bytes, totals[random.below(totals.len())]);
        }
        // A wrong length of a descriptor in the middle: none, less than its head, into the next, beyond the end.
        4 => {
            let heads = heads(bytes);
            let head = heads[random.below(heads.len())];
            bytes[head] = edge;
        }
        // A wrong type, number, address, size or interval in one.
        5 => {
            let heads = heads(bytes);
            let head = heads[random.below(heads.len())];
            let field = (head + 1 + random.below(8)).min(length - 1);
            bytes[field] = edge;
        }
        // One less.
        6 => {
            let heads = heads(bytes);
            let head = heads[random.below(heads.len())];
            let end = (head + usize::from(bytes[head]).max(1)).min(length);
            bytes.drain(head..end);
        }
        // The size of endpoint 0's packets, or whatever else is there.
        7 => bytes[7.min(length - 1)] = edge,
        // Anything anywhere.
        8 => (0..1 + random.below(8)).for_each(|_| bytes[random.below(length)] = random.byte()),
        // Anything at all.
        _ => *bytes = random.bytes(length),
    }
}

/// Where descriptors begin.
fn heads(bytes: &[u8]) -> Vec<usize> {
    let mut heads = vec![0];
    loop {
        let last = heads[heads.len() - 1];
        let next = last + usize::from(bytes[last]);
        if bytes[last] < 2 || next >= bytes.len() {
            return heads;
        }
        heads.push(next);
    }
}

fn set_total(bytes: &mut [u8], total: u16) {
    if let [_, _, low, high, ..] = bytes {
        [*low, *high] = total.to_le_bytes();
    }
}
