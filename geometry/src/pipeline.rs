//! A mesh to packets: transform, clip, cull, light, set up.

use core::fmt;

use fpga_regs::packet::FlatTriangle;
use fpga_regs::screen::Rgb332;

use crate::clip::{MAX_CORNERS, clip};
use crate::light::FaceLight;
use crate::mesh::{Face, Mesh, Winding};
use crate::setup::{ScreenVertex, doubled_area, set_up};
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
    /// What can go wrong with them.
    type Error;

    /// Takes a triangle, in the order in which the mesh has them.
    ///
    /// `corners` and `colour` are what `triangle` was made from, for whoever wants to look on:
    /// counter-clockwise on screen, and 8 bits a channel.
    ///
    /// # Errors
    /// Whatever stops the drawing; [`draw`] hands it on at once.
    fn triangle(
        &mut self,
        triangle: &FlatTriangle,
        corners: [&ScreenVertex; 3],
        colour: [u8; 3],
    ) -> Result<(), Self::Error>;
}

/// What became of a mesh's faces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct DrawStatistics {
    /// Vertices transformed.
    pub vertices: u32,
    /// Faces of the mesh.
    pub submitted: u32,
    /// Faces that had to be clipped, those that clipping left nothing of among them.
    pub clipped: u32,
    /// Triangles that went to the sink; a clipped face may make several.
    pub drawn: u32,
}

/// Why a mesh was not drawn to its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum DrawError<E> {
    /// The caller's vertex cache is smaller than the mesh.
    CacheTooSmall {
        /// Vertices of the mesh.
        needed: usize,
        /// Vertices that the cache holds.
        given: usize,
    },
    /// The sink refused a triangle.
    Sink(E),
}

impl<E: fmt::Display> fmt::Display for DrawError<E> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::CacheTooSmall { needed, given } => {
                write!(out, "the mesh has {needed} vertices, the vertex cache holds {given}: lend a larger one")
            }
            Self::Sink(error) => error.fmt(out),
        }
    }
}

impl<E: fmt::Debug + fmt::Display> core::error::Error for DrawError<E> {}

/// Draws a mesh: [`Transformed::new`], then [`Transformed::draw`].
///
/// # Errors
/// [`DrawError::CacheTooSmall`] before anything is drawn; [`DrawError::Sink`] when the sink
/// refuses a triangle, which ends the drawing there.
pub fn draw<S: Sink>(
    mesh: &Mesh<'_>,
    transform: &ScreenTransform,
    light: &FaceLight,
    culling: Culling,
    cache: &mut [ScreenVertex],
    sink: &mut S,
) -> Result<DrawStatistics, DrawError<S::Error>> {
    Transformed::new(mesh, transform, cache)?.draw(light, culling, sink)
}

/// A mesh whose vertices are on the screen: each was transformed once, however many faces share it.
#[derive(Debug, Clone, Copy)]
pub struct Transformed<'a> {
    mesh: &'a Mesh<'a>,
    transform: &'a ScreenTransform,
    cache: &'a [ScreenVertex],
}

impl<'a> Transformed<'a> {
    /// Transforms every vertex of `mesh` into `cache`.
    ///
    /// # Errors
    /// [`DrawError::CacheTooSmall`] when the cache holds fewer vertices than the mesh.
    pub fn new<E>(
        mesh: &'a Mesh<'a>,
        transform: &'a ScreenTransform,
        cache: &'a mut [ScreenVertex],
    ) -> Result<Self, DrawError<E>> {
        let (needed, given) = (mesh.positions().len(), cache.len());
        let cache = cache.get_mut(..needed).ok_or(DrawError::CacheTooSmall { needed, given })?;
        transform_vertices(mesh, transform, cache);
        Ok(Self { mesh, transform, cache })
    }

    /// Turns every face into no, one or (if it is clipped) several triangles in `sink`.
    ///
    /// # Errors
    /// [`DrawError::Sink`] when the sink refuses a triangle, which ends the drawing there.
    pub fn draw<S: Sink>(
        &self,
        light: &FaceLight,
        culling: Culling,
        sink: &mut S,
    ) -> Result<DrawStatistics, DrawError<S::Error>> {
        let pass = Pass { mesh: self.mesh, transform: self.transform, light, culling, cache: self.cache };
        let mut statistics = DrawStatistics {
            vertices: self.cache.len() as u32,
            submitted: self.mesh.faces().len() as u32,
            ..DrawStatistics::default()
        };
        match pass.faces(sink, &mut statistics) {
            Ok(()) => Ok(statistics),
            Err(error) => Err(DrawError::Sink(error)),
        }
    }
}

/// Transforms every vertex of a mesh into the cache, which is as long as the mesh has vertices.
#[inline(never)]
fn transform_vertices(mesh: &Mesh<'_>, transform: &ScreenTransform, cache: &mut [ScreenVertex]) {
    for (vertex, position) in cache.iter_mut().zip(mesh.positions()) {
        *vertex = transform.screen(position);
    }
}

/// One mesh being drawn, its vertices in the cache.
struct Pass<'a> {
    mesh: &'a Mesh<'a>,
    transform: &'a ScreenTransform,
    light: &'a FaceLight,
    culling: Culling,
    cache: &'a [ScreenVertex],
}

impl Pass<'_> {
    #[inline(never)]
    fn faces<S: Sink>(&self, sink: &mut S, statistics: &mut DrawStatistics) -> Result<(), S::Error> {
        // A clockwise mesh is a counter-clockwise one with two corners swapped.
        let (second, third) = match self.mesh.winding() {
            Winding::CounterClockwise => (1, 2),
            Winding::Clockwise => (2, 1),
        };
        let mut drawn = 0;
        for face in self.mesh.faces() {
            let corner = |index: usize| self.cache.get(face.corners[index] as usize);
            // `Mesh::new` has checked the corners, so there is always a vertex.
            let (Some(a), Some(b), Some(c)) = (corner(0), corner(second), corner(third)) else { continue };
            if a.outside | b.outside | c.outside != 0 {
                drawn += self.clipped_face(face, [0, second, third], sink)?;
                statistics.clipped += 1;
                continue;
            }
            drawn += u32::from(self.screen_triangle([a, b, c], face, sink)?);
        }
        statistics.drawn += drawn;
        Ok(())
    }

    /// Culls, lights and sets up one triangle; returns whether it went to the sink.
    #[inline(always)]
    fn screen_triangle<S: Sink>(
        &self,
        corners: [&ScreenVertex; 3],
        face: &Face,
        sink: &mut S,
    ) -> Result<bool, S::Error> {
        let area = doubled_area(corners);
        if area >= 0 {
            if self.culling == Culling::BackFaces || area == 0 {
                return Ok(false);
            }
            return self.back_face(corners, area, face, sink);
        }
        self.front_face(corners, area, face, sink)
    }

    #[inline(always)]
    fn front_face<S: Sink>(
        &self,
        corners: [&ScreenVertex; 3],
        area: i32,
        face: &Face,
        sink: &mut S,
    ) -> Result<bool, S::Error> {
        let mut colour = [0; 3];
        let shade = || {
            colour = self.light.shade(face.normal, face.colour);
            let [red, green, blue] = colour;
            Rgb332::nearest(red, green, blue)
        };
        let Some(triangle) = set_up(corners, area, shade) else { return Ok(false) };
        sink.triangle(&triangle, corners, colour)?;
        Ok(true)
    }

    /// A face seen from behind that is to be drawn: turned round, its normal with it.
    #[cold]
    #[inline(never)]
    fn back_face<S: Sink>(
        &self,
        [a, b, c]: [&ScreenVertex; 3],
        area: i32,
        face: &Face,
        sink: &mut S,
    ) -> Result<bool, S::Error> {
        let turned = Face { normal: face.normal.map(|part| part.saturating_neg()), ..*face };
        self.front_face([a, c, b], -area, &turned, sink)
    }

    /// Clips a face and draws what is left as a fan; returns how many triangles that made.
    #[cold]
    #[inline(never)]
    fn clipped_face<S: Sink>(&self, face: &Face, order: [usize; 3], sink: &mut S) -> Result<u32, S::Error> {
        let positions = self.mesh.positions();
        let corner = |index: usize| self.transform.homogeneous(&positions[face.corners[index] as usize]);
        let polygon = clip(order.map(corner));
        let mut projected = [ScreenVertex::OUTSIDE; MAX_CORNERS];
        for (vertex, corner) in projected.iter_mut().zip(polygon.corners()) {
            *vertex = corner.project();
        }
        let mut drawn = 0;
        let projected = &projected[..polygon.corners().len()];
        if let Some((first, rest)) = projected.split_first() {
            for pair in rest.windows(2) {
                drawn += u32::from(self.screen_triangle([first, &pair[0], &pair[1]], face, sink)?);
            }
        }
        Ok(drawn)
    }
}
