//! Reads binary glTF 2.0 models (`.glb`), by the crate `gltf`.
//!
//! Taken: the default scene's nodes with their transforms, and of each mesh triangles (strips and fans too),
//! lines, positions, normals, colours, and the material's base colour, which colours are multiplied by.
//! Textures, skins, animations and points are passed over, points with a note. Buffers lie in the file itself.
//!
//! The crate reads the JSON and checks what names what. The file's parts and the numbers are read here, for the
//! crate's own readers of these stop with a panic at some wrong ones.

mod accessor;
mod container;
mod node;
mod primitive;

use std::fmt;
use std::path::Path;

use ::gltf::{Document, json};

use crate::{Model, ReadError};

/// Most nodes, meshes, accessors and other objects of a file's JSON, together.
pub const PARTS_MAX: usize = 1 << 20;

/// What only a glTF file can have wrong.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum GltfProblem {
    /// JSON alone, without the binary part.
    NotBinary,
    /// The file is not made as a binary glTF file is.
    Container {
        /// The reason.
        reason: String,
    },
    /// No JSON, or not glTF's.
    Json {
        /// The reason.
        reason: String,
    },
    /// So many parts that even empty ones would take more memory than any model.
    TooManyParts {
        /// Parts that there are: objects of the JSON.
        parts: usize,
    },
    /// A buffer in another file.
    ExternalBuffer {
        /// The buffer's number.
        buffer: usize,
    },
    /// Numbers that lie outside of their view or buffer.
    OutOfBuffer {
        /// The accessor's number.
        accessor: usize,
        /// One more than the last byte it reads, from the buffer's start.
        end: u64,
        /// Bytes that there are.
        bytes: usize,
    },
    /// Numbers of a kind that this part cannot have.
    WrongType {
        /// The accessor's number.
        accessor: usize,
        /// What it must be.
        wanted: &'static str,
    },
    /// Numbers given as changes to others.
    Sparse {
        /// The accessor's number.
        accessor: usize,
    },
    /// An attribute with another count than the positions.
    Count {
        /// The attribute.
        attribute: &'static str,
        /// How many it has.
        found: usize,
        /// How many positions there are.
        positions: usize,
    },
    /// An index that names no vertex.
    Index {
        /// Where it stands, from 0.
        at: usize,
        /// The index.
        index: u32,
        /// Vertices that there are.
        vertices: usize,
    },
    /// A node that is the child of two, or of itself.
    SecondParent,
    /// Nodes that hang on each other deeper than any scene's.
    Depth {
        /// Levels that are followed.
        most: usize,
    },
}

impl fmt::Display for GltfProblem {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotBinary => out.write_str("is not binary glTF: export the scene as one .glb file"),
            Self::Container { reason } => write!(out, "{reason}: copy or export the file again"),
            Self::Json { reason } => write!(out, "{reason}: export the scene as .glb again"),
            Self::TooManyParts { parts } => {
                write!(out, "{parts} nodes, meshes and other parts, at most {PARTS_MAX} are read: join some")
            }
            Self::ExternalBuffer { buffer } => {
                write!(out, "buffer {buffer} lies in another file: export the scene as one .glb file")
            }
            Self::OutOfBuffer { accessor, end, bytes } => {
                write!(out, "accessor {accessor} reads up to byte {end} of {bytes}: copy or export the file again")
            }
            Self::WrongType { accessor, wanted } => {
                write!(out, "accessor {accessor} is not {wanted}: export the scene as .glb again")
            }
            Self::Sparse { accessor } => {
                write!(out, "accessor {accessor} is sparse, which is not read: export without sparse accessors")
            }
            Self::Count { attribute, found, positions } => {
                write!(out, "{attribute} for {found} vertices, there are {positions} positions: export the scene again")
            }
            Self::Index { at, index, vertices } => {
                write!(out, "index {at} is {index}, past the last of {vertices} vertices: export the scene again")
            }
            Self::Depth { most } => {
                write!(out, "nodes hang more than {most} deep: export the scene again")
            }
            Self::SecondParent => out.write_str("hangs on two nodes or in a circle: export the scene again"),
        }
    }
}

/// Reads a model from a file's bytes; `file` is its name in errors.
///
/// # Errors
///
/// The first thing that is wrong, with the node and mesh it is in.
pub fn parse(bytes: &[u8], file: &Path) -> Result<Model, ReadError> {
    if !bytes.starts_with(b"glTF") {
        return Err(ReadError::file(file, GltfProblem::NotBinary));
    }
    let (json, blob) = container::parts(bytes).map_err(|problem| ReadError::file(file, problem))?;
    let parts = json.iter().filter(|byte| **byte == b'{').count();
    if parts > PARTS_MAX {
        return Err(ReadError::file(file, GltfProblem::TooManyParts { parts }));
    }
    let failed = |error| ReadError::file(file, problem(error));
    let root = json::deserialize::from_slice(json).map_err(|error| failed(::gltf::Error::Deserialize(error)))?;
    check_positions(&root).map_err(|problem| ReadError::file(file, problem))?;
    let document = Document::from_json(root).map_err(failed)?;
    let mut model = Model::empty();
    let scene = document.default_scene().or_else(|| document.scenes().next());
    if let Some(scene) = scene {
        let mut walk = node::Walk::new(document.nodes().len());
        for node in scene.nodes() {
            node::add(&node, &node::Placed::IDENTITY, &mut walk, blob, &mut model)
                .map_err(|(part, problem)| ReadError::part(file, part, problem))?;
        }
    }
    note(&document, &mut model);
    model.outline_beside_lines();
    model.finish().map_err(|problem| ReadError::file(file, problem))
}

/// Checks that primitives name positions that exist: the crate's own check looks into them first.
fn check_positions(root: &json::Root) -> Result<(), GltfProblem> {
    for (mesh_index, mesh) in root.meshes.iter().enumerate() {
        for (index, primitive) in mesh.primitives.iter().enumerate() {
            let named = primitive.attributes.values().map(json::Index::value).max();
            if named.is_some_and(|accessor| accessor >= root.accessors.len()) {
                let part = format!("meshes[{mesh_index}].primitives[{index}].attributes");
                return Err(GltfProblem::Json { reason: format!("{part}: Index out of bounds") });
            }
        }
    }
    Ok(())
}

/// Says what was left out that a person would miss.
fn note(document: &Document, model: &mut Model) {
    let points = |primitive: ::gltf::Primitive<'_>| primitive.mode() == ::gltf::mesh::Mode::Points;
    if document.meshes().any(|mesh| mesh.primitives().any(points)) {
        model.notes.push("points are left out".into());
    }
    if document.images().len() > 0 {
        model.notes.push("textures are left out: base colours alone count".into());
    }
    if document.skins().len() > 0 {
        model.notes.push("skins are left out: the model is in its rest pose".into());
    }
}

fn problem(error: ::gltf::Error) -> GltfProblem {
    let reason = match error {
        ::gltf::Error::Validation(errors) => {
            errors.first().map_or_else(String::new, |(path, error)| format!("{path}: {error}"))
        }
        error => error.to_string(),
    };
    GltfProblem::Json { reason: shortened(&reason) }
}

/// A reason may quote the file.
fn shortened(reason: &str) -> String {
    const CHARACTERS: usize = 160;
    reason.chars().take(CHARACTERS).flat_map(char::escape_debug).collect()
}
