//! The little of SystemVerilog that the other checks need: modules, their ports and instances.

use std::fs;
use std::ops::Range;
use std::path::Path;

use anyhow::Context;

use super::Place;

/// A SystemVerilog file without comments and strings, line for line.
#[derive(Debug, Clone)]
pub(super) struct Source {
    /// Where it lies in the workspace.
    pub path: String,
    /// Its text, with blanks where comments and strings were.
    pub text: String,
}

/// Which way a port goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Direction {
    Input,
    Output,
    Bidirectional,
}

/// A port of a module.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Port {
    pub place: Place,
    pub name: String,
    pub direction: Direction,
    /// Number of bits, and whether it has an index; nothing where the width is not a plain number.
    pub width: Option<u32>,
    pub vector: bool,
}

/// Where a module's parameters, if it has any, and its ports are in the text, without their parentheses.
#[derive(Debug, Clone)]
pub(super) struct Header {
    pub parameters: Option<Range<usize>>,
    pub ports: Range<usize>,
}

impl Source {
    /// Reads a file.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn read(root: &Path, path: &str) -> anyhow::Result<Self> {
        let text = fs::read_to_string(root.join(path)).with_context(|| format!("cannot read {path}"))?;
        Ok(Self::new(path, &text))
    }

    /// Takes a file's text.
    pub fn new(path: &str, text: &str) -> Self {
        Self { path: path.to_owned(), text: blank_comments(text) }
    }

    /// Returns the place of a byte of the text.
    pub fn place(&self, at: usize) -> Place {
        Place::new(self.path.clone(), self.text[..at].matches('\n').count() + 1)
    }

    /// Returns the name of the module, if the file has one.
    pub fn module(&self) -> Option<&str> {
        let after = &self.text[self.find_word("module", 0)? + "module".len()..];
        Some(word_at(after.trim_start()))
    }

    /// Returns what is between a module's name and its body.
    pub fn header(&self) -> Option<Header> {
        let mut at = self.find_word("module", 0)?;
        let mut parameters = None;
        loop {
            let open = at + self.text[at..].find(['(', ';'])?;
            if self.text.as_bytes()[open] == b';' {
                // Nothing but imports stands between a module's name and its parentheses.
                if !self.text[at..open].contains("import") {
                    return None;
                }
                at = open + 1;
                continue;
            }
            let close = closing(&self.text, open)?;
            let is_parameters = self.text[..open].trim_end().ends_with('#');
            if !is_parameters {
                return Some(Header { parameters, ports: open + 1..close });
            }
            parameters = Some(open + 1..close);
            at = close + 1;
        }
    }

    /// Returns the module's ports, in order.
    pub fn ports(&self) -> Vec<Port> {
        let Some(header) = self.header() else { return Vec::new() };
        let mut ports = Vec::new();
        let mut at = header.ports.start;
        for item in split_commas(&self.text[header.ports]) {
            let start = at + (item.len() - item.trim_start().len());
            at += item.len() + 1;
            let words: Vec<&str> = item.split_whitespace().collect();
            let direction = match words.first() {
                Some(&"input") => Direction::Input,
                Some(&"output") => Direction::Output,
                Some(&"inout") => Direction::Bidirectional,
                _ => continue,
            };
            let name = words.last().copied().unwrap_or_default().to_owned();
            let range = item.find('[').and_then(|open| Some(&item[open + 1..open + item[open..].find(']')?]));
            let plain = words[1..words.len() - 1]
                .iter()
                .all(|word| word.starts_with('[') || word.ends_with(']') || ["logic", "wire"].contains(word));
            let width = match range {
                _ if !plain || item.matches('[').count() > 1 => None,
                None => Some(1),
                Some(range) => range.split_once(':').and_then(|(high, low)| {
                    let (high, low): (u32, u32) = (high.trim().parse().ok()?, low.trim().parse().ok()?);
                    Some(high - low + 1)
                }),
            };
            ports.push(Port { place: self.place(start), name, direction, width, vector: range.is_some() });
        }
        ports
    }

    /// Returns the names that `module` is instantiated by, each with its place.
    pub fn instances(&self, module: &str) -> Vec<(String, Place)> {
        let mut found = Vec::new();
        let mut at = 0;
        while let Some(start) = self.find_word(module, at) {
            at = start + module.len();
            let mut rest = self.text[at..].trim_start();
            if let Some(after) = rest.strip_prefix('#') {
                let open = self.text.len() - after.len() + after.find('(').unwrap_or(0);
                let Some(close) = closing(&self.text, open) else { continue };
                rest = self.text[close + 1..].trim_start();
            }
            let name = word_at(rest);
            if !name.is_empty() && rest[name.len()..].trim_start().starts_with('(') && name != "begin" {
                found.push((name.to_owned(), self.place(start)));
            }
        }
        found
    }

    /// Returns whether a flip-flop of that name is clocked here.
    pub fn has_register(&self, name: &str) -> bool {
        let mut at = 0;
        while let Some(start) = self.find_word(name, at) {
            at = start + name.len();
            if self.text[at..].trim_start().starts_with("<=") {
                return true;
            }
        }
        false
    }

    /// Returns where a word begins, from a place on.
    pub fn find_word(&self, word: &str, from: usize) -> Option<usize> {
        let mut at = from;
        loop {
            let start = at + self.text[at..].find(word)?;
            let free = |character: Option<char>| !character.is_some_and(is_word);
            if free(self.text[..start].chars().next_back()) && free(self.text[start + word.len()..].chars().next()) {
                return Some(start);
            }
            at = start + word.len();
        }
    }
}

fn is_word(character: char) -> bool {
    character.is_ascii_alphanumeric() || character == '_' || character == '$' || character == '`'
}

fn word_at(text: &str) -> &str {
    &text[..text.find(|character| !is_word(character)).unwrap_or(text.len())]
}

/// Returns the parenthesis that closes the one at `open`.
fn closing(text: &str, open: usize) -> Option<usize> {
    let mut depth = 0;
    for (offset, byte) in text.as_bytes()[open..].iter().enumerate() {
        match byte {
            b'(' => depth += 1,
            b')' if depth == 1 => return Some(open + offset),
            b')' => depth -= 1,
            _ => {}
        }
    }
    None
}

/// Splits at the commas outside of any brackets.
fn split_commas(text: &str) -> Vec<&str> {
    let (mut depth, mut start, mut parts) = (0, 0, Vec::new());
    for (at, character) in text.char_indices() {
        match character {
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(&text[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    parts.push(&text[start..]);
    parts
}

/// Returns the text with blanks for comments and strings, so that places stay what they are.
fn blank_comments(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while !rest.is_empty() {
        let skip = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or(rest.len(), |end| end + 2)
        } else if let Some(inside) = rest.strip_prefix('"') {
            inside.find('"').map_or(rest.len(), |end| end + 2)
        } else {
            0
        };
        let (blanked, kept) = rest.split_at(skip);
        out.extend(blanked.bytes().map(|byte| if byte == b'\n' { '\n' } else { ' ' }));
        let Some(next) = kept.chars().next() else { break };
        if skip == 0 {
            out.push(if next.is_ascii() { next } else { '?' });
            rest = &kept[next.len_utf8()..];
        } else {
            rest = kept;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "// module wrong (input logic a);
module right #(
    parameter int unsigned Width = f(8)
) (
    input  logic             clk_i,
    input  wire  [3:0]       keys, // input logic comment,
    output logic [Width-1:0] wide_o,
    inout  wire  [31:0]      pins,
    input  some_pkg::word_t  word_i
);
  synchronizer #(.Width(2)) u_first (.clk_i);
  synchronizer u_second (
      .clk_i
  );
  always_ff @(posedge clk_i) first_q <= \"synchronizer u_third (\";
endmodule
";

    #[test]
    fn ports_are_read_with_direction_width_and_line() {
        let source = Source::new("a.sv", TEXT);
        assert_eq!(source.module(), Some("right"));
        let ports = source.ports();
        let short: Vec<_> = ports.iter().map(|port| (port.name.as_str(), port.width, port.place.line)).collect();
        let expected = [
            ("clk_i", Some(1), 5),
            ("keys", Some(4), 6),
            ("wide_o", None, 7),
            ("pins", Some(32), 8),
            ("word_i", None, 9),
        ];
        assert_eq!(short, expected);
        assert_eq!((ports[3].direction, ports[0].vector, ports[1].vector), (Direction::Bidirectional, false, true));
    }

    #[test]
    fn instances_and_registers_are_found_outside_of_comments_and_strings() {
        let source = Source::new("a.sv", TEXT);
        let names: Vec<_> =
            source.instances("synchronizer").into_iter().map(|(name, place)| (name, place.line)).collect();
        assert_eq!(names, [("u_first".to_owned(), 11), ("u_second".to_owned(), 12)]);
        assert!(source.has_register("first_q") && !source.has_register("second_q"));
    }
}
