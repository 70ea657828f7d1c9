//! Cuts an OBJ file into statements: bounded lines, continuations joined, line numbers kept.

use std::borrow::Cow;
use std::io::{self, BufRead};

use super::{LINE_BYTES_MAX, ObjProblem};
use crate::Problem;

/// The statements that are read; all others are passed over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Keyword {
    /// `v`
    Vertex,
    /// `vn`
    Normal,
    /// `f`
    Face,
    /// `l`
    Line,
    /// `mtllib`
    Library,
    /// `usemtl`
    UseMaterial,
    /// `newmtl`, in a file of materials
    NewMaterial,
    /// `Kd`, in a file of materials
    Diffuse,
}

impl Keyword {
    const ALL: [(&'static str, Self); 8] = [
        ("v", Self::Vertex),
        ("vn", Self::Normal),
        ("f", Self::Face),
        ("l", Self::Line),
        ("mtllib", Self::Library),
        ("usemtl", Self::UseMaterial),
        ("newmtl", Self::NewMaterial),
        ("Kd", Self::Diffuse),
    ];

    /// Whether what follows is a name, in any encoding and with any characters.
    fn takes_a_name(self) -> bool {
        matches!(self, Self::Library | Self::UseMaterial | Self::NewMaterial)
    }
}

/// A statement that is read.
pub(super) struct Statement<'buffer> {
    pub(super) keyword: Keyword,
    /// What stands behind the keyword.
    pub(super) text: Cow<'buffer, str>,
    /// Line from 1 where it starts.
    pub(super) line: u64,
}

/// What is wrong, and the line from 1 it is on.
pub(super) struct Misplaced {
    pub(super) problem: Problem,
    pub(super) line: u64,
}

/// Reads statements one at a time into one buffer.
pub(super) struct Statements<Source> {
    source: Source,
    buffer: Vec<u8>,
    lines_read: u64,
}

impl<Source: BufRead> Statements<Source> {
    pub(super) fn new(source: Source) -> Self {
        Self { source, buffer: Vec::new(), lines_read: 0 }
    }

    /// Returns the next statement, `None` at the end.
    pub(super) fn next(&mut self) -> Result<Option<Statement<'_>>, Misplaced> {
        let (keyword, line) = loop {
            self.buffer.clear();
            let line = self.lines_read + 1;
            if !self.append_line().map_err(|problem| Misplaced { problem, line })? {
                return Ok(None);
            }
            if line == 1 && self.buffer.starts_with(b"\xef\xbb\xbf") {
                self.buffer.drain(..3);
            }
            match keyword(&self.buffer) {
                Ok(Some(keyword)) => break (keyword, line),
                Ok(None) => {}
                Err(problem) => return Err(Misplaced { problem: problem.into(), line }),
            }
        };
        // A comment or a name may end in a backslash and means nothing by it; the others do.
        while !keyword.takes_a_name() && self.buffer.last() == Some(&b'\\') {
            self.buffer.pop();
            self.buffer.push(b' ');
            if !self.append_line().map_err(|problem| Misplaced { problem, line })? {
                break;
            }
        }
        let behind = self.buffer.trim_ascii_start();
        let behind = &behind[keyword_length(behind)..];
        let text = match str::from_utf8(behind) {
            Ok(text) => Cow::Borrowed(text),
            Err(_) if keyword.takes_a_name() => String::from_utf8_lossy(behind),
            Err(_) => return Err(Misplaced { problem: ObjProblem::Binary.into(), line }),
        };
        Ok(Some(Statement { keyword, text, line }))
    }

    /// Appends the next line without its end to the buffer; `false` at the end of the file.
    fn append_line(&mut self) -> Result<bool, Problem> {
        let mut any = false;
        loop {
            let chunk = match self.source.fill_buf() {
                Ok(chunk) => chunk,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                Err(cause) => return Err(Problem::Unreadable { cause }),
            };
            if chunk.is_empty() {
                break;
            }
            any = true;
            let end = chunk.iter().position(|byte| *byte == b'\n');
            let part = &chunk[..end.unwrap_or(chunk.len())];
            if part.contains(&0) {
                return Err(ObjProblem::Binary.into());
            }
            if self.buffer.len() + part.len() > LINE_BYTES_MAX {
                return Err(ObjProblem::LineTooLong.into());
            }
            self.buffer.extend_from_slice(part);
            let used = part.len() + usize::from(end.is_some());
            self.source.consume(used);
            if end.is_some() {
                break;
            }
        }
        if self.buffer.last() == Some(&b'\r') {
            self.buffer.pop();
        }
        self.lines_read += u64::from(any);
        Ok(any)
    }
}

/// Returns the length of the word that a line starts with, without the backslash that may follow at once.
fn keyword_length(line: &[u8]) -> usize {
    let end = line.iter().position(u8::is_ascii_whitespace).unwrap_or(line.len());
    end - usize::from(line[..end].ends_with(b"\\"))
}

/// Returns the keyword of a line that is read, `None` for one that is passed over.
fn keyword(line: &[u8]) -> Result<Option<Keyword>, ObjProblem> {
    let line = line.trim_ascii_start();
    let word = &line[..keyword_length(line)];
    if let Some((_, keyword)) = Keyword::ALL.iter().find(|(name, _)| name.as_bytes() == word) {
        return Ok(Some(*keyword));
    }
    // Comments and names may be in any encoding; a keyword is ASCII in every text file.
    if word.starts_with(b"#") || word.iter().all(u8::is_ascii_graphic) { Ok(None) } else { Err(ObjProblem::Binary) }
}

/// Returns the words of a statement up to a comment.
pub(super) fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split_ascii_whitespace().take_while(|word| !word.starts_with('#'))
}
