//! Reads Babylon JSON models.
//!
//! A scene has meshes, each with `indices` and either `vertices`, 6, 8 or 10 numbers a vertex as its
//! `uvCount` is 0, 1 or 2 (position, normal, texture coordinates: Blender's exporter of 2013), or
//! `positions`, `normals` and `colors` (today's). Its material's `diffuse` colour counts where it has no colours. A mesh's `scaling`, `rotation` or
//! `rotationQuaternion`, and `position` put it into the scene; the place of a parent does not count, which
//! is noted. Everything else is passed over.
//!
//! Babylon's space is left-handed: z is turned over here, and its clockwise faces are counter-clockwise then.

use std::fmt;
use std::marker::PhantomData;
use std::path::Path;

use serde::de::{Error as _, IgnoredAny, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};

use crate::error::quoted;
use crate::model::{colour, direction};
use crate::number::finite;
use crate::{Model, NO_NORMAL, PLAIN, Problem, ReadError};

/// What only a Babylon file can have wrong.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum BabylonProblem {
    /// No JSON, or not with these parts.
    Json {
        /// The reason, with the column.
        reason: String,
    },
    /// A `uvCount` that no layout has.
    UvCount {
        /// The number.
        found: u64,
    },
    /// A list that is not so many wholes.
    Length {
        /// The list's name.
        list: &'static str,
        /// Its length.
        found: usize,
        /// Numbers of a whole.
        each: usize,
    },
    /// A list with another number of vertices than the positions.
    Count {
        /// The list's name.
        list: &'static str,
        /// Vertices it is for.
        found: usize,
        /// Vertices that there are.
        vertices: usize,
    },
    /// An index that names no vertex.
    Index {
        /// Where it stands in `indices`, from 0.
        at: usize,
        /// The index.
        index: u32,
        /// Vertices of the mesh.
        vertices: usize,
    },
}

impl fmt::Display for BabylonProblem {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Json { reason } => write!(out, "{reason}: export the scene as .babylon again"),
            Self::UvCount { found } => {
                write!(
                    out,
                    "`uvCount` is {found}, layouts are known for 0, 1 and 2: export with 2 texture maps or fewer"
                )
            }
            Self::Length { list, found, each } => {
                write!(out, "`{list}` has {found} numbers, no multiple of {each}: export the scene again")
            }
            Self::Count { list, found, vertices } => {
                write!(out, "`{list}` is for {found} vertices, there are {vertices}: export the scene again")
            }
            Self::Index { at, index, vertices } => {
                write!(out, "`indices`[{at}] is {index}, past the last of {vertices} vertices: export the scene again")
            }
        }
    }
}

/// Most meshes, and most materials, of a scene: an empty one takes hundreds of times what it has in the file.
pub const ITEMS_MAX: usize = 1 << 16;

#[derive(Deserialize)]
struct Scene {
    meshes: Items<Mesh>,
    #[serde(default)]
    materials: Items<Material>,
}

/// No more than [`ITEMS_MAX`] of a list.
struct Items<T>(Vec<T>);

impl<T> Default for Items<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Items<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_seq(ItemsVisitor(PhantomData))
    }
}

struct ItemsVisitor<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for ItemsVisitor<T> {
    type Value = Items<T>;

    fn expecting(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str("a list")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Items<T>, A::Error> {
        let mut items = Vec::new();
        while let Some(item) = list.next_element()? {
            if items.len() >= ITEMS_MAX {
                return Err(A::Error::custom(format!("more than {ITEMS_MAX} meshes or materials, join some")));
            }
            items.push(item);
        }
        Ok(Items(items))
    }
}

#[derive(Deserialize)]
struct Material {
    #[serde(default)]
    id: String,
    diffuse: Option<[f64; 3]>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Mesh {
    #[serde(default)]
    name: Option<String>,
    uv_count: Option<u64>,
    vertices: Option<Vec<f64>>,
    positions: Option<Vec<f64>>,
    normals: Option<Vec<f64>>,
    colors: Option<Vec<f64>>,
    material_id: Option<String>,
    indices: Option<Vec<u32>>,
    scaling: Option<[f64; 3]>,
    rotation: Option<[f64; 3]>,
    rotation_quaternion: Option<[f64; 4]>,
    position: Option<[f64; 3]>,
    /// `None` for null as well.
    parent_id: Option<IgnoredAny>,
}

/// Reads a model from a file's bytes; `file` is its name in errors.
///
/// # Errors
///
/// The first thing that is wrong, with its line or its mesh.
pub fn parse(bytes: &[u8], file: &Path) -> Result<Model, ReadError> {
    let scene: Scene = serde_json::from_slice(bytes).map_err(|error| {
        let text = error.to_string();
        // The line is told beside it.
        let reason = text.replace(&format!(" at line {} column {}", error.line(), error.column()), "");
        let reason = format!("{} (column {})", quoted_reason(&reason), error.column());
        ReadError::line(file, error.line() as u64, BabylonProblem::Json { reason })
    })?;
    let mut model = Model::empty();
    for (number, mesh) in scene.meshes.0.iter().enumerate() {
        let name = || format!("mesh {number} `{}`", quoted(mesh.name.as_deref().unwrap_or_default()));
        let material = scene.materials.0.iter().find(|material| Some(&material.id) == mesh.material_id.as_ref());
        let diffuse = material.and_then(|material| material.diffuse);
        add(mesh, diffuse.map_or(PLAIN, colour), &mut model)
            .map_err(|problem| ReadError::part(file, name(), problem))?;
    }
    if scene.meshes.0.iter().any(|mesh| mesh.parent_id.is_some()) {
        model.notes.push("meshes have parents, whose place does not count: apply it before exporting".into());
    }
    model.finish().map_err(|problem| ReadError::file(file, problem))
}

/// A reason may quote the file.
fn quoted_reason(reason: &str) -> String {
    const CHARACTERS: usize = 120;
    reason.chars().take(CHARACTERS).flat_map(char::escape_debug).collect()
}

fn add(mesh: &Mesh, diffuse: [f32; 3], model: &mut Model) -> Result<(), Problem> {
    let Some(lists) = mesh.lists()? else {
        // A mesh without vertices is an empty object that others hang on.
        return Ok(());
    };
    let place = Place::new(mesh);
    let first = model.positions.len();
    let first_normal = model.normals.len() as u32;
    let vertices = lists.vertices();
    for vertex in 0..vertices {
        model.push_vertex(place.position(lists.position(vertex))?)?;
        if let Some(normal) = lists.normal(vertex) {
            model.normals.push(place.normal(normal));
        }
    }
    add_colours(mesh, diffuse, model, first, vertices)?;
    let indices = mesh.indices.as_deref().unwrap_or_default();
    if !indices.len().is_multiple_of(3) {
        return Err(BabylonProblem::Length { list: "indices", found: indices.len(), each: 3 }.into());
    }
    if let Some((at, index)) = indices.iter().enumerate().find(|(_, index)| **index as usize >= vertices) {
        return Err(BabylonProblem::Index { at, index: *index, vertices }.into());
    }
    let has_normals = lists.normal(0).is_some();
    for corners in indices.as_chunks().0 {
        let [a, b, c] = *corners;
        // A scaling that mirrors turns faces round.
        let corners = if place.mirrors { [a, c, b] } else { [a, b, c] };
        if has_normals || !model.corner_normals.is_empty() {
            model.corner_normals.resize(model.corners.len(), NO_NORMAL);
            let normal = |corner| if has_normals { first_normal + corner } else { NO_NORMAL };
            model.corner_normals.extend(corners.map(normal));
        }
        model.push_triangle(corners.map(|corner| first as u32 + corner))?;
        model.face_colours.get_or_insert_default().push(diffuse);
    }
    Ok(())
}

/// Takes a mesh's colours in: red, green, blue and opacity; without any, its vertices have its material's beside
/// another mesh's that has some.
fn add_colours(
    mesh: &Mesh,
    diffuse: [f32; 3],
    model: &mut Model,
    first: usize,
    vertices: usize,
) -> Result<(), Problem> {
    let colours = mesh.colors.as_deref().unwrap_or_default();
    if !colours.len().is_multiple_of(4) {
        return Err(BabylonProblem::Length { list: "colors", found: colours.len(), each: 4 }.into());
    }
    let found = colours.len() / 4;
    if found > 0 && found != vertices {
        return Err(BabylonProblem::Count { list: "colors", found, vertices }.into());
    }
    if found > 0 || model.colours.is_some() {
        let all = model.colours_so_far(first);
        all.extend(colours.chunks_exact(4).map(|parts| colour([parts[0], parts[1], parts[2]])));
        all.resize(first + vertices, diffuse);
    }
    Ok(())
}

/// Positions and normals, wherever they lie.
struct Lists<'a> {
    positions: &'a [f64],
    normals: &'a [f64],
    /// Numbers from one vertex to the next, in both.
    stride: usize,
}

impl Lists<'_> {
    fn vertices(&self) -> usize {
        self.positions.len() / self.stride
    }

    fn position(&self, vertex: usize) -> [f64; 3] {
        let at = vertex * self.stride;
        [self.positions[at], self.positions[at + 1], self.positions[at + 2]]
    }

    fn normal(&self, vertex: usize) -> Option<[f64; 3]> {
        self.normals.get(vertex * self.stride..)?.first_chunk().copied()
    }
}

impl Mesh {
    fn lists(&self) -> Result<Option<Lists<'_>>, Problem> {
        let whole = |list, numbers: &[f64], each| match numbers.len() {
            found if found.is_multiple_of(each) => Ok(()),
            found => Err(Problem::from(BabylonProblem::Length { list, found, each })),
        };
        if let Some(vertices) = &self.vertices {
            let stride = match self.uv_count.unwrap_or(0) {
                uv_count @ 0..=2 => 6 + 2 * uv_count as usize,
                found => return Err(BabylonProblem::UvCount { found }.into()),
            };
            whole("vertices", vertices, stride)?;
            let normals = vertices.get(3..).unwrap_or_default();
            return Ok(Some(Lists { positions: vertices, normals, stride }));
        }
        let Some(positions) = &self.positions else { return Ok(None) };
        whole("positions", positions, 3)?;
        let normals = self.normals.as_deref().unwrap_or_default();
        whole("normals", normals, 3)?;
        if !normals.is_empty() && normals.len() != positions.len() {
            let (found, vertices) = (normals.len() / 3, positions.len() / 3);
            return Err(BabylonProblem::Count { list: "normals", found, vertices }.into());
        }
        Ok(Some(Lists { positions, normals, stride: 3 }))
    }
}

/// Where a mesh is in its scene.
struct Place {
    scaling: [f64; 3],
    rotation: [[f64; 3]; 3],
    position: [f64; 3],
    /// Whether the scaling turns faces round.
    mirrors: bool,
}

impl Place {
    fn new(mesh: &Mesh) -> Self {
        let scaling = mesh.scaling.unwrap_or([1.0; 3]);
        let rotation = match (mesh.rotation_quaternion, mesh.rotation) {
            (Some(quaternion), _) => of_quaternion(quaternion),
            (None, Some([x, y, z])) => {
                // About z first, then x, then y.
                times(&about(y, 2, 0), &times(&about(x, 1, 2), &about(z, 0, 1)))
            }
            (None, None) => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        };
        let position = mesh.position.unwrap_or_default();
        Self { scaling, rotation, position, mirrors: scaling.iter().product::<f64>() < 0.0 }
    }

    fn position(&self, position: [f64; 3]) -> Result<[f64; 3], Problem> {
        let scaled = [0, 1, 2].map(|axis| position[axis] * self.scaling[axis]);
        let [x, y, z] = [0, 1, 2].map(|axis| dot(self.rotation[axis], scaled) + self.position[axis]);
        Ok([finite(x)?, finite(y)?, finite(-z)?])
    }

    fn normal(&self, normal: [f64; 3]) -> [f32; 3] {
        // The transpose of the inverse, which for a diagonal matrix is the product of the other two over all.
        let [a, b, c] = self.scaling;
        let side = if self.mirrors { -1.0 } else { 1.0 };
        let scaled = [normal[0] * b * c * side, normal[1] * a * c * side, normal[2] * a * b * side];
        let [x, y, z] = [0, 1, 2].map(|axis| dot(self.rotation[axis], scaled));
        let normal = [x, y, -z];
        if normal.iter().all(|part| part.is_finite()) { direction(normal) } else { [0.0; 3] }
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn times(left: &[[f64; 3]; 3], right: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    left.map(|row| [0, 1, 2].map(|column| dot(row, right.map(|row| row[column]))))
}

/// The rotation by `angle`, in radians, that turns axis `from` towards axis `to`.
fn about(angle: f64, from: usize, to: usize) -> [[f64; 3]; 3] {
    let mut matrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let (sine, cosine) = angle.sin_cos();
    matrix[from][from] = cosine;
    matrix[from][to] = -sine;
    matrix[to][from] = sine;
    matrix[to][to] = cosine;
    matrix
}

fn of_quaternion([x, y, z, w]: [f64; 4]) -> [[f64; 3]; 3] {
    [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
        [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
        [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
    ]
}
