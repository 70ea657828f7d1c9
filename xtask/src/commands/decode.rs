//! `cargo xtask decode`: prints a file of packet words as text.

use std::io::{self, BufWriter, ErrorKind, Write};

use crate::cli::DecodeArguments;
use crate::stream::WordFile;
use crate::stream::json::Line;

/// Prints a line of JSON for every packet.
///
/// # Errors
///
/// When the file cannot be read, or ends inside a packet: after the lines of all that are whole.
pub fn run(arguments: &DecodeArguments) -> anyhow::Result<()> {
    let file = WordFile::read(&arguments.words)?;
    match print(&file) {
        // Whoever read the lines has read enough: `decode … | head`.
        Err(error) if error.kind() == ErrorKind::BrokenPipe => return Ok(()),
        result => result?,
    }
    file.check_end().map_err(|truncated| anyhow::anyhow!("{}: {truncated}", arguments.words.display()))
}

fn print(file: &WordFile) -> io::Result<()> {
    let mut output = BufWriter::new(io::stdout().lock());
    for entry in file.entries() {
        serde_json::to_writer(&mut output, &Line::from(&entry))?;
        output.write_all(b"\n")?;
    }
    output.flush()
}
