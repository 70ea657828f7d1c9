//! RGB pictures and the files they are kept in: PNG, animated PNG, and 16-bit PGM for depth.
//!
//! The same picture always gives the same bytes, so a file that git shows as changed has changed.

mod palette;
mod png_file;
mod pnm;
mod sheet;

use anyhow::ensure;

pub use png_file::{read_png, write_animated_png, write_png};
pub use pnm::{read_ppm, write_depth_pgm};
pub use sheet::sheet;

/// A picture of 8-bit RGB pixels, row 0 on top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    width: u32,
    height: u32,
    pixels: Vec<u8>,
}

impl Picture {
    /// Returns the picture of `pixels`: red, green, blue of each pixel, row by row from the top.
    ///
    /// # Errors
    ///
    /// When a side is 0, or there are not 3 bytes for each pixel.
    pub fn new(width: u32, height: u32, pixels: Vec<u8>) -> anyhow::Result<Self> {
        ensure!(width > 0 && height > 0, "a picture of {width}×{height} pixels has nothing in it");
        let expected = u128::from(width) * u128::from(height) * 3;
        ensure!(
            pixels.len() as u128 == expected,
            "{} bytes for {width}×{height} pixels of 3 bytes: {expected} are needed",
            pixels.len()
        );
        Ok(Self { width, height, pixels })
    }

    /// Returns the width in pixels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Returns the height in pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Returns red, green, blue of each pixel, row by row from the top.
    pub fn bytes(&self) -> &[u8] {
        &self.pixels
    }

    /// Returns each pixel as red, green, blue, row by row from the top.
    pub fn pixels(&self) -> impl Iterator<Item = [u8; 3]> {
        self.pixels.as_chunks::<3>().0.iter().copied()
    }

    /// Returns the picture with each pixel doubled both ways, as the VGA output shows it.
    #[must_use]
    pub fn doubled(&self) -> Self {
        let row_bytes = self.width as usize * 3;
        let mut pixels = Vec::with_capacity(self.pixels.len() * 4);
        for row in self.pixels.chunks_exact(row_bytes) {
            let start = pixels.len();
            for pixel in row.as_chunks::<3>().0 {
                pixels.extend_from_slice(pixel);
                pixels.extend_from_slice(pixel);
            }
            pixels.extend_from_within(start..);
        }
        Self { width: self.width * 2, height: self.height * 2, pixels }
    }

    /// Returns every other pixel of every other row: what [`doubled`](Self::doubled) was made of.
    #[must_use]
    pub fn halved(&self) -> Self {
        let rows = self.pixels.chunks_exact(self.width as usize * 3).step_by(2);
        let pixels = rows.flat_map(|row| row.as_chunks::<3>().0.iter().step_by(2)).flatten().copied().collect();
        Self { width: self.width.div_ceil(2), height: self.height.div_ceil(2), pixels }
    }

    /// Returns how many pixels differ, or `None` when the sizes do.
    pub fn differing_pixels(&self, other: &Self) -> Option<usize> {
        let same_size = (self.width, self.height) == (other.width, other.height);
        same_size.then(|| self.pixels().zip(other.pixels()).filter(|(left, right)| left != right).count())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wrong_byte_count_is_refused() {
        assert!(Picture::new(2, 2, vec![0; 12]).is_ok());
        let message = Picture::new(2, 2, vec![0; 11]).expect_err("one short").to_string();
        assert_eq!(message, "11 bytes for 2×2 pixels of 3 bytes: 12 are needed");
        assert!(Picture::new(0, 2, Vec::new()).is_err());
        assert!(Picture::new(u32::MAX, u32::MAX, vec![0; 3]).is_err());
    }

    #[test]
    fn doubling_repeats_every_pixel_and_row() {
        let picture = Picture::new(2, 1, vec![1, 2, 3, 4, 5, 6]).expect("the right size");
        let row = [1, 2, 3, 1, 2, 3, 4, 5, 6, 4, 5, 6];
        let doubled = picture.doubled();
        assert_eq!((doubled.width(), doubled.height()), (4, 2));
        assert_eq!(doubled.bytes(), [row, row].concat());
        assert_eq!(doubled.halved(), picture);
        assert_eq!(Picture::new(3, 1, vec![7; 9]).expect("the right size").halved().bytes(), [7; 6]);
    }

    #[test]
    fn differences_are_counted_by_pixel() {
        let picture = Picture::new(2, 1, vec![0; 6]).expect("the right size");
        let other = Picture::new(2, 1, vec![0, 0, 0, 1, 1, 0]).expect("the right size");
        assert_eq!(picture.differing_pixels(&other), Some(1));
        assert_eq!(picture.differing_pixels(&picture), Some(0));
        assert_eq!(picture.differing_pixels(&picture.doubled()), None);
    }
}
