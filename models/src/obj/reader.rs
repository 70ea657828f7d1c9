//! Builds the model from the statements, and checks what only the whole file can tell.

use std::borrow::Cow;
use std::io::BufRead;
use std::path::Path;

use super::ObjProblem;
use super::line::{Keyword, Misplaced, Statement, Statements, words};
use super::material::Materials;
use crate::error::quoted;
use crate::number::number;
use crate::polygon::{self, PolygonFault};
use crate::{CORNERS_MAX, Model, NO_NORMAL, PLAIN, Problem, ReadError, VERTICES_MAX};

/// Reads a model from `source`; `file` is its name in errors. `library` reads a file of materials by its
/// name, or says that there is none.
///
/// # Errors
///
/// The first thing that is wrong, with its line; whatever `library` reports.
pub fn parse_obj(
    source: impl BufRead,
    file: &Path,
    mut library: impl FnMut(&str) -> Result<Option<Materials>, ReadError>,
) -> Result<Model, ReadError> {
    let mut statements = Statements::new(source);
    let mut builder = Builder { model: Model::empty(), ..Builder::default() };
    loop {
        let Statement { keyword, text, line } = match statements.next() {
            Ok(Some(statement)) => statement,
            Ok(None) => break,
            Err(Misplaced { problem, line }) => return Err(ReadError::line(file, line, problem)),
        };
        let taken = match keyword {
            Keyword::Vertex => builder.vertex(&text),
            Keyword::Normal => builder.normal(&text),
            Keyword::Face => builder.face(&text, line),
            Keyword::Line => builder.line(&text, line),
            Keyword::UseMaterial => {
                builder.use_material(text);
                Ok(())
            }
            Keyword::Library => {
                builder.add_libraries(text.trim(), &mut library)?;
                Ok(())
            }
            Keyword::NewMaterial | Keyword::Diffuse => Ok(()),
        };
        taken.map_err(|problem| ReadError::line(file, line, problem))?;
    }
    builder.finish().map_err(|(line, problem)| match line {
        Some(line) => ReadError::line(file, line, problem),
        None => ReadError::file(file, problem),
    })
}

/// An index that names something further on in the file, and its line.
#[derive(Clone, Copy)]
struct Ahead {
    index: i64,
    line: u64,
}

/// Notes that are kept.
const NOTES_MAX: usize = 8;

/// Reads a file of materials by its name.
type Library<'a> = dyn FnMut(&str) -> Result<Option<Materials>, ReadError> + 'a;

/// Returns whether a file of this name lies outside of the model's folder, by the rules of any system.
fn leads_out(name: &str) -> bool {
    name.starts_with(['/', '\\']) || name.get(1..2) == Some(":") || name.split(['/', '\\']).any(|part| part == "..")
}

/// Stands for the colour of a vertex that has none, until the whole file is read: no colour is below 0.
const UNCOLOURED: [f32; 3] = [-1.0; 3];

#[derive(Default)]
struct Builder {
    model: Model,
    /// The largest index that named a vertex, and a normal, before it came.
    furthest: [Option<Ahead>; 2],
    /// Faces of more than three corners, and their lines.
    polygons: Vec<(u32, u64)>,
    materials: Materials,
    /// The colour of the faces that follow.
    colour: Option<[f32; 3]>,
}

/// What an index names.
#[derive(Clone, Copy)]
enum Named {
    Vertices = 0,
    Normals = 1,
}

impl Named {
    const fn text(self) -> &'static str {
        ["vertices", "normals"][self as usize]
    }
}

impl Builder {
    fn vertex(&mut self, text: &str) -> Result<(), Problem> {
        let (numbers, count) = numbers::<7>(text)?;
        let [x, y, z, rest @ ..] = numbers;
        let colour = match count {
            0..=2 => return Err(ObjProblem::MissingCoordinate { of: "v", count }.into()),
            3 | 4 => None,
            6 => Some([rest[0], rest[1], rest[2]]),
            7 => Some([rest[1], rest[2], rest[3]]),
            _ => return Err(ObjProblem::UnknownVertexForm { count }.into()),
        };
        self.model.push_vertex([x, y, z])?;
        self.vertex_colour(colour);
        Ok(())
    }

    /// Keeps the newest vertex's colour.
    fn vertex_colour(&mut self, colour: Option<[f64; 3]>) {
        let before = self.model.positions.len() - 1;
        match (colour, &mut self.model.colours) {
            (None, None) => {}
            (None, Some(colours)) => colours.push(UNCOLOURED),
            (Some(colour), colours) => {
                colours.get_or_insert_with(|| vec![UNCOLOURED; before]).push(crate::model::colour(colour));
            }
        }
    }

    /// Gives vertices without a colour, where others have one, that of a face around them; white without materials.
    fn colour_the_uncoloured(&mut self) {
        const WHITE: [f32; 3] = [1.0; 3];
        let Some(mut colours) = self.model.colours.take() else { return };
        if let Some(face_colours) = &self.model.face_colours {
            for (range, face_colour) in self.model.face_ranges().zip(face_colours) {
                for corner in &self.model.corners[range] {
                    let colour = &mut colours[*corner as usize];
                    if *colour == UNCOLOURED {
                        *colour = *face_colour;
                    }
                }
            }
        }
        colours.iter_mut().filter(|colour| **colour == UNCOLOURED).for_each(|colour| *colour = WHITE);
        self.model.colours = Some(colours);
    }

    fn normal(&mut self, text: &str) -> Result<(), Problem> {
        let ([x, y, z], count) = numbers::<3>(text)?;
        if count < 3 {
            return Err(ObjProblem::MissingCoordinate { of: "vn", count }.into());
        }
        if self.model.normals.len() >= VERTICES_MAX {
            return Err(Problem::TooManyVertices);
        }
        self.model.normals.push(crate::model::direction([x, y, z]));
        Ok(())
    }

    fn face(&mut self, text: &str, line: u64) -> Result<(), Problem> {
        let before = self.model.corners.len();
        for word in words(text) {
            let (corner, normal) = self.corner(word, line)?;
            if self.model.corners.len() >= CORNERS_MAX {
                return Err(Problem::TooManyCorners);
            }
            self.model.corners.push(corner);
            if normal.is_some() || !self.model.corner_normals.is_empty() {
                // The first normal of the file: all corners before it have none.
                self.model.corner_normals.resize(self.model.corners.len() - 1, NO_NORMAL);
                self.model.corner_normals.push(normal.unwrap_or(NO_NORMAL));
            }
        }
        let count = self.model.corners.len() - before;
        if count < 3 {
            return Err(ObjProblem::TooFewCorners { count }.into());
        }
        let face = self.model.face_count();
        if count > 3 {
            self.polygons.push((face as u32, line));
        }
        if self.colour.is_some() || self.model.face_colours.is_some() {
            let colours = self.model.face_colours.get_or_insert_with(|| vec![PLAIN; face]);
            colours.push(self.colour.unwrap_or(PLAIN));
        }
        self.model.end_face()
    }

    fn line(&mut self, text: &str, line: u64) -> Result<(), Problem> {
        let mut ends = 0;
        let mut last = 0;
        for word in words(text) {
            let (end, _) = self.corner(word, line)?;
            if ends > 0 {
                self.model.push_line([last, end])?;
            }
            (last, ends) = (end, ends + 1);
        }
        if ends < 2 { Err(ObjProblem::TooFewEnds { count: ends }.into()) } else { Ok(()) }
    }

    /// Reads `v`, `v/t`, `v//n` or `v/t/n` and returns the vertex's and the normal's index from 0.
    fn corner(&mut self, word: &str, line: u64) -> Result<(u32, Option<u32>), Problem> {
        let not_an_index = || Problem::from(ObjProblem::NotAnIndex { text: quoted(word) });
        let mut parts = word.split('/');
        let index: i64 = parts.next().unwrap_or_default().parse().map_err(|_| not_an_index())?;
        let mut others = [None; 2];
        for (count, part) in parts.enumerate() {
            // Only the texture number may be left out, and only where a normal follows; exporters
            // leave `v/` and `v//` as well, which say the same as `v`.
            let slot = others.get_mut(count).ok_or_else(not_an_index)?;
            if !part.is_empty() {
                *slot = Some(part.parse::<i64>().map_err(|_| not_an_index())?);
            }
        }
        let corner = self.index(Named::Vertices, index, line)?;
        let normal = others[1].map(|index| self.index(Named::Normals, index, line)).transpose()?;
        Ok((corner, normal))
    }

    /// Returns an index from 0 of one from 1, or of one back from the newest.
    fn index(&mut self, named: Named, index: i64, line: u64) -> Result<u32, Problem> {
        let count = match named {
            Named::Vertices => self.model.positions.len(),
            Named::Normals => self.model.normals.len(),
        };
        let position = match index {
            0 => return Err(ObjProblem::IndexZero.into()),
            1.. => index - 1,
            _ => index + count as i64,
        };
        if position < 0 || position >= VERTICES_MAX as i64 {
            return Err(ObjProblem::IndexOutOfRange { of: named.text(), index, count }.into());
        }
        let furthest = &mut self.furthest[named as usize];
        if position >= count as i64 && furthest.is_none_or(|ahead| index > ahead.index) {
            *furthest = Some(Ahead { index, line });
        }
        Ok(position as u32)
    }

    fn use_material(&mut self, name: Cow<'_, str>) {
        let name = name.trim();
        self.colour = self.materials.get(name).copied();
        if self.colour.is_none() && !self.materials.is_empty() {
            self.note(format!("material `{}` is in no file of materials: its faces are grey", quoted(name)));
        }
    }

    /// Adds the materials of the file of this name or, where there is none, of the files that its words name.
    fn add_libraries(&mut self, names: &str, library: &mut Library<'_>) -> Result<(), ReadError> {
        if self.add_library(names, library)? {
            return Ok(());
        }
        let mut missing = Vec::new();
        let mut found = false;
        for name in names.split_ascii_whitespace() {
            if self.add_library(name, library)? {
                found = true;
            } else if missing.len() < NOTES_MAX {
                missing.push(name);
            }
        }
        // A name with spaces is one name.
        for name in if found { missing } else { vec![names] } {
            self.note(if leads_out(name) {
                let name = quoted(name);
                format!(
                    "file of materials `{name}` is not looked for, its name leads elsewhere: put it beside the model"
                )
            } else {
                format!("no file of materials `{}` beside the model: faces are grey", quoted(name))
            });
        }
        Ok(())
    }

    /// Adds a file's materials; returns whether there is one.
    fn add_library(&mut self, name: &str, library: &mut Library<'_>) -> Result<bool, ReadError> {
        let materials = if leads_out(name) { None } else { library(name)? };
        let found = materials.is_some();
        self.materials.extend(materials.into_iter().flatten());
        Ok(found)
    }

    fn note(&mut self, note: String) {
        if self.model.notes.len() < NOTES_MAX && !self.model.notes.contains(&note) {
            self.model.notes.push(note);
        }
    }

    fn finish(mut self) -> Result<Model, (Option<u64>, Problem)> {
        let counts = [self.model.positions.len(), self.model.normals.len()];
        for named in [Named::Vertices, Named::Normals] {
            let count = counts[named as usize];
            if let Some(Ahead { index, line }) = self.furthest[named as usize]
                && index > count as i64
            {
                return Err((Some(line), ObjProblem::IndexOutOfRange { of: named.text(), index, count }.into()));
            }
        }
        for (face, line) in &self.polygons {
            self.check_polygon(*face as usize).map_err(|problem| (Some(*line), problem.into()))?;
        }
        if !self.model.corner_normals.is_empty() {
            self.model.corner_normals.resize(self.model.corners.len(), NO_NORMAL);
        }
        self.colour_the_uncoloured();
        self.model.outline_beside_lines();
        self.model.finish().map_err(|problem| (None, problem))
    }

    fn check_polygon(&self, face: usize) -> Result<(), ObjProblem> {
        let model = &self.model;
        let ends = [model.face_offsets[face], model.face_offsets[face + 1]].map(|end| end as usize);
        let polygon: Vec<[f64; 3]> =
            model.corners[ends[0]..ends[1]].iter().map(|corner| model.positions[*corner as usize]).collect();
        let corners = polygon.len();
        polygon::check(&polygon).map_err(|fault| match fault {
            PolygonFault::NotConvex { corner } => ObjProblem::NotConvex { corners, corner: corner + 1 },
            PolygonFault::NotFlat { corner } => ObjProblem::NotFlat { corners, corner: corner + 1 },
        })
    }
}

/// Returns the first numbers of a statement, and how many there are in all.
fn numbers<const MOST: usize>(text: &str) -> Result<([f64; MOST], usize), Problem> {
    let mut numbers = [0.0; MOST];
    let mut count = 0;
    for word in words(text) {
        let number = number(word)?;
        if let Some(slot) = numbers.get_mut(count) {
            *slot = number;
        }
        count += 1;
    }
    Ok((numbers, count))
}
