//! What the area was measured of: a checksum of the sources, without what synthesis does not see.

use std::fs;

use anyhow::{Context, ensure};
use crc::{CRC_64_XZ, Crc};

use crate::paths::workspace_root;

/// The design's list of files, and Yosys' rules for memories.
const LIST: &str = "rtl/files.f";
const RULES: &str = "rtl/area/m10k.txt";

/// Returns the sources' checksum, as 16 hexadecimal digits. Comments and white space do not count.
///
/// # Errors
/// When a source cannot be read, or none is listed.
pub fn checksum() -> anyhow::Result<String> {
    let root = workspace_root();
    let read = |path: &str| fs::read_to_string(root.join(path)).with_context(|| format!("cannot read {path}"));
    let list = without_lines(&read(LIST)?, "//");
    ensure!(list.lines().next().is_some(), "{LIST} lists no sources");
    let mut texts = vec![list.clone(), without_lines(&read(RULES)?, "#")];
    for name in list.lines() {
        texts.push(bare(&read(&format!("rtl/{name}"))?));
    }
    Ok(digest(&texts))
}

fn digest(texts: &[String]) -> String {
    let crc = Crc::<u64>::new(&CRC_64_XZ);
    let mut digest = crc.digest();
    for text in texts {
        digest.update(text.as_bytes());
        // So that nothing can move from one file to the next unseen.
        digest.update(&[0]);
    }
    format!("{:016x}", digest.finalize())
}

/// Returns the lines that say something: trimmed, not empty, and not begun by a comment's mark.
fn without_lines(text: &str, comment: &str) -> String {
    let lines = text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with(comment));
    lines.map(|line| format!("{line}\n")).collect()
}

/// Returns SystemVerilog without its comments and white space, but for those in strings.
fn bare(text: &str) -> String {
    let mut bare = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(next) = rest.chars().next() {
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or(rest.len(), |end| end + 2)
        } else if next == '"' {
            let length = rest[1..].find('"').map_or(rest.len(), |end| end + 2);
            bare.push_str(&rest[..length]);
            length
        } else {
            if !next.is_whitespace() {
                bare.push(next);
            }
            next.len_utf8()
        };
        rest = &rest[length..];
    }
    bare
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_and_white_space_do_not_count_and_all_else_does() {
        let plain = bare("assign a = b;\n");
        assert_eq!(plain, "assigna=b;");
        assert_eq!(bare("// Why.\n  assign  a = b;  // Because /* or not.\n"), plain);
        assert_eq!(bare("assign a /* all\nof // it */ = b;"), plain);
        assert_ne!(bare("assign a = c;"), plain);
        assert_eq!(bare(r#"(* a = "-name  // B" *) logic c;"#), r#"(*a="-name  // B"*)logicc;"#);
        assert_eq!(bare("a // without an end"), "a");
    }

    #[test]
    fn a_list_is_its_entries_in_order() {
        assert_eq!(without_lines("// Packages first.\n\n a.sv\nb.sv\n", "//"), "a.sv\nb.sv\n");
        assert_ne!(without_lines("b.sv\na.sv", "//"), without_lines("a.sv\nb.sv", "//"));
    }

    #[test]
    fn what_moves_from_one_file_to_the_next_counts() {
        let of = |texts: [&str; 2]| digest(&texts.map(str::to_owned));
        assert_ne!(of(["ab", "c"]), of(["a", "bc"]));
        assert_eq!(of(["ab", "c"]), of(["ab", "c"]));
    }
}
