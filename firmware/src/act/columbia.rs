//! The matrices of "3D Rendering in FPGA" (Columbia CSEE 4840, 2014), which tilted this plate first.
//!
//! Each element is what that system's C program computes, rounded to 2⁻³²: sine and cosine are within 2⁻²⁹ of
//! the true ones, every product of matrices is summed exactly and rounded once. The program goes on to
//! screen coordinates of five fraction bits; here they have four, and so have the corners.

use controls::Tilt;
use fixed::types::{I16F16, I32F32};
use geometry::{Angle, Matrix};

use crate::scene::stage::Camera;

const ONE: I32F32 = I32F32::ONE;
const ZERO: I32F32 = I32F32::ZERO;

/// Its projection, as printed in its report: 45°, near 1, far 10. The third row is not OpenGL's, in which it
/// would be −1.2222 and −2.2222: depth reaches 1 at a distance of 3, and the plate is at 5.
pub const PROJECTION: Matrix = Matrix {
    rows: [
        [I32F32::lit("2.4178"), ZERO, ZERO, ZERO],
        [ZERO, I32F32::lit("2.4178"), ZERO, ZERO],
        [ZERO, ZERO, I32F32::lit("-2"), I32F32::lit("-3")],
        [ZERO, ZERO, I32F32::lit("-1"), ZERO],
    ],
};

/// What its viewport does otherwise than this renderer's, as a matrix on clip space. Row 0 of its screen is at
/// y = −1. Its depth is 9/2 · z/w + 11/2 (near 1, far 10) in eleven bits from 0 to 16, which become the whole
/// range of depth here: z/w of this renderer is 9/16 · z/w − 5/16.
pub const VIEWPORT: Matrix = Matrix {
    rows: [
        [ONE, ZERO, ZERO, ZERO],
        [ZERO, I32F32::lit("-1"), ZERO, ZERO],
        [ZERO, ZERO, I32F32::lit("0.5625"), I32F32::lit("-0.3125")],
        [ZERO, ZERO, ZERO, ONE],
    ],
};

/// Returns its rotation about the x axis: rows (1, 0, 0), (0, c, s), (0, −s, c).
pub fn rotation_x(degrees: I16F16) -> Matrix {
    Matrix::rotation_x(Angle::from_degrees(degrees).negated())
}

/// Returns its rotation about the y axis: rows (c, 0, −s), (0, 1, 0), (s, 0, c).
pub fn rotation_y(degrees: I16F16) -> Matrix {
    Matrix::rotation_y(Angle::from_degrees(degrees).negated())
}

/// Returns its rotation about the z axis: rows (c, s, 0), (−s, c, 0), (0, 0, 1).
pub fn rotation_z(degrees: I16F16) -> Matrix {
    Matrix::rotation_z(Angle::from_degrees(degrees).negated())
}

/// Returns its world matrix, T·Rz·Ry·Rx·S, for angles about the three axes in degrees.
pub fn world(translation: [I32F32; 3], [x, y, z]: [I16F16; 3], scale: [I32F32; 3]) -> Matrix {
    Matrix::translation(translation)
        .times(&rotation_z(z))
        .times(&rotation_y(y))
        .times(&rotation_x(x))
        .times(&Matrix::scaling(scale))
}

/// Returns the world matrix of a pad's tilt: the tilt about the pad's y axis turns about x and the one about its
/// x axis about y, both backwards, and half a turn about z makes up for the screen's rows.
pub fn tilted(tilt: Tilt) -> Matrix {
    world([ZERO; 3], [-tilt.pitch, -tilt.roll, const { I16F16::lit("180") }], [ONE; 3])
}

/// Returns its camera, five units in front of the origin.
pub fn camera() -> Camera {
    let view = Matrix::translation([ZERO, ZERO, I32F32::from_num(-5)]);
    Camera { view, projection: VIEWPORT.times(&PROJECTION) }
}
