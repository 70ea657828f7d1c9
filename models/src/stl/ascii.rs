//! Triangles in words.

use std::path::Path;

use super::{Builder, StlProblem, unexpected};
use crate::number::number;
use crate::{Model, Problem, ReadError};

/// Reads a text of any number of solids.
pub(super) fn parse(bytes: &[u8], file: &Path) -> Result<Model, ReadError> {
    let text = str::from_utf8(bytes).ok().filter(|text| !text.contains('\0'));
    let text = text.ok_or_else(|| ReadError::file(file, StlProblem::Binary))?;
    let mut words = Words::new(text);
    let mut builder = Builder::new();
    solids(&mut words, &mut builder).map_err(|problem| ReadError::line(file, words.line, problem))?;
    builder.finish().map_err(|problem| ReadError::file(file, problem))
}

fn solids(words: &mut Words<'_>, builder: &mut Builder) -> Result<(), Problem> {
    while let Some(word) = words.next() {
        if !word.eq_ignore_ascii_case("solid") {
            return Err(unexpected(Some(word), "solid"));
        }
        // A name of any words.
        words.skip_line();
        loop {
            match words.next() {
                Some(word) if word.eq_ignore_ascii_case("endsolid") => break words.skip_line(),
                Some(word) if word.eq_ignore_ascii_case("facet") => facet(words, builder)?,
                found => return Err(unexpected(found, "facet")),
            }
        }
    }
    Ok(())
}

fn facet(words: &mut Words<'_>, builder: &mut Builder) -> Result<(), Problem> {
    words.expect("normal")?;
    // Some exporters write `nan` here for triangles without area.
    for _ in 0..3 {
        words.next().ok_or_else(|| unexpected(None, "a number"))?;
    }
    words.expect("outer")?;
    words.expect("loop")?;
    let mut corners = [[0.0; 3]; 3];
    for corner in &mut corners {
        words.expect("vertex")?;
        for part in corner {
            *part = number(words.next().ok_or_else(|| unexpected(None, "a number"))?)?;
        }
    }
    words.expect("endloop")?;
    words.expect("endfacet")?;
    builder.triangle(corners)
}

/// A text's words, and the line from 1 that the last one was on.
struct Words<'a> {
    rest: &'a str,
    line: u64,
}

impl<'a> Words<'a> {
    fn new(text: &'a str) -> Self {
        Self { rest: text, line: 1 }
    }

    fn next(&mut self) -> Option<&'a str> {
        let start = self.rest.trim_ascii_start();
        let passed = &self.rest[..self.rest.len() - start.len()];
        self.line += passed.bytes().filter(|byte| *byte == b'\n').count() as u64;
        let end = start.find(|letter: char| letter.is_ascii_whitespace()).unwrap_or(start.len());
        let (word, rest) = start.split_at(end);
        self.rest = rest;
        Some(word).filter(|word| !word.is_empty())
    }

    /// Passes over what is left of the line.
    fn skip_line(&mut self) {
        self.rest = &self.rest[self.rest.find('\n').unwrap_or(self.rest.len())..];
    }

    fn expect(&mut self, expected: &'static str) -> Result<(), Problem> {
        match self.next() {
            Some(word) if word.eq_ignore_ascii_case(expected) => Ok(()),
            found => Err(unexpected(found, expected)),
        }
    }
}
