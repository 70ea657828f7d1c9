//! A random stream, good and bad, fed in every way, with comparisons in between.

use fpga_regs::Port;
use fpga_regs::packet::{Clear, Fence, FlatTriangle, TriangleShape, swap};
use fpga_regs::registers::{Capabilities, Control, Register};
use fpga_regs::screen::{PacketDepth, Rgb332};

use super::pair::Pair;
use super::random::Random;
use super::shapes::{any_gouraud_triangle, any_triangle, garbage_triangle, garbage_words};

/// Packets between two comparisons.
const BATCH: usize = 250;

/// How the words of a batch reach the device.
enum Feed {
    /// Back to back.
    Fast,
    /// With random pauses.
    Halting,
    /// Into the disabled device, which is then enabled.
    Blocked,
}

/// Draws at least so many triangles and compares device and model after every batch.
pub fn random_stream(pair: &mut Pair, triangles: u32, random: &mut Random) {
    let units = pair.rtl.units();
    // With room for the zeros that end a packet under way.
    let depth = usize::from(Capabilities(pair.rtl.read(Register::Capabilities)).fifo_depth());
    let mut drawn = 0;
    let mut batch = 0;
    while drawn < triangles {
        let mut words = Vec::new();
        for _ in 0..BATCH {
            match random.within(0, 399) {
                0..2 => words.extend(Clear { colour: Rgb332(random.word() as u8), depth: 0xffff }.encode()),
                2 => words.extend(Clear { colour: Rgb332(random.word() as u8), depth: random.word() as u16 }.encode()),
                3 => words.extend(swap()),
                4..8 => words.extend(Fence { tag: random.word() }.encode()),
                8..12 => words.extend(garbage_words(random)),
                12..32 => {
                    let garbage = garbage_triangle(random);
                    if random.one_in(2) {
                        words.extend(garbage);
                    } else {
                        // The colours stand before the words that all triangles end with; the spare bits stay 0.
                        let gouraud = any_gouraud_triangle(random).encode();
                        words.extend(&gouraud[..gouraud.len() - TriangleShape::WORDS]);
                        words.extend(&garbage[1..]);
                    }
                    drawn += 1;
                }
                // Again and again at one place, which only forwarding gets right.
                32..42 => {
                    let triangle = any_triangle(random);
                    for _ in 0..4 {
                        let depth = triangle.shape.depth.wrapping_add(fixed_depth(random.within(-4, 4)));
                        let again = FlatTriangle { shape: TriangleShape { depth, ..triangle.shape }, ..triangle };
                        words.extend(again.with_colour(Rgb332(random.word() as u8)).encode());
                        drawn += 1;
                    }
                }
                42..200 => {
                    words.extend(any_gouraud_triangle(random).encode());
                    drawn += 1;
                }
                _ => {
                    words.extend(any_triangle(random).encode());
                    drawn += 1;
                }
            }
        }
        let feed = match random.within(0, 3) {
            0 => Feed::Halting,
            1 => Feed::Blocked,
            _ => Feed::Fast,
        };
        match feed {
            Feed::Fast => pair.push(&words),
            Feed::Halting => {
                pair.model.push(&words);
                for word in words {
                    pair.rtl.push_word(word);
                    if random.one_in(3) {
                        pair.rtl.clock(random.within(1, 30) as u64);
                    }
                }
            }
            Feed::Blocked => {
                for part in words.chunks(depth - 24) {
                    pair.rtl.drain(20_000_000);
                    pair.write(Register::Control, 0);
                    pair.push(part);
                    pair.write(Register::Control, Control::default().with_enable(true).0);
                }
            }
        }
        batch += 1;
        pair.compare(&format!("after batch {batch}"));
        if random.one_in(8) {
            pair.write(Register::Errors, !0);
            pair.write(Register::Interrupts, !0);
        }
        if random.one_in(16) {
            pair.write(Register::Control, Control::default().with_enable(true).with_reset(true).0);
        }
    }
    println!("{units} pixel units: {drawn} triangles in {batch} batches, {} clocks", pair.rtl.clocks());
}

fn fixed_depth(whole: i32) -> PacketDepth {
    PacketDepth::from_bits(whole << 12)
}
