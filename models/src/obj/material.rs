//! Reads a file of materials: names, and the diffuse colour of each.

use std::collections::HashMap;
use std::io::BufRead;
use std::path::Path;

use super::ObjProblem;
use super::line::{Keyword, Misplaced, Statements, words};
use crate::ReadError;
use crate::number::number;

/// Materials' colours by name: red, green, blue, 0 to 1 by convention.
pub type Materials = HashMap<String, [f32; 3]>;

/// What the format gives a material without `Kd`.
const DIFFUSE: [f32; 3] = [0.8; 3];

/// Reads materials from `source`; `file` is its name in errors.
///
/// # Errors
///
/// The first thing that is wrong, with its line.
pub fn parse(source: impl BufRead, file: &Path) -> Result<Materials, ReadError> {
    let mut statements = Statements::new(source);
    let mut materials = Materials::new();
    let mut current: Option<String> = None;
    loop {
        let statement = match statements.next() {
            Ok(Some(statement)) => statement,
            Ok(None) => return Ok(materials),
            Err(Misplaced { problem, line }) => return Err(ReadError::line(file, line, problem)),
        };
        let failed = |problem| ReadError::line(file, statement.line, problem);
        match statement.keyword {
            Keyword::NewMaterial => {
                let name = statement.text.trim().to_string();
                materials.insert(name.clone(), DIFFUSE);
                current = Some(name);
            }
            Keyword::Diffuse => {
                let text = words(&statement.text);
                // `Kd spectral` and `Kd xyz` are other ways to say a colour, which hardly any file uses.
                let mut text = text.peekable();
                if matches!(text.peek(), Some(&("spectral" | "xyz"))) {
                    continue;
                }
                let numbers: Vec<f64> = text.take(4).map(number).collect::<Result<_, _>>().map_err(failed)?;
                let colour: [f64; 3] = match numbers[..] {
                    [red, green, blue] => [red, green, blue],
                    // One number stands for all three.
                    [grey] => [grey; 3],
                    _ => return Err(failed(ObjProblem::NotAColour { count: numbers.len() }.into())),
                };
                let name = current.as_ref().ok_or_else(|| failed(ObjProblem::NoMaterial.into()))?;
                materials.insert(name.clone(), crate::model::colour(colour));
            }
            _ => {}
        }
    }
}
