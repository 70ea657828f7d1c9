//! A mesh to packets: transform, clip, cull, light, set up.

use core::fmt;
use core::ops::ControlFlow;

use fpga_regs::packet::{FlatTriangle, Header, Kind};

use crate::clip::{MAX_CORNERS, clip};
use crate::light::FaceLight;
use crate::mesh::{Face, Mesh, Position, Winding};
use crate::setup::{ScreenVertex, doubled_area, last_words, set_up_shape};
use crate::transform::ScreenTransform;

/// Which faces are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Culling {
    /// Front faces only.
    #[default]
    BackFaces,
    /// All faces, from both sides.
    None,
}

/// Where set-up triangles go.
pub trait Sink {
    /// Returns room for one more packet, or `None` to end the drawing; a sink that does keeps
    /// the reason.
    ///
    /// Room that was asked for may go unused: the next one asked for takes its place.
    fn room(&mut self) -> Option<&mut [u32; FlatTriangle::WORDS]>;

    /// Takes the packet that was written into the last [`room`](Sink::room).
    ///
    /// `corners` and `colour` are what it was made from, for whoever wants to look on:
    /// counter-clockwise on screen, and 8 bits a channel.
    fn take(&mut self, corners: [&ScreenVertex; 3], colour: [u8; 3]);
}

/// What became of a mesh's faces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct DrawStatistics {
    /// Vertices transformed.
    pub vertices: u32,
    /// Faces of the mesh.
    pub submitted: u32,
    /// Faces that had to be clipped. A face wholly beyond one plane is left out, not clipped.
    pub clipped: u32,
    /// Triangles that went to the sink; a clipped face may make several.
    pub drawn: u32,
}

/// The caller's vertex cache is smaller than the mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CacheTooSmall {
    /// Vertices of the mesh.
    pub needed: usize,
    /// Vertices that the cache holds.
    pub given: usize,
}

impl fmt::Display for CacheTooSmall {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { needed, given } = self;
        write!(out, "the mesh has {needed} vertices, the vertex cache holds {given}: lend a larger one")
    }
}

impl core::error::Error for CacheTooSmall {}

/// Draws a mesh: [`Transformed::new`], then [`Transformed::draw`].
///
/// # Errors
/// [`CacheTooSmall`], before anything is drawn.
pub fn draw(
    mesh: &Mesh<'_>,
    transform: &ScreenTransform,
    light: &FaceLight,
    culling: Culling,
    cache: &mut [ScreenVertex],
    sink: &mut impl Sink,
) -> Result<DrawStatistics, CacheTooSmall> {
    Ok(Transformed::new(mesh, transform, cache)?.draw(light, culling, sink))
}

/// A mesh whose vertices are on the screen: each was transformed once, however many faces share it.
#[derive(Debug, Clone, Copy)]
pub struct Transformed<'a> {
    mesh: &'a Mesh<'a>,
    transform: &'a ScreenTransform,
    cache: &'a [ScreenVertex],
    any_outside: bool,
}

impl<'a> Transformed<'a> {
    /// Transforms every vertex of `mesh` into `cache`.
    ///
    /// # Errors
    /// [`CacheTooSmall`] when the cache holds fewer vertices than the mesh.
    pub fn new(
        mesh: &'a Mesh<'a>,
        transform: &'a ScreenTransform,
        cache: &'a mut [ScreenVertex],
    ) -> Result<Self, CacheTooSmall> {
        let (needed, given) = (mesh.positions().len(), cache.len());
        let cache = cache.get_mut(..needed).ok_or(CacheTooSmall { needed, given })?;
        let any_outside = transform_vertices(mesh.positions(), transform, cache);
        Ok(Self { mesh, transform, cache, any_outside })
    }

    /// Turns every face into no, one or (if it is clipped) several triangles in `sink`, until
    /// the sink breaks off.
    pub fn draw(&self, light: &FaceLight, culling: Culling, sink: &mut impl Sink) -> DrawStatistics {
        let mut pass = Pass { transformed: self, light, culling, sink, drawn: 0, clipped: 0 };
        // A mesh wholly inside needs no test for it at every face.
        let _ = match (self.any_outside, culling) {
            (false, Culling::BackFaces) => pass.faces::<false, false>(),
            (false, Culling::None) => pass.faces::<false, true>(),
            (true, Culling::BackFaces) => pass.faces::<true, false>(),
            (true, Culling::None) => pass.faces::<true, true>(),
        };
        DrawStatistics {
            vertices: self.cache.len() as u32,
            submitted: self.mesh.faces().len() as u32,
            clipped: pass.clipped,
            drawn: pass.drawn,
        }
    }
}

/// Transforms every vertex into the cache and returns whether any of them is outside.
#[inline(never)]
fn transform_vertices(positions: &[Position], transform: &ScreenTransform, cache: &mut [ScreenVertex]) -> bool {
    let mut any_outside = false;
    for (vertex, position) in cache.iter_mut().zip(positions) {
        if !transform.project_into(position, vertex) {
            any_outside = true;
        }
    }
    any_outside
}

/// One mesh being drawn.
struct Pass<'a, S> {
    transformed: &'a Transformed<'a>,
    light: &'a FaceLight,
    culling: Culling,
    sink: &'a mut S,
    drawn: u32,
    clipped: u32,
}

impl<S: Sink> Pass<'_, S> {
    /// The loop that most faces do not get further than: it is kept small, and what a face that
    /// shows needs beyond it is a call away.
    #[inline(never)]
    fn faces<const ANY_OUTSIDE: bool, const BOTH_SIDES: bool>(&mut self) -> ControlFlow<()> {
        let Transformed { mesh, cache, .. } = *self.transformed;
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
                    self.clipped_face(face, [0, second, third])?;
                }
                continue;
            }
            let area = doubled_area([a, b, c]);
            if area < 0 {
                self.front_face(a, b, c, face)?;
            } else if BOTH_SIDES && area > 0 {
                self.back_face(a, b, c, face)?;
            }
        }
        ControlFlow::Continue(())
    }

    /// Lights and sets up a triangle whose corners go counter-clockwise on screen.
    #[inline(never)]
    fn front_face(&mut self, a: &ScreenVertex, b: &ScreenVertex, c: &ScreenVertex, face: &Face) -> ControlFlow<()> {
        let Some(words) = self.sink.room() else { return ControlFlow::Break(()) };
        if set_up_shape([a, b, c], last_words(words)).is_some() {
            let intensity = self.light.intensity(face.normal);
            words[0] = Header::of(Kind::FlatTriangle).0 | u32::from(intensity.framebuffer_colour(face.colour).0);
            self.drawn += 1;
            self.sink.take([a, b, c], intensity.colour(face.colour));
        }
        ControlFlow::Continue(())
    }

    /// A face seen from behind that is to be drawn: turned round, its normal with it.
    #[cold]
    #[inline(never)]
    fn back_face(&mut self, a: &ScreenVertex, b: &ScreenVertex, c: &ScreenVertex, face: &Face) -> ControlFlow<()> {
        let turned = Face { normal: face.normal.map(i16::saturating_neg), ..*face };
        self.front_face(a, c, b, &turned)
    }

    /// Clips a face and draws what is left as a fan.
    #[cold]
    #[inline(never)]
    fn clipped_face(&mut self, face: &Face, order: [usize; 3]) -> ControlFlow<()> {
        self.clipped += 1;
        let positions = self.transformed.mesh.positions();
        let corner = |index: usize| self.transformed.transform.homogeneous(&positions[face.corners[index] as usize]);
        let polygon = clip(order.map(corner));
        let mut projected = [ScreenVertex::default(); MAX_CORNERS];
        for (vertex, corner) in projected.iter_mut().zip(polygon.corners()) {
            *vertex = corner.project();
        }
        let Some((first, rest)) = projected[..polygon.corners().len()].split_first() else {
            return ControlFlow::Continue(());
        };
        for pair in rest.windows(2) {
            let (second, third) = (&pair[0], &pair[1]);
            let area = doubled_area([first, second, third]);
            if area < 0 {
                self.front_face(first, second, third, face)?;
            } else if self.culling == Culling::None && area > 0 {
                self.back_face(first, second, third, face)?;
            }
        }
        ControlFlow::Continue(())
    }
}
