//! Builds the model from the statements, and checks what only the whole file can tell.

use std::io::BufRead;
use std::path::Path;

use super::error::quoted;
use super::line::{Keyword, Misplaced, Statement, Statements};
use super::{CORNERS_MAX, ObjError, ObjModel, ObjProblem, VERTICES_MAX};

/// Reads a model from `source`; `file` is its name in errors.
///
/// # Errors
///
/// The first thing that is wrong, with its line.
pub fn parse_obj(source: impl BufRead, file: &Path) -> Result<ObjModel, ObjError> {
    let failed = |line, problem| ObjError { file: file.to_path_buf(), line, problem };
    let mut statements = Statements::new(source);
    let mut builder = Builder { model: ObjModel { face_offsets: vec![0], ..ObjModel::default() }, furthest: None };
    loop {
        match statements.next() {
            Ok(None) => break,
            Ok(Some(Statement { keyword, text, line })) => {
                let taken = match keyword {
                    Keyword::Vertex => builder.vertex(text),
                    Keyword::Face => builder.face(text, line),
                };
                taken.map_err(|problem| failed(Some(line), problem))?;
            }
            Err(Misplaced { problem, line }) => return Err(failed(Some(line), problem)),
        }
    }
    builder.finish().map_err(|(line, problem)| failed(line, problem))
}

/// A face index that names a vertex further on in the file, and its line.
#[derive(Clone, Copy)]
struct Ahead {
    index: i64,
    line: u64,
}

struct Builder {
    model: ObjModel,
    /// The largest index that named a vertex before it came.
    furthest: Option<Ahead>,
}

impl Builder {
    fn vertex(&mut self, text: &str) -> Result<(), ObjProblem> {
        let mut numbers = [0.0; 7];
        let mut count = 0;
        for word in words(text) {
            let number = number(word)?;
            if let Some(slot) = numbers.get_mut(count) {
                *slot = number;
            }
            count += 1;
        }
        let [x, y, z, rest @ ..] = numbers;
        let colour = match count {
            0..=2 => return Err(ObjProblem::MissingCoordinate { count }),
            3 | 4 => None,
            6 => Some([rest[0], rest[1], rest[2]]),
            7 => Some([rest[1], rest[2], rest[3]]),
            _ => return Err(ObjProblem::UnknownVertexForm { count }),
        };
        if self.model.positions.len() >= VERTICES_MAX {
            return Err(ObjProblem::TooManyVertices);
        }
        self.colour(colour);
        self.model.positions.push([x, y, z]);
        Ok(())
    }

    /// Keeps the next vertex's colour; the first colour of the file makes all vertices before it white.
    fn colour(&mut self, colour: Option<[f64; 3]>) {
        const WHITE: [f32; 3] = [1.0; 3];
        let vertices = self.model.positions.len();
        match (colour, &mut self.model.colours) {
            (None, None) => {}
            (None, Some(colours)) => colours.push(WHITE),
            (Some(colour), colours) => {
                colours.get_or_insert_with(|| vec![WHITE; vertices]).push(colour.map(|part| part as f32));
            }
        }
    }

    fn face(&mut self, text: &str, line: u64) -> Result<(), ObjProblem> {
        let before = self.model.corners.len();
        for word in words(text) {
            let corner = self.corner(word, line)?;
            if self.model.corners.len() >= CORNERS_MAX {
                return Err(ObjProblem::TooManyCorners);
            }
            self.model.corners.push(corner);
        }
        let count = self.model.corners.len() - before;
        if count < 3 {
            return Err(ObjProblem::TooFewCorners { count });
        }
        self.model.face_offsets.push(self.model.corners.len() as u32);
        Ok(())
    }

    /// Reads `v`, `v/t`, `v//n` or `v/t/n` and returns the vertex's index from 0.
    fn corner(&mut self, word: &str, line: u64) -> Result<u32, ObjProblem> {
        let not_an_index = || ObjProblem::NotAnIndex { text: quoted(word) };
        let mut parts = word.split('/');
        let index: i64 = parts.next().unwrap_or_default().parse().map_err(|_| not_an_index())?;
        let mut others = 0;
        for part in parts {
            others += 1;
            let whole = part.parse::<i64>().is_ok();
            // Only the texture number may be left out, and only where a normal follows; exporters
            // leave `v/` and `v//` as well, which say the same as `v`.
            if others > 2 || !(part.is_empty() || whole) {
                return Err(not_an_index());
            }
        }
        let vertices = self.model.positions.len();
        let position = match index {
            0 => return Err(ObjProblem::IndexZero),
            1.. => index - 1,
            _ => index + vertices as i64,
        };
        if position < 0 || position >= VERTICES_MAX as i64 {
            return Err(ObjProblem::IndexOutOfRange { index, vertices });
        }
        if position >= vertices as i64 && self.furthest.is_none_or(|ahead| index > ahead.index) {
            self.furthest = Some(Ahead { index, line });
        }
        Ok(position as u32)
    }

    fn finish(self) -> Result<ObjModel, (Option<u64>, ObjProblem)> {
        let vertices = self.model.positions.len();
        match self.furthest {
            Some(Ahead { index, line }) if index > vertices as i64 => {
                Err((Some(line), ObjProblem::IndexOutOfRange { index, vertices }))
            }
            _ if self.model.corners.is_empty() => Err((None, ObjProblem::NoFaces { vertices })),
            _ => Ok(self.model),
        }
    }
}

/// Returns the words of a statement up to a comment.
fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split_ascii_whitespace().take_while(|word| !word.starts_with('#'))
}

fn number(word: &str) -> Result<f64, ObjProblem> {
    match word.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        Ok(_) => Err(ObjProblem::NotFinite { text: quoted(word) }),
        Err(_) => Err(ObjProblem::NotANumber { text: quoted(word) }),
    }
}
