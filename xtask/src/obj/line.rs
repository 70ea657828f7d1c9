//! Cuts an OBJ file into statements: bounded lines, continuations joined, line numbers kept.

use std::io::{self, BufRead};

use super::{LINE_BYTES_MAX, ObjProblem};

/// The statements that are read; all others are passed over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Keyword {
    /// `v`
    Vertex,
    /// `f`
    Face,
}

/// A vertex or a face.
pub(super) struct Statement<'buffer> {
    pub(super) keyword: Keyword,
    /// What stands behind the keyword.
    pub(super) text: &'buffer str,
    /// Line from 1 where it starts.
    pub(super) line: u64,
}

/// What is wrong, and the line from 1 it is on.
pub(super) struct Misplaced {
    pub(super) problem: ObjProblem,
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

    /// Returns the next vertex or face, `None` at the end.
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
                Err(problem) => return Err(Misplaced { problem, line }),
            }
        };
        // A comment or a name may end in a backslash and means nothing by it; these two do.
        while self.buffer.last() == Some(&b'\\') {
            self.buffer.pop();
            self.buffer.push(b' ');
            if !self.append_line().map_err(|problem| Misplaced { problem, line })? {
                break;
            }
        }
        let text = str::from_utf8(&self.buffer).map_err(|_| Misplaced { problem: ObjProblem::Binary, line })?;
        Ok(Some(Statement { keyword, text: &text.trim_start()[1..], line }))
    }

    /// Appends the next line without its end to the buffer; `false` at the end of the file.
    fn append_line(&mut self) -> Result<bool, ObjProblem> {
        let mut any = false;
        loop {
            let chunk = match self.source.fill_buf() {
                Ok(chunk) => chunk,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                Err(cause) => return Err(ObjProblem::Unreadable { cause }),
            };
            if chunk.is_empty() {
                break;
            }
            any = true;
            let end = chunk.iter().position(|byte| *byte == b'\n');
            let part = &chunk[..end.unwrap_or(chunk.len())];
            if part.contains(&0) {
                return Err(ObjProblem::Binary);
            }
            if self.buffer.len() + part.len() > LINE_BYTES_MAX {
                return Err(ObjProblem::LineTooLong);
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

/// Returns the keyword of a line that is read, `None` for one that is passed over.
fn keyword(line: &[u8]) -> Result<Option<Keyword>, ObjProblem> {
    let line = line.trim_ascii_start();
    let end = line.iter().position(u8::is_ascii_whitespace).unwrap_or(line.len());
    match line.get(..end) {
        Some(b"v" | b"v\\") => Ok(Some(Keyword::Vertex)),
        Some(b"f" | b"f\\") => Ok(Some(Keyword::Face)),
        // Comments and names may be in any encoding; a keyword is ASCII in every text file.
        Some([b'#', ..]) => Ok(None),
        Some(word) if word.iter().all(|byte| byte.is_ascii_graphic()) => Ok(None),
        _ => Err(ObjProblem::Binary),
    }
}
