//! The contract, done the plainest way: every pixel of every box, bit positions written out.
//!
//! Shares no code with the model and none with `fpga_regs::packet` but the sizes.

use fpga_regs::Counters;
use fpga_regs::screen::{HEIGHT, PIXELS, WIDTH};
use raster_model::Device;

/// Everything that words can change.
pub struct Reference {
    pub colours: [Vec<u8>; 2],
    pub depths: Vec<u16>,
    pub front: usize,
    pub fence: u32,
    pub counters: Counters,
}

impl Reference {
    /// Returns a reference whose buffers are full of zeros.
    pub fn new() -> Self {
        Self {
            colours: [vec![0; PIXELS], vec![0; PIXELS]],
            depths: vec![0; PIXELS],
            front: 0,
            fence: 0,
            counters: Counters::default(),
        }
    }

    /// Does a whole stream. Returns how many words the packet lacks that the stream ends in.
    pub fn take(&mut self, stream: &[u32]) -> usize {
        let mut at = 0;
        while at < stream.len() {
            let header = stream[at];
            let (kind, length, modes, colour) =
                (header >> 24, (header >> 16 & 0xff) as usize, header >> 8 & 0xff, header as u8);
            let end = at + 1 + length;
            let good_header = modes & if kind == 2 || kind == 3 { 0xf8 } else { 0xff } == 0
                && match kind {
                    0x01 => length == 1,
                    0x02 => length == 10,
                    0x03 => length == 16 && colour == 0,
                    0x10 => length == 0 && colour == 0,
                    0x11 => length == 1 && colour == 0,
                    _ => false,
                };
            if !good_header {
                self.counters.bad_packets += 1;
            } else if end <= stream.len() {
                self.execute(kind, colour, modes, &stream[at + 1..end]);
            }
            at = end;
        }
        at - stream.len()
    }

    fn execute(&mut self, kind: u32, colour: u8, modes: u32, payload: &[u32]) {
        match kind {
            0x01 if payload[0] > 0xffff => self.counters.bad_packets += 1,
            0x01 => {
                self.colours[1 - self.front].fill(colour);
                self.depths.fill(payload[0] as u16);
            }
            0x02 => self.triangle(payload, modes, |_, _, _, _| colour),
            0x03 if [1, 3, 5].iter().any(|word| payload[*word] >> 31 != 0) => self.counters.bad_packets += 1,
            0x03 => {
                self.triangle(&payload[6..], modes, |x, y, right, down| gouraud_colour(payload, [x, y], right, down))
            }
            0x10 => {
                self.front = 1 - self.front;
                self.counters.frames_shown += 1;
            }
            _ => self.fence = payload[0],
        }
    }

    /// `colour` is asked for the colour at a pixel, and how far it lies right of and below the box's first.
    fn triangle(&mut self, payload: &[u32], modes: u32, colour: impl Fn(u32, u32, u32, u32) -> u8) {
        let (x0, x1) = (payload[0] & 0xffff, payload[0] >> 16);
        let (y0, y1) = (payload[1] & 0xffff, payload[1] >> 16);
        if x0 > x1 || x1 >= WIDTH || y0 > y1 || y1 >= HEIGHT {
            self.counters.bad_packets += 1;
            return;
        }
        self.counters.triangles += 1;
        let low = |word: u32| i32::from(word as i16);
        let high = |word: u32| i32::from((word >> 16) as i16);
        let (a0, b0, a1, b1) = (low(payload[5]), high(payload[5]), low(payload[6]), high(payload[6]));
        let steps = [(a0, b0), (a1, b1), (-(a0 + a1), -(b0 + b1))];
        for y in y0..=y1 {
            for x in x0..=x1 {
                let (right, down) = (x - x0, y - y0);
                let sum = |start: u32, step_x: u32, step_y: u32| {
                    start.wrapping_add(right.wrapping_mul(step_x)).wrapping_add(down.wrapping_mul(step_y)) as i32
                };
                let covered = (0..3).all(|i| sum(payload[2 + i], steps[i].0 as u32, steps[i].1 as u32) >= 0);
                if !covered {
                    continue;
                }
                self.counters.pixels_tested = self.counters.pixels_tested.wrapping_add(1);
                let depth = (sum(payload[7], payload[8], payload[9]) >> 12).clamp(0, 65_535) as u16;
                let pixel = (y * WIDTH + x) as usize;
                let (keep_depth, keep_colour, depth_grey) = (modes & 1 != 0, modes & 2 != 0, modes & 4 != 0);
                if !keep_depth && depth >= self.depths[pixel] {
                    continue;
                }
                self.counters.pixels_written = self.counters.pixels_written.wrapping_add(1);
                if !keep_depth {
                    self.depths[pixel] = depth;
                }
                if !keep_colour {
                    let grey = 255 - u32::from(depth) / 256;
                    self.colours[1 - self.front][pixel] =
                        if depth_grey { dithered([grey; 3], [x, y]) } else { colour(x, y, right, down) };
                }
            }
        }
    }

    /// Panics unless the device holds the same pixels and depths.
    pub fn assert_same_pictures(&self, device: &Device<'_>) {
        // Not assert_eq: its message would be a million characters long.
        let difference = |(name, ours, theirs): (&str, &[u8], &[u8])| {
            let at = ours.iter().zip(theirs).position(|(ours, theirs)| ours != theirs);
            at.map(|at| panic!("{name} differs at column {}, row {}", at % WIDTH as usize, at / WIDTH as usize))
        };
        difference(("front", &self.colours[self.front], device.front()));
        difference(("back", &self.colours[1 - self.front], device.back()));
        let at = self.depths.iter().zip(device.depth()).position(|(ours, theirs)| ours != theirs);
        assert_eq!(at, None, "depth differs");
    }
}

/// The colour of a Gouraud triangle's pixel, from the six words that stand before its shape.
fn gouraud_colour(words: &[u32], [x, y]: [u32; 2], right: u32, down: u32) -> u8 {
    // Red, green and blue, 21 bits each, stand in two words, lowest first.
    let channel = |index: u32, pair: usize| {
        let both = u64::from(words[2 * pair + 1]) << 32 | u64::from(words[2 * pair]);
        both >> (21 * index) & 0x1f_ffff
    };
    let eight_bits = |index: u32| {
        let sum = channel(index, 0) + channel(index, 1) * u64::from(right) + channel(index, 2) * u64::from(down);
        match (sum >> 12 & 0x1ff) as u32 {
            whole @ 0..=255 => whole,
            256..=383 => 255,
            _ => 0,
        }
    };
    dithered([0, 1, 2].map(eight_bits), [x, y])
}

fn dithered([red, green, blue]: [u32; 3], [x, y]: [u32; 2]) -> u8 {
    // Ordered dithering's matrix, by its definition: the bits of y and of x ^ y, interleaved, lowest bit first.
    let bit = |value: u32, bit: u32| value >> bit & 1;
    let threshold = bit(x ^ y, 0) << 3 | bit(y, 0) << 2 | bit(x ^ y, 1) << 1 | bit(y, 1);
    let of_8 = |value: u32| (value - value / 8 + 2 * threshold + 1) / 32;
    let of_4 = |value: u32| (value - value / 4 + 4 * threshold + 2) / 64;
    (of_8(red) << 5 | of_8(green) << 2 | of_4(blue)) as u8
}
