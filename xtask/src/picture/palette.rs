//! The colours of pictures that have few: an RGB332 frame has at most 256, and a PNG of one byte
//! a pixel is several times smaller than one of three.

use super::Picture;

/// Most colours that a byte can number.
const COLOURS_MAX: usize = 256;

/// Up to 256 colours in the order in which they first appear.
pub(super) struct Palette {
    /// For each of the 2^24 colours its number + 1, or 0. The system gives such a table only the
    /// few pages that are used, and a look-up a pixel has to be quick: an animation has millions.
    numbers: Vec<u16>,
    colours: Vec<u8>,
}

impl Palette {
    /// Returns the colours of all `pictures`, or `None` when there are more than 256.
    pub(super) fn of(pictures: &[Picture]) -> Option<Self> {
        let mut palette = Self { numbers: vec![0; 1 << 24], colours: Vec::new() };
        for picture in pictures {
            for pixel in picture.bytes().as_chunks::<3>().0 {
                if palette.numbers[index(*pixel)] == 0 {
                    let count = palette.colours.len() / 3;
                    if count == COLOURS_MAX {
                        return None;
                    }
                    palette.numbers[index(*pixel)] = count as u16 + 1;
                    palette.colours.extend_from_slice(pixel);
                }
            }
        }
        Some(palette)
    }

    /// Returns red, green, blue of each colour.
    pub(super) fn colours(&self) -> &[u8] {
        &self.colours
    }

    /// Returns each pixel's number; a colour that is not in the palette gives 0.
    pub(super) fn numbers(&self, picture: &Picture) -> Vec<u8> {
        let number = |pixel: &[u8; 3]| self.numbers[index(*pixel)].saturating_sub(1) as u8;
        picture.bytes().as_chunks::<3>().0.iter().map(number).collect()
    }
}

fn index([red, green, blue]: [u8; 3]) -> usize {
    usize::from(red) << 16 | usize::from(green) << 8 | usize::from(blue)
}
