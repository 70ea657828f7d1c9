//! Sizes and number formats that software and FPGA share.
//!
//! Screen coordinates: x to the right, y **down**, row 0 on top, pixel centres at .5.
//! Sub-pixel coordinates count sixteenths of a pixel.

use fixed::FixedI32;
use fixed::types::extra::U12;

/// Screen width in pixels. VGA shows every pixel twice: 640.
pub const WIDTH: u32 = 320;
/// Screen height in pixels. VGA shows every row twice: 480.
pub const HEIGHT: u32 = 240;
/// Pixels of one buffer.
pub const PIXELS: usize = (WIDTH * HEIGHT) as usize;

/// Fraction bits of a sub-pixel coordinate: sixteenths of a pixel.
pub const SUBPIXEL_BITS: u32 = 4;
/// Sub-pixel steps in one pixel.
pub const SUBPIXEL: i32 = 1 << SUBPIXEL_BITS;

/// Guard band: the largest magnitude of a vertex's screen coordinate, in sixteenths of a pixel,
/// that triangle setup takes (511.9375 pixels on each side of the screen's upper left corner).
///
/// Chosen by the number formats: the difference of two such coordinates is below 2¹⁴, twice the
/// area of a triangle between them below 2²⁸, and the numerator of its depth gradient below 2³¹.
pub const GUARD_BAND: i32 = (1 << 13) - 1;

/// Fraction bits of depth and its steps in a packet (Q20.12).
pub const DEPTH_FRACTION_BITS: u32 = 12;
/// Fraction bits of a colour channel and its steps in a packet (Q9.12).
pub const COLOUR_FRACTION_BITS: u32 = 12;
/// The depth that a clear leaves, and the far plane.
pub const DEPTH_FAR: u16 = u16::MAX;

/// Depth at a pixel in a packet, and its step from pixel to pixel: signed Q20.12, **modulo 2³²**.
pub type PacketDepth = FixedI32<U12>;

/// Words of address space behind the FIFO aperture: a write to any of them pushes one word.
pub const FIFO_APERTURE_WORDS: usize = 1024;
/// Offset of the FIFO aperture from the registers when both sit on the lightweight bridge, in bytes.
pub const LIGHTWEIGHT_APERTURE_OFFSET: usize = 0x1000;

/// A colour as the framebuffer holds it: red in bits 7…5, green in 4…2, blue in 1…0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(transparent)]
pub struct Rgb332(pub u8);

impl Rgb332 {
    /// Black.
    pub const BLACK: Self = Self(0);

    /// Returns the nearest RGB332 colour to an 8-bit-per-channel one; a tie goes up.
    ///
    /// `geometry`'s `Intensity::framebuffer_colour` does the same for a colour and its light at once.
    #[inline(always)]
    pub const fn nearest(red: u8, green: u8, blue: u8) -> Self {
        // round(v·7/255) and round(v·3/255), exact for every v below 256 (tested).
        let (red, green, blue) = (nearest_of_8(red), nearest_of_8(green), (blue as u32 * 193 + 8192) >> 14);
        Self((red << 5 | green << 2 | blue) as u8)
    }

    /// Returns the 8-bit-per-channel colour that the VGA converter is given, by bit replication:
    /// 0 is 0 and full scale is 255 in every channel.
    pub const fn to_rgb888(self) -> [u8; 3] {
        let (red, green, blue) = (self.0 >> 5, self.0 >> 2 & 7, self.0 & 3);
        [red << 5 | red << 2 | red >> 1, green << 5 | green << 2 | green >> 1, blue * 0x55]
    }
}

#[inline(always)]
const fn nearest_of_8(channel: u8) -> u32 {
    (channel as u32 * 225 + 4096) >> 13
}

/// The thresholds of ordered dithering, 0…15, by row and column modulo 4 ([Bayer 1973]'s matrix).
///
/// [Bayer 1973]: https://en.wikipedia.org/wiki/Ordered_dithering
pub const DITHER: [[u8; 4]; 4] = [[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]];

/// Returns the RGB332 colour that the device gives pixel (`x`, `y`) of a Gouraud triangle, from 8
/// bits a channel.
///
/// A channel is scaled to 7/8 (blue to 3/4), the pixel's threshold added and the fraction dropped.
/// So 0 stays 0 and 255 full scale whatever the threshold, and over 4×4 pixels of one colour the
/// levels' mean is that colour to 1/16 of a level. Dropping the fraction alone, without
/// thresholds, would show a smooth face as seven bands.
#[inline(always)]
pub const fn dithered([red, green, blue]: [u8; 3], x: u32, y: u32) -> Rgb332 {
    let threshold = DITHER[(y & 3) as usize][(x & 3) as usize];
    let (red, green) = (dithered_to_8(red, threshold), dithered_to_8(green, threshold));
    let blue = (blue - (blue >> 2) + 4 * threshold + 2) >> 6;
    Rgb332(red << 5 | green << 2 | blue)
}

/// Dithers a channel to 3 bits. The sum is at most 224 + 31, so it fits 8 bits.
#[inline(always)]
const fn dithered_to_8(channel: u8, threshold: u8) -> u8 {
    (channel - (channel >> 3) + 2 * threshold + 1) >> 5
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_is_the_nearest_of_all_levels() {
        for value in 0..=255u8 {
            let closest = |levels: u32| {
                let distance = |level: &u32| (f64::from(*level) * 255.0 / f64::from(levels) - f64::from(value)).abs();
                (0..=levels).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap()
            };
            let got = Rgb332::nearest(value, value, value).0;
            assert_eq!(u32::from(got >> 5), closest(7), "red of {value}");
            assert_eq!(u32::from(got >> 2 & 7), closest(7), "green of {value}");
            assert_eq!(u32::from(got & 3), closest(3), "blue of {value}");
        }
    }

    #[test]
    fn dithering_keeps_the_mean_and_the_ends() {
        for value in 0..=255u8 {
            let mut sums = [0u32; 3];
            for (x, y) in (0..16).map(|index| (index % 4, index / 4)) {
                let bits = dithered([value, value, value], 100 + x, 36 + y).0;
                let levels = [bits >> 5, bits >> 2 & 7, bits & 3];
                sums.iter_mut().zip(levels).for_each(|(sum, level)| *sum += u32::from(level));
                if value == 0 || value == 255 {
                    assert_eq!(bits, value, "at {x}, {y}");
                }
            }
            for (sum, levels) in sums.into_iter().zip([7.0, 7.0, 3.0]) {
                let (mean, exact) = (f64::from(sum) / 16.0, f64::from(value) * levels / 255.0);
                assert!((mean - exact).abs() <= 1.0 / 16.0, "{value} comes out as {mean} of {levels}, not {exact}");
            }
        }
        let mut thresholds = DITHER.concat();
        thresholds.sort_unstable();
        assert!(thresholds.iter().enumerate().all(|(index, threshold)| index == usize::from(*threshold)));
    }

    #[test]
    fn every_colour_survives_the_way_to_the_screen_and_back() {
        for bits in 0..=255 {
            let [red, green, blue] = Rgb332(bits).to_rgb888();
            assert_eq!(Rgb332::nearest(red, green, blue), Rgb332(bits));
        }
        assert_eq!(Rgb332(0xff).to_rgb888(), [255; 3]);
    }

    #[test]
    fn the_guard_band_keeps_its_promises_and_holds_the_screen() {
        let widest = i64::from(2 * GUARD_BAND);
        assert!(widest < 1 << 14 && widest * widest < 1 << 28);
        assert!(2 * widest * i64::from(DEPTH_FAR) < 1 << 31);
        assert!((WIDTH.max(HEIGHT) as i32) < GUARD_BAND / SUBPIXEL);
    }
}
