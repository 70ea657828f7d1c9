//! A house of lines: what the wireframe scene shows.

use fixed::types::I4F28;
use geometry::mesh::Position;
use geometry::shapes::SolidBuilder;

use super::solids::cuboid;

/// A hundredth, rounded down.
const HUNDREDTH: i32 = (1 << 28) / 100;

const WALL: [u8; 3] = [230, 210, 170];
const ROOF: [u8; 3] = [200, 70, 50];
const BRICK: [u8; 3] = [150, 80, 60];

/// A point in hundredths.
fn at(x: i32, y: i32, z: i32) -> Position {
    [x, y, z].map(|part| I4F28::from_bits(part * HUNDREDTH))
}

/// Adds the house: walls with gables, a roof, a chimney, and a door and windows of lines. It is 1.8 wide, 1.4
/// high and 1.2 deep, its middle at the origin.
pub(super) fn house(solid: &mut SolidBuilder<'_>) {
    let [left, right] = [-90, 90].map(|x| [at(x, -70, -60), at(x, -70, 60), at(x, 5, 60), at(x, 70, 0), at(x, 5, -60)]);
    solid.facet(&left, WALL);
    let [a, b, c, d, e] = right;
    solid.facet(&[a, e, d, c, b], WALL);
    let [front, roof_front, roof_back, back, floor] = [1, 2, 3, 4, 0].map(|side| {
        let next = (side + 1) % 5;
        [left[side], right[side], right[next], left[next]]
    });
    solid.facet(&front, WALL);
    solid.facet(&roof_front, ROOF);
    solid.facet(&roof_back, ROOF);
    solid.facet(&back, WALL);
    solid.facet(&floor, WALL);
    let brick = Some(BRICK);
    cuboid(solid, at(35, 30, -35), at(55, 85, -15), [brick, brick, None, brick, brick, brick]);
    frame(solid, [-15, -70], [15, -20]);
    for x in [-60, 60] {
        frame(solid, [x - 17, -45], [x + 17, -15]);
        solid.line([at(x, -45, 60), at(x, -15, 60)]);
        solid.line([at(x - 17, -30, 60), at(x + 17, -30, 60)]);
    }
}

/// A rectangle of lines on the front.
fn frame(solid: &mut SolidBuilder<'_>, [left, low]: [i32; 2], [right, high]: [i32; 2]) {
    let corners = [at(left, low, 60), at(right, low, 60), at(right, high, 60), at(left, high, 60)];
    for (index, corner) in corners.iter().enumerate() {
        solid.line([*corner, corners[(index + 1) % 4]]);
    }
}
