//! A part of a mesh that has one material.

use ::gltf::accessor::{DataType, Dimensions};
use ::gltf::mesh::Mode;
use ::gltf::{Primitive, Semantic};

use super::GltfProblem;
use super::accessor::Elements;
use super::node::Placed;
use crate::model::colour;
use crate::{Model, NO_NORMAL, Problem};

/// Adds a primitive to the model.
pub(super) fn add(primitive: &Primitive<'_>, placed: &Placed, blob: &[u8], model: &mut Model) -> Result<(), Problem> {
    let Some(accessor) = primitive.get(&Semantic::Positions) else { return Ok(()) };
    if primitive.mode() == Mode::Points {
        return Ok(());
    }
    let floats = (&[Dimensions::Vec3][..], &[DataType::F32][..]);
    let positions = Elements::<3>::new(&accessor, blob, floats, "three 32-bit floats")?;
    let normals = primitive
        .get(&Semantic::Normals)
        .map(|accessor| Elements::<3>::new(&accessor, blob, floats, "three 32-bit floats"))
        .transpose()?;
    let colour_kinds = (&[Dimensions::Vec3, Dimensions::Vec4][..], &[DataType::F32, DataType::U8, DataType::U16][..]);
    let colours = primitive
        .get(&Semantic::Colors(0))
        .map(|accessor| {
            Elements::<3>::new(&accessor, blob, colour_kinds, "three or four floats, bytes or 16-bit numbers")
        })
        .transpose()?;
    let vertices = positions.len();
    for (attribute, count) in
        [("NORMAL", normals.as_ref().map(Elements::len)), ("COLOR_0", colours.as_ref().map(Elements::len))]
    {
        if let Some(found) = count.filter(|count| *count != vertices) {
            return Err(GltfProblem::Count { attribute, found, positions: vertices }.into());
        }
    }
    let indices = Indices::new(primitive, blob, vertices)?;
    let first = model.positions.len();
    for index in 0..vertices {
        model.push_vertex(placed.position(positions.get(index))?)?;
    }
    let first_normal = normals.as_ref().map(|normals| {
        let first = model.normals.len() as u32;
        model.normals.extend((0..vertices).map(|index| placed.normal(normals.get(index))));
        first
    });
    let [red, green, blue, _] = primitive.material().pbr_metallic_roughness().base_color_factor();
    let base = [red, green, blue].map(f64::from);
    if colours.is_some() || model.colours.is_some() {
        let before = model.colours_so_far(first);
        before.extend((0..vertices).map(|index| {
            let own = colours.as_ref().map_or([1.0; 3], |colours| colours.get(index));
            framebuffer_colour([0, 1, 2].map(|channel| own[channel] * base[channel]))
        }));
    }
    let mut builder = Builder { model, first: first as u32, first_normal, base: framebuffer_colour(base), placed };
    builder.add(primitive.mode(), &indices)
}

/// glTF's colours are linear, a framebuffer's are sRGB.
fn framebuffer_colour(linear: [f64; 3]) -> [f32; 3] {
    colour(linear.map(|part| if part <= 0.003_130_8 { 12.92 * part } else { 1.055 * part.powf(1.0 / 2.4) - 0.055 }))
}

/// The order in which a primitive goes through its vertices.
enum Indices<'a> {
    Given(Elements<'a, 1>),
    InOrder(usize),
}

impl<'a> Indices<'a> {
    fn new(primitive: &Primitive<'_>, blob: &'a [u8], vertices: usize) -> Result<Self, Problem> {
        let Some(accessor) = primitive.indices() else { return Ok(Self::InOrder(vertices)) };
        let kinds = (&[Dimensions::Scalar][..], &[DataType::U8, DataType::U16, DataType::U32][..]);
        let indices = Self::Given(Elements::new(&accessor, blob, kinds, "whole numbers without sign")?);
        match (0..indices.len()).find(|at| indices.get(*at) as usize >= vertices) {
            Some(at) => Err(GltfProblem::Index { at, index: indices.get(at), vertices }.into()),
            None => Ok(indices),
        }
    }

    fn len(&self) -> usize {
        match self {
            Self::Given(elements) => elements.len(),
            Self::InOrder(vertices) => *vertices,
        }
    }

    fn get(&self, at: usize) -> u32 {
        match self {
            Self::Given(elements) => elements.get(at)[0] as u32,
            Self::InOrder(_) => at as u32,
        }
    }
}

struct Builder<'a> {
    model: &'a mut Model,
    first: u32,
    first_normal: Option<u32>,
    base: [f32; 3],
    placed: &'a Placed,
}

impl Builder<'_> {
    fn add(&mut self, mode: Mode, indices: &Indices<'_>) -> Result<(), Problem> {
        let count = indices.len();
        let at = |index: usize| indices.get(index);
        match mode {
            Mode::Points => Ok(()),
            Mode::Lines => (0..count / 2).try_for_each(|line| self.line([2 * line, 2 * line + 1].map(at))),
            Mode::LineStrip => (1..count).try_for_each(|end| self.line([end - 1, end].map(at))),
            Mode::LineLoop => (0..count).try_for_each(|end| self.line([end, (end + 1) % count].map(at))),
            Mode::Triangles => (0..count / 3).try_for_each(|face| self.face([0, 1, 2].map(|part| at(3 * face + part)))),
            // Every other triangle of a strip goes the other way round.
            Mode::TriangleStrip => (2..count).try_for_each(|end| {
                let [a, b] = if end % 2 == 0 { [end - 2, end - 1] } else { [end - 1, end - 2] };
                self.face([a, b, end].map(at))
            }),
            Mode::TriangleFan => (2..count).try_for_each(|end| self.face([0, end - 1, end].map(at))),
        }
    }

    fn line(&mut self, ends: [u32; 2]) -> Result<(), Problem> {
        self.model.push_line(ends.map(|end| self.first + end))
    }

    fn face(&mut self, [a, b, c]: [u32; 3]) -> Result<(), Problem> {
        let corners = if self.placed.mirrors() { [a, c, b] } else { [a, b, c] };
        let model = &mut *self.model;
        if self.first_normal.is_some() || !model.corner_normals.is_empty() {
            model.corner_normals.resize(model.corners.len(), NO_NORMAL);
            model
                .corner_normals
                .extend(corners.map(|corner| self.first_normal.map_or(NO_NORMAL, |first| first + corner)));
        }
        model.face_colours.get_or_insert_default().push(self.base);
        model.push_triangle(corners.map(|corner| self.first + corner))
    }
}
