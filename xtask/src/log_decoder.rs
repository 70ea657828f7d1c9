//! Turns the firmware's defmt log, bytes that only its ELF file explains, into lines of text.

use std::fs;
use std::io::Read;
use std::path::Path;
use std::thread::{self, JoinHandle};

use anyhow::{Context, ensure};
use defmt_decoder::{DecodeError, Frame, StreamDecoder, Table};

/// What a log had in it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LogSummary {
    /// Frames that became a line.
    pub frames: u64,
    /// Frames that could not be read and were skipped.
    pub malformed: u64,
}

/// A thread that decodes a log until its stream ends.
pub struct LogDecoder {
    thread: JoinHandle<LogSummary>,
}

impl LogDecoder {
    /// Starts to decode `stream`, the log of the firmware in the ELF file `elf`; `show` gets every line.
    ///
    /// A frame that is damaged is skipped; the first such is told in a line. Firmware without
    /// defmt gives a line that says so, and its bytes are still read, so that it never waits.
    ///
    /// # Errors
    ///
    /// When the ELF file cannot be read, or its defmt speaks another version than this program.
    pub fn start(
        elf: &Path,
        stream: impl Read + Send + 'static,
        show: impl FnMut(&str) + Send + 'static,
    ) -> anyhow::Result<Self> {
        let bytes = fs::read(elf).with_context(|| format!("cannot read {}", elf.display()))?;
        let table =
            Table::parse(&bytes).with_context(|| format!("the defmt log table of {} cannot be used", elf.display()))?;
        if let Some(table) = &table {
            ensure!(
                table.encoding().can_recover(),
                "{} logs without framing: take defmt's feature `encoding-raw` out of the firmware",
                elf.display()
            );
        }
        let thread =
            thread::Builder::new().name("defmt log".into()).spawn(move || read_log(table.as_ref(), stream, show))?;
        Ok(Self { thread })
    }

    /// Waits until the stream ends (QEMU has stopped) and returns what it held.
    pub fn finish(self) -> LogSummary {
        self.thread.join().unwrap_or_default()
    }
}

fn read_log(table: Option<&Table>, mut stream: impl Read, mut show: impl FnMut(&str)) -> LogSummary {
    let mut summary = LogSummary::default();
    let mut decoder = table.map(Table::new_stream_decoder);
    if decoder.is_none() {
        show("(this firmware has no defmt log)");
    }
    let mut bytes = [0; 4_096];
    while let Ok(count @ 1..) = stream.read(&mut bytes) {
        if let Some(decoder) = &mut decoder {
            decoder.received(&bytes[..count]);
            decode_received(decoder.as_mut(), &mut summary, &mut show);
        }
    }
    summary
}

/// Shows every frame that is complete.
fn decode_received(decoder: &mut dyn StreamDecoder, summary: &mut LogSummary, show: &mut impl FnMut(&str)) {
    loop {
        match decoder.decode() {
            Ok(frame) => {
                summary.frames += 1;
                show(&line(&frame));
            }
            Err(DecodeError::UnexpectedEof) => return,
            Err(DecodeError::Malformed) => {
                summary.malformed += 1;
                if summary.malformed == 1 {
                    show(
                        "(a damaged log frame was skipped, and later ones will be: does the ELF file belong to this firmware?)",
                    );
                }
            }
        }
    }
}

/// Returns `timestamp LEVEL message` with what the frame has of them.
fn line(frame: &Frame<'_>) -> String {
    let mut line = String::new();
    if let Some(timestamp) = frame.display_timestamp() {
        line = format!("{timestamp} ");
    }
    if let Some(level) = frame.level() {
        line += &format!("{:<5} ", level.as_str().to_uppercase());
    }
    line + &frame.display_message().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_elf::{TestElf, TestFile};
    use std::io::Cursor;
    use std::sync::mpsc;

    fn lines_of(elf: &TestElf, log: &'static [u8]) -> (Vec<String>, LogSummary) {
        let file = TestFile::new("log.elf", &elf.bytes());
        let (sender, receiver) = mpsc::channel();
        let decoder = LogDecoder::start(file.path(), Cursor::new(log), move |line| {
            sender.send(line.to_string()).expect("the test listens");
        });
        let summary = decoder.expect("a good ELF file").finish();
        (receiver.iter().collect(), summary)
    }

    fn logging_elf() -> TestElf {
        let symbol = |tag: &str, data: &str| {
            format!(r#"{{"package":"p","tag":"defmt_{tag}","data":"{data}","disambiguator":"1","crate_name":"c"}}"#)
        };
        let mut elf = TestElf::new(&[]);
        elf.defmt_symbol("_defmt_version_ = 4", 0);
        elf.defmt_symbol("_defmt_encoding_ = rzcobs", 0);
        elf.defmt_symbol(&symbol("info", "drew {=u8} triangles"), 2);
        elf.defmt_symbol(&symbol("println", "plain"), 3);
        elf
    }

    #[test]
    fn frames_become_lines_and_damage_is_told_once() {
        let good = rzcobs(&[2, 0, 7]);
        let plain = rzcobs(&[3, 0]);
        let wrong_index = rzcobs(&[99, 0]);
        let log = [&good[..], &[0], &wrong_index, &[0, 0x80, 0x81, 0], &plain, &[0], &good[..1]].concat();
        let (lines, summary) = lines_of(&logging_elf(), Box::leak(log.into_boxed_slice()));
        assert_eq!(lines.len(), 3, "{lines:?}");
        assert_eq!(lines[0], "INFO  drew 7 triangles");
        assert!(lines[1].starts_with("(a damaged log frame was skipped"), "{lines:?}");
        assert_eq!(lines[2], "plain");
        assert_eq!(summary, LogSummary { frames: 2, malformed: 2 });
    }

    #[test]
    fn firmware_without_a_log_is_told_and_its_bytes_are_read() {
        let (lines, summary) = lines_of(&TestElf::new(&[]), b"abc");
        assert_eq!(lines, ["(this firmware has no defmt log)"]);
        assert_eq!(summary, LogSummary::default());
    }

    #[test]
    fn another_version_is_refused() {
        let mut elf = TestElf::new(&[]);
        elf.defmt_symbol("_defmt_version_ = 99", 0);
        let file = TestFile::new("version.elf", &elf.bytes());
        let error = LogDecoder::start(file.path(), Cursor::new(b""), |_| {}).err().expect("version 99");
        assert!(format!("{error:#}").contains("version mismatch"), "{error:#}");
    }

    /// Encodes a frame shorter than 7 bytes as the rzCOBS of the `rzcobs` crate does.
    fn rzcobs(frame: &[u8]) -> Vec<u8> {
        let mut run = 0;
        let mut zeros = 0_u8;
        let mut output = Vec::new();
        for byte in frame {
            if *byte == 0 {
                zeros |= 1 << run;
            } else {
                output.push(*byte);
            }
            run += 1;
        }
        assert!(run < 7);
        // The encoder ends a short run by marking the bytes that are not there as zero.
        output.push((zeros | (0xff << run)) & 0x7f);
        output
    }
}
