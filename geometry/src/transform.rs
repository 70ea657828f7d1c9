//! A vertex from model space to the screen.

use fixed::types::I32F32;
use fpga_regs::screen::{DEPTH_FAR, HEIGHT, SUBPIXEL, WIDTH};

use crate::clip::{PLANES, distance};
use crate::matrix::Matrix;
use crate::mesh::{Mesh, Position};
use crate::reciprocal::{high, reciprocal};
use crate::setup::ScreenVertex;

/// log₂ of the screen coordinate, in sixteenths of a pixel, where x = w in [`Homogeneous`] space.
const FULL_SCALE_BITS: u32 = 14;
/// No coordinate of a [`Homogeneous`] vertex reaches 2 to this.
const MAGNITUDE_BITS: u32 = 29;
/// Fraction bits of a coordinate over w.
const QUOTIENT_BITS: u32 = 29;
/// The smallest w that is divided by; below it a vertex is clipped. A near plane nearer than
/// about a millionth of the farthest that the mesh can reach is therefore not honoured.
pub const SMALLEST_W: i32 = 256;

/// A vertex in homogeneous screen space.
///
/// x/w and y/w are screen coordinates over 2¹⁴ sixteenths of a pixel, y down; z/w is half the
/// depth, 0 at the near plane and ½ at the far one. So inside the guard band and between the
/// planes none of them exceeds w/2. All four share a scale that the [`ScreenTransform`] chose,
/// and are below 2²⁹ in magnitude.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Homogeneous {
    /// To the right.
    pub x: i32,
    /// Down.
    pub y: i32,
    /// Away from the eye.
    pub z: i32,
    /// What the others are divided by.
    pub w: i32,
}

/// Returns twice the largest magnitude of x and y that the guard band takes at a given w: it keeps
/// a rounded screen coordinate within [`GUARD_BAND`](fpga_regs::screen::GUARD_BAND).
#[inline(always)]
pub fn doubled_guard_band(w: i32) -> i32 {
    // Less than half of w by two sixteenths of a pixel or more, at any w.
    w - (w >> (FULL_SCALE_BITS - 2)) - 1
}

impl Homogeneous {
    /// Returns which planes the vertex is outside of, a bit each, as [`clip`](crate::clip)
    /// numbers them. Three corners that share a bit make a triangle of which nothing is left.
    fn outcode(&self) -> u32 {
        (0..PLANES).filter(|plane| distance(self, *plane) < 0).fold(0, |code, plane| code | 1 << plane)
    }

    /// Returns the vertex on the screen, each coordinate rounded half up.
    ///
    /// The vertex must be inside: w at least [`SMALLEST_W`], z in 0…w/2, x and y in the guard band.
    /// Screen coordinates are within 1/32 + 1/512 of a pixel of the exact quotient, depth within 0.6.
    #[inline(always)]
    pub(crate) fn project(&self) -> ScreenVertex {
        let shift = (self.w as u32).leading_zeros();
        let over_w = reciprocal((self.w as u32) << shift);
        // (value · 2^shift) · (2⁶¹/(w · 2^shift)) / 2³² = value/w in Q29; no value exceeds w/2.
        let quotient = |value: i32| high(value << shift, over_w);
        let fraction_bits = QUOTIENT_BITS - FULL_SCALE_BITS;
        let on_screen = |value: i32| (quotient(value) + (1 << (fraction_bits - 1))) >> fraction_bits;
        // Twice z/w is depth, so q is in Q28. q · 65,535 = q · 65,536 − q.
        let depth = quotient(self.z);
        let depth = (depth - (depth >> 16) + (1 << (QUOTIENT_BITS - 18))) >> (QUOTIENT_BITS - 17);
        ScreenVertex { x: on_screen(self.x), y: on_screen(self.y), depth, outside: 0 }
    }
}

/// The way from one mesh's model space to the screen, ready for its vertices.
///
/// Holds model, view, projection and viewport in one matrix of four rows. The rows are scaled
/// together by a power of two, so that every vertex of the mesh uses the 32 bits as far as it can:
/// homogeneous coordinates may be scaled freely, and this is where the precision near the eye
/// comes from.
#[derive(Debug, Clone, Copy)]
pub struct ScreenTransform {
    rows: [Row; 4],
}

/// A row: a dot product with a position (Q4.28) whose upper half is the coordinate.
#[derive(Debug, Clone, Copy, Default)]
struct Row {
    /// Includes the half that makes the one rounding go half up.
    offset: i64,
    factors: [i32; 3],
}

impl Row {
    #[inline(always)]
    fn times(&self, [x, y, z]: [i32; 3]) -> i32 {
        let [a, b, c] = self.factors.map(i64::from);
        ((self.offset + a * i64::from(x) + b * i64::from(y) + c * i64::from(z)) >> 32) as i32
    }
}

impl ScreenTransform {
    /// Returns the transform for a mesh under a model-to-clip-space matrix.
    ///
    /// The error of a row is below 5 · 2⁻²⁹ of the greatest coordinate that any vertex of the mesh
    /// can have; a matrix of zeros puts every vertex behind the eye.
    pub fn new(model_to_clip: &Matrix, mesh: &Mesh<'_>) -> Self {
        Self::of_extent(model_to_clip, mesh.extent())
    }

    /// As [`new`](Self::new), for all positions of which no coordinate's magnitude exceeds `extent`, in units of
    /// 2⁻²⁸: parts of one mesh that share vertices must share their transform, or there are cracks between them.
    pub fn of_extent(model_to_clip: &Matrix, extent: [u32; 3]) -> Self {
        let rows = viewport_rows(model_to_clip);
        let extent = extent.map(i128::from);
        // Greatest magnitude of each row's sum over the mesh, and of its factors.
        let sum_bound = |row: &[i128; 4]| {
            let products: i128 = (0..3).map(|axis| row[axis].abs() * extent[axis]).sum();
            products + (row[3].abs() << POSITION_BITS)
        };
        let largest_sum = rows.iter().map(sum_bound).max().unwrap_or(0);
        let largest_factor = rows.iter().flat_map(|row| &row[..3]).map(|factor| factor.abs()).max().unwrap_or(0);
        let spare = (bits(largest_sum) - (32 + MAGNITUDE_BITS as i32 - 1)).max(bits(largest_factor) - 30);
        Self { rows: rows.map(|row| scaled_row(&row, spare)) }
    }

    /// Returns a vertex in homogeneous screen space; each coordinate is one dot product in 64
    /// bits, rounded once, half up.
    #[inline(always)]
    pub fn homogeneous(&self, position: &Position) -> Homogeneous {
        let position = position.map(|part| part.to_bits());
        let [x, y, z, w] = &self.rows;
        Homogeneous { x: x.times(position), y: y.times(position), z: z.times(position), w: w.times(position) }
    }

    /// Puts a vertex on the screen, or marks it as outside if it has to be clipped; returns
    /// whether it is inside.
    #[inline(always)]
    pub(crate) fn project_into(&self, position: &Position, vertex: &mut ScreenVertex) -> bool {
        // A row at a time, and a branch a test: that keeps least in registers.
        let bits = position.map(|part| part.to_bits());
        let [row_x, row_y, row_z, row_w] = &self.rows;
        let w = row_w.times(bits);
        if w < SMALLEST_W {
            return self.mark_outside(position, vertex);
        }
        let z = row_z.times(bits);
        // One unsigned comparison is both 0 ≤ z and z ≤ w/2.
        if z as u32 > w as u32 >> 1 {
            return self.mark_outside(position, vertex);
        }
        let doubled_guard = doubled_guard_band(w);
        let within = |value: i32| value.wrapping_add(doubled_guard >> 1) as u32 <= doubled_guard as u32;
        let x = row_x.times(bits);
        if !within(x) {
            return self.mark_outside(position, vertex);
        }
        let y = row_y.times(bits);
        if !within(y) {
            return self.mark_outside(position, vertex);
        }
        *vertex = Homogeneous { x, y, z, w }.project();
        true
    }

    /// Marks a vertex as outside. Starts from its position again, so that the fast path has
    /// nothing to keep for it.
    #[cold]
    #[inline(never)]
    fn mark_outside(&self, position: &Position, vertex: &mut ScreenVertex) -> bool {
        *vertex = ScreenVertex { outside: self.homogeneous(position).outcode(), ..ScreenVertex::default() };
        false
    }

    /// Returns a vertex on the screen, or marked as outside if it has to be clipped.
    pub fn screen(&self, position: &Position) -> ScreenVertex {
        let mut vertex = ScreenVertex::default();
        self.project_into(position, &mut vertex);
        vertex
    }
}

/// Fraction bits of a position.
const POSITION_BITS: u32 = 28;
/// Fraction bits of the viewport's factors, beside the matrix's 32.
const VIEWPORT_BITS: u32 = 11;

/// The rows x, y, z, w of [`Homogeneous`] space, exact, in Q43.
///
/// screen x = (x/w + 1)/2 · WIDTH · 16, so over 2¹⁴ it is (x + w) · WIDTH/2¹¹ / w.
fn viewport_rows(matrix: &Matrix) -> [[i128; 4]; 4] {
    const _: () = assert!(SUBPIXEL == 1 << (FULL_SCALE_BITS + 1 - VIEWPORT_BITS), "the viewport's factor is 2^-11");
    const _: () = assert!(DEPTH_FAR == 65_535, "project() multiplies by 65,535");
    let bits = |row: usize, column: usize| i128::from(I32F32::to_bits(matrix.rows[row][column]));
    [
        [0, 1, 2, 3].map(|column| (bits(3, column) + bits(0, column)) * i128::from(WIDTH)),
        [0, 1, 2, 3].map(|column| (bits(3, column) - bits(1, column)) * i128::from(HEIGHT)),
        [0, 1, 2, 3].map(|column| (bits(3, column) + bits(2, column)) << (VIEWPORT_BITS - 2)),
        [0, 1, 2, 3].map(|column| bits(3, column) << VIEWPORT_BITS),
    ]
}

/// A row divided by 2^`spare` (multiplied, if negative), rounded half up.
fn scaled_row(row: &[i128; 4], spare: i32) -> Row {
    let scale = |value: i128| match spare {
        1.. => (value + (1 << (spare - 1))) >> spare,
        _ => value << -spare,
    };
    Row {
        offset: (scale(row[3] << POSITION_BITS) + (1 << 31)) as i64,
        factors: [0, 1, 2].map(|axis| scale(row[axis]) as i32),
    }
}

/// Bits of a magnitude: 0 for 0, n for 2ⁿ⁻¹…2ⁿ − 1.
fn bits(magnitude: i128) -> i32 {
    128 - magnitude.leading_zeros() as i32
}
