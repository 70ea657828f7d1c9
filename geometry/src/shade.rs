//! How a triangle that shows becomes a packet.

use core::ops::ControlFlow;

use fpga_regs::packet::{FlatTriangle, GouraudTriangle, Header, Kind, PixelMode, TriangleShape};
use fpga_regs::screen::{DEPTH_FAR, DEPTH_FRACTION_BITS, Rgb332};

use crate::light::{ObjectLight, UnevenLight};
use crate::look::{LitColour, VertexLook};
use crate::mesh::Face;
use crate::pipeline::{Drawn, Sink};
use crate::setup::{ScreenVertex, last_words, set_up_gouraud_words, set_up_shape};

/// What the colours of one triangle are worked out from.
pub(crate) trait Paint: Copy {
    /// Whether the corners' colours matter.
    const BY_CORNER: bool;

    /// Returns the corners' colours, which clipping mixes; all alike where they do not matter.
    fn corner_colours(self) -> [[u8; 3]; 3];

    /// Returns the paint of a part of the triangle, with other colours at its corners.
    fn with_corner_colours(self, colours: [[u8; 3]; 3]) -> Self;
}

/// One colour, whatever the corners.
impl Paint for &Face {
    const BY_CORNER: bool = false;

    fn corner_colours(self) -> [[u8; 3]; 3] {
        [[0; 3]; 3]
    }

    fn with_corner_colours(self, _: [[u8; 3]; 3]) -> Self {
        self
    }
}

/// The corners' colours.
impl Paint for [[u8; 3]; 3] {
    const BY_CORNER: bool = true;

    fn corner_colours(self) -> [[u8; 3]; 3] {
        self
    }

    fn with_corner_colours(self, colours: [[u8; 3]; 3]) -> Self {
        colours
    }
}

/// None.
impl Paint for () {
    const BY_CORNER: bool = false;

    fn corner_colours(self) -> [[u8; 3]; 3] {
        [[0; 3]; 3]
    }

    fn with_corner_colours(self, _: [[u8; 3]; 3]) -> Self {}
}

/// A way to paint triangles.
pub(crate) trait Shade: Copy {
    /// What it works out colours from.
    type Paint<'f>: Paint;

    /// Returns the paint of a face seen from its front. `corners` are its vertices, in order.
    fn paint<'f>(&self, face: &'f Face, corners: [usize; 3]) -> Self::Paint<'f>;

    /// Returns the paint of a face seen from behind. Its normal is turned round already.
    fn paint_back<'f>(&self, face: &'f Face, corners: [usize; 3]) -> Self::Paint<'f>;

    /// Draws a triangle whose corners go counter-clockwise on screen, and counts it if any of it is
    /// on the screen; breaks off when the sink does.
    fn draw<S: Sink>(
        &self,
        sink: &mut S,
        corners: [&ScreenVertex; 3],
        paint: Self::Paint<'_>,
        drawn: &mut u32,
    ) -> ControlFlow<()>;
}

/// One colour a face, lit.
#[derive(Clone, Copy)]
pub(crate) struct Flat<'a> {
    pub(crate) light: &'a ObjectLight,
}

impl Shade for Flat<'_> {
    type Paint<'f> = &'f Face;

    #[inline(always)]
    fn paint<'f>(&self, face: &'f Face, _: [usize; 3]) -> &'f Face {
        face
    }

    fn paint_back<'f>(&self, face: &'f Face, _: [usize; 3]) -> &'f Face {
        face
    }

    #[inline(always)]
    fn draw<S: Sink>(
        &self,
        sink: &mut S,
        corners: [&ScreenVertex; 3],
        face: &Face,
        drawn: &mut u32,
    ) -> ControlFlow<()> {
        let Some(words) = sink.room::<{ FlatTriangle::WORDS }>() else { return ControlFlow::Break(()) };
        if set_up_shape(corners, last_words(words)).is_none() {
            return ControlFlow::Continue(());
        }
        let intensity = self.light.intensity(face.normal);
        words[0] = flat_header(intensity.framebuffer_colour(face.colour));
        *drawn += 1;
        sink.take::<{ FlatTriangle::WORDS }>(Drawn::Flat { corners, colour: intensity.colour(face.colour) });
        ControlFlow::Continue(())
    }
}

/// As [`Flat`], by a light that takes longer: its own type, so that the other has no test for it.
#[derive(Clone, Copy)]
pub(crate) struct FlatUneven<'a> {
    pub(crate) light: &'a UnevenLight,
}

impl Shade for FlatUneven<'_> {
    type Paint<'f> = &'f Face;

    fn paint<'f>(&self, face: &'f Face, _: [usize; 3]) -> &'f Face {
        face
    }

    fn paint_back<'f>(&self, face: &'f Face, _: [usize; 3]) -> &'f Face {
        face
    }

    fn draw<S: Sink>(
        &self,
        sink: &mut S,
        corners: [&ScreenVertex; 3],
        face: &Face,
        drawn: &mut u32,
    ) -> ControlFlow<()> {
        let Some(words) = sink.room::<{ FlatTriangle::WORDS }>() else { return ControlFlow::Break(()) };
        if set_up_shape(corners, last_words(words)).is_none() {
            return ControlFlow::Continue(());
        }
        let colour = self.light.lit(face.normal, face.colour);
        let [red, green, blue] = colour;
        words[0] = flat_header(Rgb332::nearest(red, green, blue));
        *drawn += 1;
        sink.take::<{ FlatTriangle::WORDS }>(Drawn::Flat { corners, colour });
        ControlFlow::Continue(())
    }
}

#[inline(always)]
fn flat_header(colour: Rgb332) -> u32 {
    Header::of(Kind::FlatTriangle).0 | u32::from(colour.0)
}

/// A colour a corner, lit there.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Smooth<'a> {
    pub(crate) light: &'a ObjectLight,
    pub(crate) looks: &'a [VertexLook],
    pub(crate) lit: &'a [LitColour],
}

impl Shade for Smooth<'_> {
    type Paint<'f> = [[u8; 3]; 3];

    #[inline(always)]
    fn paint(&self, _: &Face, corners: [usize; 3]) -> [[u8; 3]; 3] {
        corners.map(|corner| self.lit.get(corner).copied().unwrap_or_default().to_rgb888())
    }

    fn paint_back(&self, _: &Face, corners: [usize; 3]) -> [[u8; 3]; 3] {
        corners.map(|corner| {
            let look = self.looks.get(corner).copied().unwrap_or_default();
            self.light.lit(look.normal().map(i16::saturating_neg), look.colour())
        })
    }

    #[inline(always)]
    fn draw<S: Sink>(
        &self,
        sink: &mut S,
        corners: [&ScreenVertex; 3],
        colours: [[u8; 3]; 3],
        drawn: &mut u32,
    ) -> ControlFlow<()> {
        let Some(words) = sink.room::<{ GouraudTriangle::WORDS }>() else { return ControlFlow::Break(()) };
        if !set_up_gouraud_words(corners, colours, words) {
            return ControlFlow::Continue(());
        }
        words[0] = Header::of(Kind::GouraudTriangle).0;
        *drawn += 1;
        sink.take::<{ GouraudTriangle::WORDS }>(Drawn::Gouraud { corners, colours });
        ControlFlow::Continue(())
    }
}

/// Triangles without light.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Unlit {
    /// What their pixels do.
    pub mode: PixelMode,
    /// Whether depth is moved away from the eye, by a pixel's slope and two units, so that lines
    /// on the faces are nearer than these.
    pub pushed_back: bool,
}

impl Unlit {
    /// Depth alone, behind the lines that are drawn on it: for hidden lines.
    pub const HIDING: Self = Self { mode: PixelMode { keep_colour: true, ..PixelMode::USUAL }, pushed_back: true };
    /// Depth as grey, the farther the darker.
    pub const DEPTH_GREY: Self = Self { mode: PixelMode { depth_grey: true, ..PixelMode::USUAL }, pushed_back: false };

    /// Units of depth that a face is pushed back by, beside its slope.
    const UNITS: u32 = 2 << DEPTH_FRACTION_BITS;
    /// Most that a slope counts.
    const WHOLE_RANGE: u32 = (DEPTH_FAR as u32) << DEPTH_FRACTION_BITS;
}

impl Shade for Unlit {
    type Paint<'f> = ();

    fn paint(&self, _: &Face, _: [usize; 3]) {}

    fn paint_back(&self, _: &Face, _: [usize; 3]) {}

    fn draw<S: Sink>(&self, sink: &mut S, corners: [&ScreenVertex; 3], (): (), drawn: &mut u32) -> ControlFlow<()> {
        let Some(words) = sink.room::<{ FlatTriangle::WORDS }>() else { return ControlFlow::Break(()) };
        let shape: &mut [u32; TriangleShape::WORDS] = last_words(words);
        if set_up_shape(corners, shape).is_none() {
            return ControlFlow::Continue(());
        }
        if self.pushed_back {
            // Depth is the eighth word of a shape, its steps the two behind.
            let [.., depth, step_x, step_y] = shape;
            let slope = (*step_x as i32).unsigned_abs().saturating_add((*step_y as i32).unsigned_abs());
            // The whole range of depth is behind everything; more would wrap round to the front.
            let slope = slope.min(Self::WHOLE_RANGE);
            *depth = depth.wrapping_add(slope).wrapping_add(Self::UNITS);
        }
        words[0] = Header::of(Kind::FlatTriangle).with_mode(self.mode).0;
        *drawn += 1;
        sink.take::<{ FlatTriangle::WORDS }>(Drawn::Flat { corners, colour: [0; 3] });
        ControlFlow::Continue(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Keeps one packet.
    struct One([u32; FlatTriangle::WORDS]);

    impl Sink for One {
        fn room<const N: usize>(&mut self) -> Option<&mut [u32; N]> {
            self.0.first_chunk_mut()
        }

        fn take<const N: usize>(&mut self, _: Drawn<'_>) {}
    }

    #[test]
    fn what_hides_lines_lies_behind_itself_however_steep() {
        const DEPTH: usize = FlatTriangle::WORDS - 3;
        for (start, rise) in (0..60).flat_map(|start| (0..60).map(move |rise| (1_000 * start, 1_000 * rise))) {
            if start + rise > i32::from(DEPTH_FAR) {
                continue;
            }
            // A sixteenth of a pixel wide, its left edge through pixels' centres.
            let vertex = |x, y, depth| ScreenVertex { x, y, depth, ..ScreenVertex::default() };
            let corners = [vertex(8, 0, start), vertex(8, 160, start), vertex(9, 160, start + rise)];
            let depth = |unlit: Unlit| {
                let (mut sink, mut drawn) = (One([0; FlatTriangle::WORDS]), 0);
                let _ = unlit.draw(&mut sink, corners.each_ref(), (), &mut drawn);
                assert_eq!(drawn, 1);
                sink.0[DEPTH] as i32
            };
            let (plain, pushed) = (depth(Unlit { pushed_back: false, ..Unlit::HIDING }), depth(Unlit::HIDING));
            assert!(pushed > plain, "{start} and {rise} more: {pushed} is before {plain}");
        }
    }
}
