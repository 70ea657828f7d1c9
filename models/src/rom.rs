//! Reads the wire models of MIT 6.111's "Wireframe Simulator": lines of 99 bits for a ROM.
//!
//! A line is an opcode, bits 98…96, and six arguments of 16 bits, from bits 95…80 down to 15…0, signed Q4.11:
//!
//! | opcode | arguments |
//! | --- | --- |
//! | 000 | the eye: x, y, z |
//! | 001 | the viewing plane: z |
//! | 010 | the window in it: lowest x and y, highest x and y |
//! | 100 | a line: x, y, z of one end, x, y, z of the other |
//! | 111 | the end; what follows is not looked at |
//!
//! The file is text, as `$readmemb` and `$readmemh` take it and as a memory initialisation file (`.coe`) has
//! it: a line is a word of 99 binary or 25 hexadecimal digits, parted by white space or commas; underscores
//! mean nothing, `//` starts a comment. Ends at the same place become one vertex.

use std::collections::HashMap;
use std::fmt;
use std::path::Path;

use crate::error::quoted;
use crate::{Model, Problem, ReadError, View};

/// Bits of a line.
const BITS: usize = 99;
/// Hexadecimal digits of a line; the topmost bit is 0.
const DIGITS: usize = 25;
/// What an argument is divided by: 11 fraction bits.
const ONE: f64 = 2048.0;

/// What only a ROM can have wrong.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum RomProblem {
    /// Not text.
    Binary,
    /// A word that is no line.
    NotALine {
        /// The word.
        text: String,
        /// Its length without underscores.
        digits: usize,
    },
    /// An opcode without meaning.
    Opcode {
        /// The three bits.
        opcode: u8,
    },
    /// The last line is not the end.
    NoEnd,
    /// Something that a view wants was never given.
    Missing {
        /// What, and its opcode.
        what: &'static str,
    },
    /// The eye does not lie in front of the viewing plane, or behind z = 0.
    Eye {
        /// The eye's z.
        eye: f64,
        /// The plane's z.
        plane: f64,
    },
    /// The window has no area.
    Window {
        /// Lowest x and y, highest x and y.
        window: [[f64; 2]; 2],
    },
}

impl fmt::Display for RomProblem {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Binary => out.write_str("is not text: write each line as 99 binary or 25 hexadecimal digits"),
            Self::NotALine { text, digits } => {
                write!(out, "`{text}` of {digits} digits is no line: write 99 binary or 25 hexadecimal digits")
            }
            Self::Opcode { opcode } => {
                write!(out, "opcode {opcode:03b} means nothing: use 000, 001, 010, 100 or 111")
            }
            Self::NoEnd => out.write_str("no end: write a last line with opcode 111"),
            Self::Missing { what } => write!(out, "no {what}: write a line that gives it, before the end"),
            Self::Eye { eye, plane } => write!(
                out,
                "the eye's z {eye} is not above the viewing plane's {plane} and at least 0: move the eye or the plane"
            ),
            Self::Window { window: [[left, low], [right, high]] } => {
                write!(out, "the window from ({left}, {low}) to ({right}, {high}) has no area: give the lowest first")
            }
        }
    }
}

/// Reads a model from a file's bytes; `file` is its name in errors.
///
/// # Errors
///
/// The first thing that is wrong, with its line.
pub fn parse(bytes: &[u8], file: &Path) -> Result<Model, ReadError> {
    let text = str::from_utf8(bytes).ok().filter(|text| !text.contains('\0'));
    let text = text.ok_or_else(|| ReadError::file(file, RomProblem::Binary))?;
    let mut builder = Builder { model: Model::empty(), ..Builder::default() };
    for (index, line) in text.lines().enumerate() {
        let content = line.split("//").next().unwrap_or_default();
        // A memory initialisation file's two settings: the radix shows in the words.
        let content =
            if names_the_radix(content) { content.split_once(';').map_or("", |(_, behind)| behind) } else { content };
        let content = content.rsplit('=').next().unwrap_or_default();
        for word in content.split([' ', '\t', '\r', ',', ';']).filter(|word| !word.is_empty()) {
            let taken = bits(word).map_err(Problem::from).and_then(|bits| builder.take(bits));
            if taken.map_err(|problem| ReadError::line(file, index as u64 + 1, problem))? {
                return builder.finish().map_err(|problem| ReadError::file(file, problem));
            }
        }
    }
    Err(ReadError::file(file, RomProblem::NoEnd))
}

/// Returns whether a line starts with a memory initialisation file's setting of its radix, in any case.
fn names_the_radix(line: &str) -> bool {
    const NAME: &str = "memory_initialization_radix";
    line.trim_start().get(..NAME.len()).is_some_and(|start| start.eq_ignore_ascii_case(NAME))
}

/// Returns the bits of a word, the lowest in bit 0.
fn bits(word: &str) -> Result<u128, RomProblem> {
    let digits: String = word.chars().filter(|digit| *digit != '_').take(BITS + 1).collect();
    let not_a_line = || RomProblem::NotALine { text: quoted(word), digits: digits.len() };
    let radix = match digits.len() {
        BITS => 2,
        DIGITS => 16,
        _ => return Err(not_a_line()),
    };
    // `from_str_radix` takes a sign.
    let bits = if digits.starts_with('+') { None } else { u128::from_str_radix(&digits, radix).ok() };
    bits.filter(|bits| bits >> BITS == 0).ok_or_else(not_a_line)
}

#[derive(Default)]
struct Builder {
    model: Model,
    vertices: HashMap<[i16; 3], u32>,
    eye: Option<[f64; 3]>,
    plane: Option<f64>,
    window: Option<[[f64; 2]; 2]>,
}

impl Builder {
    /// Takes in a line and returns whether it was the end.
    fn take(&mut self, bits: u128) -> Result<bool, Problem> {
        let raw = [80, 64, 48, 32, 16, 0].map(|shift: u32| (bits >> shift) as i16);
        let [a, b, c, d, ..] = raw.map(|argument| f64::from(argument) / ONE);
        match (bits >> 96) as u8 & 7 {
            0b000 => self.eye = Some([a, b, c]),
            0b001 => self.plane = Some(a),
            0b010 => self.window = Some([[a, b], [c, d]]),
            0b100 => {
                let [x1, y1, z1, x2, y2, z2] = raw;
                let ends = [self.vertex([x1, y1, z1])?, self.vertex([x2, y2, z2])?];
                self.model.push_line(ends)?;
            }
            0b111 => return Ok(true),
            opcode => return Err(RomProblem::Opcode { opcode }.into()),
        }
        Ok(false)
    }

    fn vertex(&mut self, position: [i16; 3]) -> Result<u32, Problem> {
        if let Some(index) = self.vertices.get(&position) {
            return Ok(*index);
        }
        let index = self.model.positions.len() as u32;
        self.model.push_vertex(position.map(|part| f64::from(part) / ONE))?;
        self.vertices.insert(position, index);
        Ok(index)
    }

    fn finish(mut self) -> Result<Model, Problem> {
        let missing = |what| RomProblem::Missing { what };
        let eye = self.eye.ok_or_else(|| missing("eye (opcode 000)"))?;
        let plane = self.plane.ok_or_else(|| missing("viewing plane (opcode 001)"))?;
        let window = self.window.ok_or_else(|| missing("window (opcode 010)"))?;
        if !(eye[2] > plane && eye[2] >= 0.0) {
            return Err(RomProblem::Eye { eye: eye[2], plane }.into());
        }
        let [[left, low], [right, high]] = window;
        if !(left < right && low < high) {
            return Err(RomProblem::Window { window }.into());
        }
        self.model.view = Some(View { eye, plane, window });
        self.model.finish()
    }
}
