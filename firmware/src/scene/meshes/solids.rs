//! Solids of flat facets.

use fixed::types::I4F28;
use geometry::Angle;
use geometry::mesh::Position;
use geometry::shapes::{MAX_FACET_CORNERS, SolidBuilder};

const ONE: I4F28 = I4F28::ONE;
const ZERO: I4F28 = I4F28::ZERO;

/// Facets of a box by its corners' bits: x, y, z from bit 0 on, set where the coordinate is high.
const BOX_FACETS: [[u8; 4]; 6] = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];

/// Adds the facets of a box from corner `low` to corner `high`, in the order left, right, bottom, top, back,
/// front; one without a colour is left out.
pub(super) fn cuboid(solid: &mut SolidBuilder<'_>, low: Position, high: Position, colours: [Option<[u8; 3]>; 6]) {
    let corner = |bits: u8| [0, 1, 2].map(|axis| if bits >> axis & 1 == 1 { high[axis] } else { low[axis] });
    for (facet, colour) in BOX_FACETS.iter().zip(colours) {
        if let Some(colour) = colour {
            solid.facet(&facet.map(corner), colour);
        }
    }
}

/// Adds a pyramid: a square from −1 to 1 at y = −1, its top at y = 1.
pub(super) fn pyramid(solid: &mut SolidBuilder<'_>, colour: [u8; 3]) {
    let base = [[-ONE, -ONE, ONE], [ONE, -ONE, ONE], [ONE, -ONE, -ONE], [-ONE, -ONE, -ONE]];
    for side in 0..4 {
        solid.facet(&[base[side], base[(side + 1) % 4], [ZERO, ONE, ZERO]], colour);
    }
    let [a, b, c, d] = base;
    solid.facet(&[d, c, b, a], colour);
}

/// The pyramid's colours: white at the top, one of four at each corner of the base.
pub(super) fn pyramid_colour(position: &Position) -> [u8; 3] {
    match (position[1] > 0, position[0] > 0, position[2] > 0) {
        (true, ..) => [255; 3],
        (_, true, true) => [255, 0, 0],
        (_, true, false) => [255, 255, 0],
        (_, false, true) => [0, 96, 255],
        (_, false, false) => [0, 255, 0],
    }
}

/// Adds a prism about the y axis, of radius 1 and from y = −1 to 1: two facets of `corners` corners (at most
/// [`MAX_FACET_CORNERS`]) and as many sides. The colours are the bottom's and the top's, then the sides', in turn.
pub(super) fn prism(solid: &mut SolidBuilder<'_>, corners: usize, ends: [[u8; 3]; 2], sides: &[[u8; 3]]) {
    let mut ring = [[ZERO; 3]; MAX_FACET_CORNERS];
    let Some(ring) = ring.get_mut(..corners) else { return };
    let whole = corners.max(1) as u64;
    for (index, corner) in ring.iter_mut().enumerate() {
        let (sine, cosine) = Angle::from_bits(((index as u64) << 32).div_euclid(whole) as u32).sin_cos();
        *corner = [I4F28::from_num(sine), ONE, I4F28::from_num(cosine)];
    }
    let low = |[x, _, z]: Position| [x, -ONE, z];
    solid.facet(ring, ends[1]);
    for (index, colour) in (0..corners).zip(sides.iter().cycle()) {
        let (here, next) = (ring[index], ring[(index + 1) % corners]);
        solid.facet(&[low(here), low(next), next, here], *colour);
    }
    ring.reverse();
    ring.iter_mut().for_each(|corner| *corner = low(*corner));
    solid.facet(ring, ends[0]);
}

/// Colours of the dodecahedron's facets.
const TWELVE: [[u8; 3]; 12] = [
    [255, 64, 64],
    [255, 150, 40],
    [255, 230, 70],
    [150, 220, 60],
    [40, 180, 90],
    [60, 220, 200],
    [70, 150, 255],
    [80, 80, 255],
    [150, 70, 230],
    [230, 90, 220],
    [255, 150, 180],
    [220, 220, 220],
];

/// The dodecahedron's facets: its corners are those of a cube (0 to 7: a bit is set where x, y, z is low) and of
/// three rectangles (from 8 on, four each).
#[rustfmt::skip]
const PENTAGONS: [[u8; 5]; 12] = [
    [17, 1, 8, 0, 16], [16, 0, 12, 13, 4], [12, 0, 8, 9, 2], [16, 4, 10, 5, 17],
    [6, 13, 12, 2, 18], [3, 9, 8, 1, 14], [18, 2, 9, 3, 19], [5, 15, 14, 1, 17],
    [6, 11, 10, 4, 13], [19, 7, 11, 6, 18], [19, 3, 14, 15, 7], [15, 5, 10, 11, 7],
];

/// Adds a dodecahedron whose corners lie on the sphere of radius 1: twelve pentagons.
pub(super) fn dodecahedron(solid: &mut SolidBuilder<'_>) {
    const CUBE: I4F28 = I4F28::lit("0.577350269");
    const SHORT: I4F28 = I4F28::lit("0.356822090");
    const LONG: I4F28 = I4F28::lit("0.934172359");
    let corner = |index: u8| {
        let signed = |size: I4F28, bit: u8| if index >> bit & 1 == 1 { -size } else { size };
        if index < 8 {
            return [0, 1, 2].map(|bit| signed(CUBE, bit));
        }
        let plane = usize::from(index) / 4 - 2;
        let mut corner = [ZERO; 3];
        corner[(plane + 1) % 3] = signed(SHORT, 0);
        corner[(plane + 2) % 3] = signed(LONG, 1);
        corner
    };
    for (facet, colour) in PENTAGONS.iter().zip(TWELVE) {
        solid.facet(&facet.map(corner), colour);
    }
}
