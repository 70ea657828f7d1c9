//! A mesh to packets: transform, clip, cull, light, set up.

use core::fmt;

use crate::light::ObjectLight;
use crate::line::LineStyle;
use crate::look::{LitColour, VertexLook, light_vertices};
use crate::mesh::{Mesh, Position};
use crate::pass::Pass;
use crate::setup::ScreenVertex;
use crate::shade::{Flat, FlatUneven, Shade, Smooth, Unlit};
use crate::transform::{Homogeneous, ScreenTransform};

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

/// Where packets go.
pub trait Sink {
    /// Returns room for one more packet of `N` words, or `None` to end the drawing; a sink that
    /// does keeps the reason.
    ///
    /// Room that was asked for may go unused: the next one asked for takes its place.
    fn room<const N: usize>(&mut self) -> Option<&mut [u32; N]>;

    /// Takes the packet that was written into the last [`room`](Sink::room), of the same `N`.
    ///
    /// `drawn` is what it was made from, for whoever wants to look on.
    fn take<const N: usize>(&mut self, drawn: Drawn<'_>);
}

/// What a packet was made from.
#[derive(Debug, Clone, Copy)]
pub enum Drawn<'a> {
    /// A triangle of one colour.
    Flat {
        /// Its corners, counter-clockwise on screen.
        corners: [&'a ScreenVertex; 3],
        /// Red, green, blue, 0…255.
        colour: [u8; 3],
    },
    /// A triangle whose colour changes.
    Gouraud {
        /// Its corners, counter-clockwise on screen.
        corners: [&'a ScreenVertex; 3],
        /// The corners' colours: red, green, blue, 0…255.
        colours: [[u8; 3]; 3],
    },
    /// A line.
    Line {
        /// Its ends.
        ends: [&'a ScreenVertex; 2],
        /// How it looks.
        style: LineStyle,
    },
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

/// A mesh's vertices, lit.
#[derive(Debug, Clone, Copy)]
pub struct LitVertices<'a>(Smooth<'a>);

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
    light: &ObjectLight,
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

    /// Turns every face into no, one or (if it is clipped) several triangles of one colour in
    /// `sink`, until the sink breaks off.
    pub fn draw(&self, light: &ObjectLight, culling: Culling, sink: &mut impl Sink) -> DrawStatistics {
        match &light.uneven {
            None => self.draw_as(Flat { light }, culling, sink),
            Some(light) => self.draw_as(FlatUneven { light }, culling, sink),
        }
    }

    /// Lights every vertex, for [`draw_smooth`](Self::draw_smooth).
    ///
    /// `looks` has one for each of the mesh's vertices; `lit` is room for as many.
    ///
    /// # Errors
    /// [`CacheTooSmall`] when either is shorter than the mesh has vertices.
    pub fn light_vertices<'l>(
        &self,
        looks: &'l [VertexLook],
        light: &'l ObjectLight,
        lit: &'l mut [LitColour],
    ) -> Result<LitVertices<'l>, CacheTooSmall> {
        let needed = self.cache.len();
        let given = looks.len().min(lit.len());
        let (Some(looks), Some(lit)) = (looks.get(..needed), lit.get_mut(..needed)) else {
            return Err(CacheTooSmall { needed, given });
        };
        light_vertices(looks, light, lit);
        Ok(LitVertices(Smooth { light, looks, lit }))
    }

    /// As [`draw`](Self::draw), but by the mesh's own vertices' light, with colours that change over the face.
    pub fn draw_smooth(&self, lit: &LitVertices<'_>, culling: Culling, sink: &mut impl Sink) -> DrawStatistics {
        self.draw_as(lit.0, culling, sink)
    }

    /// As [`draw`](Self::draw), but unlit and in one mode: depth alone, or depth as grey.
    pub fn draw_unlit(&self, style: Unlit, culling: Culling, sink: &mut impl Sink) -> DrawStatistics {
        self.draw_as(style, culling, sink)
    }

    /// Draws lines between pairs of the mesh's vertices, cut where they leave what can be seen,
    /// until the sink breaks off; a pair that names a missing vertex is left out.
    ///
    /// [`edges`](crate::wire::edges) gives a mesh's.
    pub fn draw_lines(&self, edges: &[[u32; 2]], style: &LineStyle, sink: &mut impl Sink) -> DrawStatistics {
        crate::wire::draw(self, edges, style, sink)
    }

    /// Returns the mesh.
    pub(crate) fn mesh(&self) -> &'a Mesh<'a> {
        self.mesh
    }

    /// Returns the vertices on the screen.
    pub(crate) fn cache(&self) -> &'a [ScreenVertex] {
        self.cache
    }

    /// Returns a vertex on the screen.
    pub(crate) fn vertex(&self, index: u32) -> Option<&'a ScreenVertex> {
        self.cache.get(index as usize)
    }

    /// Returns a vertex that exists before projection, for clipping.
    pub(crate) fn homogeneous(&self, index: usize) -> Homogeneous {
        self.transform.homogeneous(&self.mesh.positions()[index])
    }

    fn draw_as(&self, shade: impl Shade, culling: Culling, sink: &mut impl Sink) -> DrawStatistics {
        let mut pass = Pass { transformed: self, shade, culling, sink, drawn: 0, clipped: 0 };
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
