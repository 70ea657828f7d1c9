//! The way of a mesh's faces to packets: which are seen, from which side, and what is left of them.

use core::ops::ControlFlow;

use crate::clip::{Corner, MAX_CORNERS, Polygon, clip};
use crate::mesh::{Face, Winding};
use crate::pipeline::{Culling, Sink, Transformed};
use crate::setup::{ScreenVertex, doubled_area};
use crate::shade::{Paint, Shade};

/// One mesh being drawn.
pub(crate) struct Pass<'a, H, S> {
    pub(crate) transformed: &'a Transformed<'a>,
    pub(crate) shade: H,
    pub(crate) culling: Culling,
    pub(crate) sink: &'a mut S,
    pub(crate) drawn: u32,
    pub(crate) clipped: u32,
}

impl<H: Shade, S: Sink> Pass<'_, H, S> {
    /// The loop that most faces do not get further than: it is kept small, and what a face that
    /// shows needs beyond it is a call away.
    #[inline(never)]
    pub(crate) fn faces<const ANY_OUTSIDE: bool, const BOTH_SIDES: bool>(&mut self) -> ControlFlow<()> {
        let (mesh, cache) = (self.transformed.mesh(), self.transformed.cache());
        // A clockwise mesh is a counter-clockwise one with two corners swapped.
        let (second, third) = match mesh.winding() {
            Winding::CounterClockwise => (1, 2),
            Winding::Clockwise => (2, 1),
        };
        for face in mesh.faces() {
            let [i, j, k] = [0, second, third].map(|corner: usize| face.corners[corner] as usize);
            // `Mesh::new` has checked the corners; told so, the compiler checks no more.
            if i >= cache.len() || j >= cache.len() || k >= cache.len() {
                continue;
            }
            let (a, b, c) = (&cache[i], &cache[j], &cache[k]);
            if ANY_OUTSIDE && a.outside | b.outside | c.outside != 0 {
                // Three corners beyond one plane: nothing of the face is inside.
                if a.outside & b.outside & c.outside == 0 {
                    self.clipped_face(face, [i, j, k])?;
                }
                continue;
            }
            let area = doubled_area([a, b, c]);
            if area < 0 {
                self.front_face(a, b, c, self.shade.paint(face, [i, j, k]))?;
            } else if BOTH_SIDES && area > 0 {
                self.back_face(a, b, c, face, [i, j, k])?;
            }
        }
        ControlFlow::Continue(())
    }

    /// Draws a triangle whose corners go counter-clockwise on screen.
    #[inline(never)]
    fn front_face(
        &mut self,
        a: &ScreenVertex,
        b: &ScreenVertex,
        c: &ScreenVertex,
        paint: H::Paint<'_>,
    ) -> ControlFlow<()> {
        self.shade.draw(self.sink, [a, b, c], paint, &mut self.drawn)
    }

    /// A face seen from behind that is to be drawn: turned round, its normals with it.
    #[cold]
    #[inline(never)]
    fn back_face(
        &mut self,
        a: &ScreenVertex,
        b: &ScreenVertex,
        c: &ScreenVertex,
        face: &Face,
        corners: [usize; 3],
    ) -> ControlFlow<()> {
        let [i, j, k] = corners;
        self.front_face(a, c, b, self.shade.paint_back(&turned(face), [i, k, j]))
    }

    /// Clips a face and draws what is left as a fan.
    #[cold]
    #[inline(never)]
    fn clipped_face(&mut self, face: &Face, corners: [usize; 3]) -> ControlFlow<()> {
        self.clipped += 1;
        let paint = self.shade.paint(face, corners);
        let turned = turned(face);
        let paint_back = self.shade.paint_back(&turned, corners);
        let front = self.clipped(corners, paint.corner_colours());
        let back = if <H::Paint<'_> as Paint>::BY_CORNER && self.culling == Culling::None {
            self.clipped(corners, paint_back.corner_colours())
        } else {
            front
        };
        let mut projected = [ScreenVertex::default(); MAX_CORNERS];
        for (vertex, corner) in projected.iter_mut().zip(front.corners()) {
            *vertex = corner.at.project();
        }
        for second in 1..front.corners().len().saturating_sub(1) {
            let [a, b, c] = [0, second, second + 1];
            let area = doubled_area([&projected[a], &projected[b], &projected[c]]);
            if area < 0 {
                let part = paint.with_corner_colours([a, b, c].map(|corner| front.corners()[corner].colour));
                self.front_face(&projected[a], &projected[b], &projected[c], part)?;
            } else if self.culling == Culling::None && area > 0 {
                let part = paint_back.with_corner_colours([a, c, b].map(|corner| back.corners()[corner].colour));
                self.front_face(&projected[a], &projected[c], &projected[b], part)?;
            }
        }
        ControlFlow::Continue(())
    }

    /// What is left of a triangle whose corners have these colours.
    fn clipped(&self, indices: [usize; 3], colours: [[u8; 3]; 3]) -> Polygon {
        clip(
            [0, 1, 2].map(|corner: usize| Corner {
                at: self.transformed.homogeneous(indices[corner]),
                colour: colours[corner],
            }),
        )
    }
}

/// A face with its normal turned round.
fn turned(face: &Face) -> Face {
    Face { normal: face.normal.map(i16::saturating_neg), ..*face }
}
