//! Reads binary glTF 2.0 models (`.glb`), by the crate `gltf`.
//!
//! Taken: the default scene's nodes with their transforms, and of each mesh triangles (strips and fans too),
//! lines, positions, normals, colours, and the material's base colour, which colours are multiplied by.
//! Textures, skins, animations and points are passed over, points with a note. Buffers lie in the file itself.
//!
//! The crate checks the JSON and what names what; where the numbers lie is checked in `accessor` here, for the
//! crate's own readers stop with a panic at some wrong ones.

mod accessor;
mod node;
mod primitive;

use std::fmt;
use std::path::Path;

use ::gltf::{Document, Gltf, binary};

use crate::{Model, Problem, ReadError};

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
    let stated = bytes.get(8..12).and_then(|length| length.try_into().ok()).map(u32::from_le_bytes);
    if let Some(stated) = stated.filter(|stated| *stated as usize > bytes.len()) {
        let reason = format!("{} bytes of {stated} that the header states", bytes.len());
        return Err(ReadError::file(file, GltfProblem::Container { reason }));
    }
    let Gltf { document, blob } = Gltf::from_slice(bytes).map_err(|error| ReadError::file(file, problem(error)))?;
    let blob = blob.unwrap_or_default();
    let mut model = Model::empty();
    let scene = document.default_scene().or_else(|| document.scenes().next());
    if let Some(scene) = scene {
        let mut walk = node::Walk::new(document.nodes().len());
        for node in scene.nodes() {
            node::add(&node, &node::Placed::IDENTITY, &mut walk, &blob, &mut model)
                .map_err(|(part, problem)| ReadError::part(file, part, problem))?;
        }
    }
    note(&document, &mut model);
    model.outline_beside_lines();
    model.finish().map_err(|problem| ReadError::file(file, problem))
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

fn problem(error: ::gltf::Error) -> Problem {
    let container = |reason: String| GltfProblem::Container { reason };
    match error {
        ::gltf::Error::Deserialize(error) => GltfProblem::Json { reason: shortened(&error.to_string()) },
        ::gltf::Error::Validation(errors) => {
            let reason = errors.first().map_or_else(String::new, |(path, error)| format!("{path}: {error}"));
            GltfProblem::Json { reason: shortened(&reason) }
        }
        ::gltf::Error::Binary(error) => match error {
            binary::Error::Version(version) => container(format!("binary glTF of version {version}, 2 is read")),
            // Of what follows the header; the whole was looked at before.
            binary::Error::Length { length, length_read } => {
                container(format!("{length_read} bytes of {length} behind the header"))
            }
            binary::Error::ChunkLength { ty, length, length_read } => {
                container(format!("{length_read} bytes of {length} that the {ty:?} chunk states"))
            }
            binary::Error::ChunkType(ty) => container(format!("a {ty:?} chunk where another must be")),
            binary::Error::UnknownChunkType(ty) => container(format!("a chunk of unknown type {ty:02x?}")),
            // Reading from memory fails at its end alone.
            binary::Error::Io(_) => container("the file ends within its headers".into()),
            binary::Error::Magic(magic) => container(format!("starts with {magic:02x?}")),
        },
        error => container(shortened(&error.to_string())),
    }
    .into()
}

/// A reason may quote the file.
fn shortened(reason: &str) -> String {
    const CHARACTERS: usize = 160;
    reason.chars().take(CHARACTERS).flat_map(char::escape_debug).collect()
}
