//! The plate of "3D Rendering in FPGA" (Columbia, 2014) as constants for the firmware.

use std::fmt::Write as _;

use crate::model::{face_normal, position_bits};
use crate::paths::workspace_root;

/// Its three blues, by face number: 0–39, 40–78, the rest.
fn colour(face: usize) -> [u8; 3] {
    match face {
        0..=39 => [0x27, 0x40, 0xab],
        40..=78 => [0x48, 0x76, 0xff],
        _ => [0xca, 0xe1, 0xff],
    }
}

/// Returns the Rust module.
///
/// # Errors
/// When `assets/plate.obj` cannot be read.
pub fn text() -> anyhow::Result<String> {
    let model = models::obj::read_obj(&workspace_root().join("assets/plate.obj"))?;
    let mut text = String::from(
        "//! The plate: positions, faces, normals and colours.\n//!\n\
         //! Generated from `assets/plate.obj` by `cargo xtask generate`: change it there.\n\n\
         use fixed::types::I4F28;\nuse geometry::Face;\nuse geometry::mesh::Position;\n\n\
         const fn position(x: i32, y: i32, z: i32) -> Position {\n    \
         [I4F28::from_bits(x), I4F28::from_bits(y), I4F28::from_bits(z)]\n}\n\n",
    );
    let _ = writeln!(
        text,
        "/// Corners in model space.\n#[rustfmt::skip]\npub(super) static POSITIONS: [Position; {}] = [",
        model.positions.len()
    );
    for position in &model.positions {
        let [x, y, z] = position_bits(*position);
        let _ = writeln!(text, "    position({x}, {y}, {z}),");
    }
    let _ = writeln!(
        text,
        "];\n\n/// Triangles, clockwise seen from outside.\n#[rustfmt::skip]\npub(super) static FACES: [Face; {}] = [",
        model.triangle_count()
    );
    for (face, corners) in model.triangles().enumerate() {
        // Clockwise: the normal of the reversed triangle points outwards.
        let [a, b, c] = corners.map(|corner| model.positions[corner as usize]);
        let (normal, colour) = (face_normal([a, c, b]), colour(face));
        let _ = writeln!(text, "    Face {{ corners: {corners:?}, normal: {normal:?}, colour: {colour:?} }},");
    }
    text.push_str("];\n");
    Ok(text)
}
