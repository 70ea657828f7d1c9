//! Which pixels see a triangle in clip space, without clipping it.
//!
//! After Olano and Greer, "Triangle Scan Conversion using 2D Homogeneous Coordinates" (1997): with
//! M the matrix of the corners' (x, y, w), the parts of M⁻¹·(x, y, 1) at a point of the screen are
//! the corners' weights over w. They are linear on the screen, also for corners behind the eye, and
//! so is z/w. So what is seen is where five linear functions are at least 0.

use fpga_regs::screen::{HEIGHT, WIDTH};

use crate::float_matrix::{Vector, cross, dot};

/// A linear function of a point on the screen in pixels: `by_x`·x + `by_y`·y + `constant`.
#[derive(Debug, Clone, Copy)]
pub struct Linear {
    /// Growth per pixel to the right.
    pub by_x: f64,
    /// Growth per pixel down.
    pub by_y: f64,
    /// Value in the upper left corner.
    pub constant: f64,
}

impl Linear {
    /// Returns the function whose values are given at normalised device coordinates.
    fn of_ndc([x, y, constant]: Vector) -> Self {
        // ndc.x = 2·x/WIDTH − 1, ndc.y = 1 − 2·y/HEIGHT.
        Self { by_x: 2.0 * x / f64::from(WIDTH), by_y: -2.0 * y / f64::from(HEIGHT), constant: constant - x + y }
    }

    /// Returns the value at a point.
    pub fn at(&self, x: f64, y: f64) -> f64 {
        self.by_x * x + self.by_y * y + self.constant
    }

    /// Returns the growth per pixel in the direction of greatest growth.
    pub fn slope(&self) -> f64 {
        self.by_x.hypot(self.by_y)
    }

    /// Returns the distance of a point to the line where the value is 0, in pixels, above 0 where
    /// the value is. Infinite for a constant.
    pub fn distance(&self, x: f64, y: f64) -> f64 {
        self.at(x, y) / self.slope()
    }
}

/// The part of a triangle that is in front of the eye and between the near and far planes.
#[derive(Debug, Clone, Copy)]
pub struct VisiblePart {
    /// At least 0 inside: the three edges, the near plane, the far plane.
    pub sides: [Linear; 5],
    /// Depth, 0 (near) to 65,535 (far).
    pub depth: Linear,
}

/// How a pixel centre lies to the visible part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sight {
    /// Inside, at least so far from every side.
    Inside,
    /// Outside, at least so far from some side.
    Outside,
    /// Too near to a side, or beside a corner.
    Border,
}

impl VisiblePart {
    /// Returns the visible part of a triangle in clip space, or `None` for one that is seen from
    /// its edge (or is so nearly).
    pub fn of(corners: [[f64; 4]; 3]) -> Option<Self> {
        let columns = corners.map(|[x, y, _, w]| [x, y, w]);
        let [a, b, c] = columns;
        let determinant = dot(a, cross(b, c));
        let size = columns.iter().map(|column| dot(*column, *column).sqrt()).product::<f64>();
        if determinant.abs() <= 1e-9 * size {
            return None;
        }
        // Rows of the inverse, by Cramer's rule.
        let rows = [cross(b, c), cross(c, a), cross(a, b)].map(|row| row.map(|part| part / determinant));
        let z_over_w = [0, 1, 2].map(|column| (0..3).map(|row| rows[row][column] * corners[row][2]).sum::<f64>());
        let edges = rows.map(Linear::of_ndc);
        let z = Linear::of_ndc(z_over_w);
        let near = Linear { constant: z.constant + 1.0, ..z };
        let far = Linear { by_x: -z.by_x, by_y: -z.by_y, constant: 1.0 - z.constant };
        let half = 65_535.0 / 2.0;
        let depth = Linear { by_x: z.by_x * half, by_y: z.by_y * half, constant: (z.constant + 1.0) * half };
        Some(Self { sides: [edges[0], edges[1], edges[2], near, far], depth })
    }

    /// Returns how a point in pixels lies to the visible part, with a border of `margin` pixels.
    pub fn sight(&self, x: f64, y: f64, margin: f64) -> Sight {
        let nearest = self.sides.iter().map(|side| side.distance(x, y)).fold(f64::INFINITY, f64::min);
        if nearest >= margin {
            Sight::Inside
        } else if nearest <= -margin {
            Sight::Outside
        } else {
            Sight::Border
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_in_front_is_seen_where_its_corners_say() {
        // (0, 0), (320, 0), (0, 240) in pixels, at depths 0, 65,535 and half of it.
        let corners = [[-1.0, 1.0, -1.0, 1.0], [2.0, 2.0, 2.0, 2.0], [-3.0, -3.0, 0.0, 3.0]];
        let part = VisiblePart::of(corners).expect("it has an area");
        assert_eq!(part.sight(100.0, 80.0, 1.0), Sight::Inside);
        assert_eq!(part.sight(170.0, 130.0, 1.0), Sight::Outside);
        assert_eq!(part.sight(160.0, 119.9, 1.0), Sight::Border);
        assert!((part.depth.at(160.0, 0.0) - 32_767.5).abs() < 1e-6);
        assert!((part.depth.at(0.0, 120.0) - 16_383.75).abs() < 1e-6);
    }

    #[test]
    fn a_triangle_behind_the_eye_is_not_seen_and_one_through_it_on_one_side_only() {
        let behind = [[-1.0, 1.0, 0.0, -1.0], [1.0, 1.0, 0.0, -1.0], [0.0, -1.0, 0.0, -1.0]];
        let part = VisiblePart::of(behind).expect("it has an area");
        assert!((0..240).all(|y| part.sight(160.0, f64::from(y), 0.1) != Sight::Inside));
        // One corner straight ahead, two behind the eye: seen from it downwards without end.
        let through = [[0.0, 0.0, 0.0, 1.0], [-1.0, -1.0, 0.0, -1.0], [1.0, -1.0, 0.0, -1.0]];
        let part = VisiblePart::of(through).expect("it has an area");
        assert_eq!(part.sight(160.0, 180.0, 1.0), Sight::Inside);
        assert_eq!(part.sight(160.0, 60.0, 1.0), Sight::Outside);
    }
}
