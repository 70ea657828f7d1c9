//! Many pictures as one.

use anyhow::{Context, ensure};

use super::Picture;

/// Pixels between the pictures and around them.
const GAP: u32 = 8;
/// What shows there.
const GROUND: u8 = 40;

/// Returns pictures of one size beside and below each other, so many to a row, the first on the left on top.
///
/// # Errors
/// When there is none, a row takes none, or one is of another size.
pub fn sheet(pictures: &[&Picture], columns: u32) -> anyhow::Result<Picture> {
    let first = pictures.first().context("a sheet of no pictures has nothing in it")?;
    ensure!(columns > 0, "a sheet needs a column");
    let (width, height) = (first.width, first.height);
    let rows = (pictures.len() as u32).div_ceil(columns);
    let (all_width, all_height) = (columns * (width + GAP) + GAP, rows * (height + GAP) + GAP);
    let mut pixels = vec![GROUND; (3 * all_width * all_height) as usize];
    for (index, picture) in (0..).zip(pictures) {
        ensure!(
            (picture.width, picture.height) == (width, height),
            "picture {index} has {}×{} pixels, the first one {width}×{height}",
            picture.width,
            picture.height
        );
        let (left, top) = (GAP + index % columns * (width + GAP), GAP + index / columns * (height + GAP));
        for (line, row) in (top..).zip(picture.pixels.chunks_exact(3 * width as usize)) {
            let start = 3 * (line * all_width + left) as usize;
            pixels[start..start + row.len()].copy_from_slice(row);
        }
    }
    Picture::new(all_width, all_height, pixels)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_picture_stands_in_its_place() {
        let one = |value: u8| Picture::new(2, 1, vec![value; 6]).expect("the right size");
        let (red, green, blue) = (one(1), one(2), one(3));
        let whole = sheet(&[&red, &green, &blue], 2).expect("they are of one size");
        assert_eq!((whole.width(), whole.height()), (2 * 2 + 3 * GAP, 2 + 3 * GAP));
        let at = |x: u32, y: u32| whole.bytes()[3 * (y * whole.width() + x) as usize];
        assert_eq!([at(GAP, GAP), at(2 * GAP + 2, GAP), at(GAP, 2 * GAP + 1)], [1, 2, 3]);
        assert_eq!([at(GAP + 2, GAP), at(0, 0), at(2 * GAP + 2, 2 * GAP + 1)], [GROUND; 3]);
    }

    #[test]
    fn a_picture_of_another_size_is_refused() {
        let one = Picture::new(2, 1, vec![0; 6]).expect("the right size");
        assert!(sheet(&[&one, &one.doubled()], 2).is_err());
        assert!(sheet(&[], 2).is_err() && sheet(&[&one], 0).is_err());
    }
}
