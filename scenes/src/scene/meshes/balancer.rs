//! The game's meshes: its plate, its ball, what lies on the plate, and digits.

use fixed::types::I4F28;
use fpga_regs::board_io::DIGITS;
use geometry::mesh::Position;
use geometry::shapes::{Corners, SolidBuilder};
use geometry::{Angle, MeshError};

use super::Model;
use super::memory::MadeMemory;

/// How many there are.
pub(super) const COUNT: usize = 15;

/// Room for them.
pub(super) struct Memory {
    board: MadeMemory<384, 192, 208>,
    ball: MadeMemory<86, 168, 180>,
    hoop: MadeMemory<32, 32, 48>,
    spots: [MadeMemory<16, 14, 16>; 2],
    /// Of up to seven bars each.
    digits: [MadeMemory<28, 14, 28>; 10],
}

impl Memory {
    pub(super) const fn new() -> Self {
        Self {
            board: MadeMemory::new(),
            ball: MadeMemory::new(),
            hoop: MadeMemory::new(),
            spots: [const { MadeMemory::new() }; 2],
            digits: [const { MadeMemory::new() }; 10],
        }
    }

    /// Makes them, in the order of [`Shape::ALL`](super::Shape::ALL). `counts` is scratch, one for each vertex.
    ///
    /// # Errors
    /// [`MeshError`] if a mesh is malformed, which a test rules out.
    pub(super) fn models(&mut self, counts: &mut [u16]) -> Result<[Model<'_>; COUNT], MeshError> {
        let [bright, dark] = &mut self.spots;
        let first = [
            self.board.solid(Corners::Apart, board, None, counts)?,
            self.ball.solid(Corners::Shared, ball, None, counts)?,
            self.hoop.solid(Corners::Shared, hoop, None, counts)?,
            bright.solid(Corners::Shared, |solid| spot(solid, [30, 150, 80]), None, counts)?,
            dark.solid(Corners::Shared, |solid| spot(solid, [16, 20, 60]), None, counts)?,
        ];
        let mut models = [first[0]; COUNT];
        models[..first.len()].copy_from_slice(&first);
        for (value, (model, memory)) in models[first.len()..].iter_mut().zip(&mut self.digits).enumerate() {
            *model = memory.solid(Corners::Apart, |solid| digit(solid, value), None, counts)?;
        }
        Ok(models)
    }
}

const ONE: I4F28 = I4F28::ONE;
const ZERO: I4F28 = I4F28::ZERO;

/// Squares along a side of the board.
const SQUARES: i32 = 8;
/// How thick the board is.
const THICK: I4F28 = I4F28::lit("0.08");

/// Adds the board: chequered at y = 0, from −1 to 1 in x and z, with a rim below and no underside.
fn board(solid: &mut SolidBuilder<'_>) {
    const DARK: [u8; 3] = [0x27, 0x40, 0xab];
    const MEDIUM: [u8; 3] = [0x48, 0x76, 0xff];
    const LIGHT: [u8; 3] = [0xca, 0xe1, 0xff];
    let at = |index: i32| I4F28::from_num(index - SQUARES / 2) / (SQUARES / 2);
    for row in 0..SQUARES {
        for column in 0..SQUARES {
            let [left, right, far, near] = [at(column), at(column + 1), at(row), at(row + 1)];
            let colour = if (row + column) % 2 == 0 { MEDIUM } else { DARK };
            solid.facet(&[[left, ZERO, near], [right, ZERO, near], [right, ZERO, far], [left, ZERO, far]], colour);
        }
    }
    for part in 0..SQUARES {
        let (from, to) = (at(part), at(part + 1));
        for (start, end) in [
            ([from, ONE], [to, ONE]),
            ([ONE, -from], [ONE, -to]),
            ([-from, -ONE], [-to, -ONE]),
            ([-ONE, from], [-ONE, to]),
        ] {
            let corner = |[x, z]: [I4F28; 2], y: I4F28| [x, y, z];
            solid.facet(&[corner(start, -THICK), corner(end, -THICK), corner(end, ZERO), corner(start, ZERO)], LIGHT);
        }
    }
}

/// Sectors and rings of the ball.
const GLOBE: (u64, u64) = (12, 8);

/// Adds a ball of radius 1, striped so that one sees it roll.
fn ball(solid: &mut SolidBuilder<'_>) {
    const STRIPES: [[u8; 3]; 3] = [[255, 70, 50], [255, 255, 255], [255, 205, 60]];
    let (sectors, rings) = GLOBE;
    let part = |index: u64, of: u64| Angle::from_bits(((index << 32) / of) as u32).sin_cos();
    let at = |sector: u64, ring: u64| -> Position {
        let ((around_sine, around_cosine), (down_sine, down_cosine)) =
            (part(sector % sectors, sectors), part(ring, 2 * rings));
        let [s, c, across, y] = [around_sine, around_cosine, down_sine, down_cosine].map(I4F28::from_num);
        [s * across, y, c * across]
    };
    for ring in 0..rings {
        for sector in 0..sectors {
            let colour = STRIPES[(sector / 2 % 3) as usize];
            let [high, low] = [ring, ring + 1];
            let corners = [at(sector, low), at(sector + 1, low), at(sector + 1, high), at(sector, high)];
            match ring {
                0 => solid.facet(&[corners[0], corners[1], corners[2]], colour),
                _ if low == rings => solid.facet(&[corners[0], corners[2], corners[3]], colour),
                _ => solid.facet(&corners, colour),
            }
        }
    }
}

/// Corners of a disc.
const ROUND: u64 = 16;

/// A point of the circle of this radius in the plane y = 0.
fn round(index: u64, radius: I4F28) -> Position {
    let (sine, cosine) = Angle::from_bits(((index % ROUND) << 28) as u32).sin_cos();
    [I4F28::from_num(sine) * radius, ZERO, I4F28::from_num(cosine) * radius]
}

/// Adds a disc of radius 1 that lies on its back.
fn spot(solid: &mut SolidBuilder<'_>, colour: [u8; 3]) {
    let mut corners = [[ZERO; 3]; ROUND as usize];
    for (index, corner) in (0..).zip(&mut corners) {
        *corner = round(index, ONE);
    }
    solid.facet(&corners, colour);
}

/// Adds a flat ring of radius 1 that lies on its back.
fn hoop(solid: &mut SolidBuilder<'_>) {
    const INNER: I4F28 = I4F28::lit("0.78");
    for index in 0..ROUND {
        let corners = [round(index, ONE), round(index + 1, ONE), round(index + 1, INNER), round(index, INNER)];
        solid.facet(&corners, [255, 60, 40]);
    }
}

/// Adds a digit that stands in the plane z = 0, from −1 to 1 in y and −0.55 to 0.55 in x, of up to seven bars.
fn digit(solid: &mut SolidBuilder<'_>, value: usize) {
    const WIDE: I4F28 = I4F28::lit("0.55");
    const HIGH: I4F28 = ONE;
    const STROKE: I4F28 = I4F28::lit("0.24");
    let half = STROKE / 2;
    let (low, high) = ((-HIGH, half), (-half, HIGH));
    let (left, right, whole) = ((-WIDE, STROKE - WIDE), (WIDE - STROKE, WIDE), (-WIDE, WIDE));
    // From a, the one on top, clockwise to f; then g, the one in the middle.
    let bars = [
        (whole, (HIGH - STROKE, HIGH)),
        (right, high),
        (right, low),
        (whole, (-HIGH, STROKE - HIGH)),
        (left, low),
        (left, high),
        (whole, (-half, half)),
    ];
    let segments = DIGITS.get(value).copied().unwrap_or(0);
    for (bit, (x, y)) in bars.into_iter().enumerate() {
        if segments >> bit & 1 == 1 {
            solid.facet(&[[x.0, y.0, ZERO], [x.1, y.0, ZERO], [x.1, y.1, ZERO], [x.0, y.1, ZERO]], [255, 230, 120]);
        }
    }
}
