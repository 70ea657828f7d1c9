//! Files of packet words: 32 bits each, little-endian, as `render --dump` writes them.

pub mod json;

use std::fmt;
use std::path::Path;

use anyhow::Context;
use fpga_regs::packet::{BadPacket, Header, Packet};

/// What a file of words holds.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WordFile {
    /// The whole words.
    pub words: Vec<u32>,
    /// Bytes behind the last whole word, 0…3.
    pub spare_bytes: usize,
}

impl WordFile {
    /// Reads a file.
    ///
    /// # Errors
    /// When it cannot be read. That it is truncated is for [`check_end`](Self::check_end) to say.
    pub fn read(path: &Path) -> anyhow::Result<Self> {
        let bytes = std::fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
        Ok(Self::from_bytes(&bytes))
    }

    /// Takes bytes apart into words.
    pub fn from_bytes(bytes: &[u8]) -> Self {
        let (words, spare) = bytes.as_chunks::<4>();
        Self { words: words.iter().map(|word| u32::from_le_bytes(*word)).collect(), spare_bytes: spare.len() }
    }

    /// Goes through the packets that are whole, bad ones among them.
    pub fn entries(&self) -> Entries<'_> {
        Entries { words: &self.words, next: 0 }
    }

    /// Checks that the stream ends behind a packet.
    ///
    /// # Errors
    /// [`Truncated`] when it ends inside a packet or inside a word.
    pub fn check_end(&self) -> Result<(), Truncated> {
        let mut entries = self.entries();
        entries.by_ref().for_each(drop);
        let start = entries.next;
        let header = self.words.get(start).copied().map(Header);
        if header.is_none() && self.spare_bytes == 0 {
            return Ok(());
        }
        let words = self.words.len() - start;
        Err(Truncated { word: start, header, words, spare_bytes: self.spare_bytes })
    }
}

/// A packet of a stream.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Entry {
    /// Where its header stands, in words from the stream's start.
    pub word: usize,
    /// Its words, the header among them.
    pub length: usize,
    /// Its header.
    pub header: Header,
    /// What it is, or why it is bad.
    pub packet: Result<Packet, BadPacket>,
}

/// Goes through a stream's packets; ends at the first that is not whole.
pub struct Entries<'a> {
    words: &'a [u32],
    next: usize,
}

impl Iterator for Entries<'_> {
    type Item = Entry;

    fn next(&mut self) -> Option<Entry> {
        let word = self.next;
        let header = Header(*self.words.get(word)?);
        let length = 1 + usize::from(header.length());
        let payload = self.words.get(word + 1..word + length)?;
        self.next += length;
        Some(Entry { word, length, header, packet: Packet::decode(header, payload) })
    }
}

/// A stream that ends inside a packet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Truncated {
    /// Where the packet's header stands, or should.
    pub word: usize,
    /// The header, if it is there.
    pub header: Option<Header>,
    /// The packet's words that are there, the header among them.
    pub words: usize,
    /// Bytes of the next word that are there, 0…3.
    pub spare_bytes: usize,
}

impl fmt::Display for Truncated {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { word, header, words, spare_bytes } = *self;
        match header {
            Some(header) => {
                let whole = 1 + usize::from(header.length());
                write!(
                    out,
                    "the stream ends inside the {} packet at word {word}: {} of its {whole} words missing",
                    kind_name(header),
                    whole - words
                )?;
            }
            None => write!(out, "the stream ends inside word {word}, a packet's header: 1 word missing")?,
        }
        if spare_bytes > 0 {
            write!(out, " (of the first of them {spare_bytes} of 4 bytes are there)")?;
        }
        out.write_str("; write the file again, whole")
    }
}

impl std::error::Error for Truncated {}

/// Returns a packet kind's name in lower case, or `bad` with why.
pub fn kind_name(header: Header) -> String {
    match header.check() {
        Ok(kind) => kind.info().name.to_lowercase(),
        Err(bad) => format!("bad ({bad}: header {:#010x})", header.0),
    }
}

/// Returns words as the bytes of a file.
pub fn to_bytes(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use fpga_regs::packet::{Clear, Fence, swap};
    use fpga_regs::screen::Rgb332;

    fn good() -> Vec<u32> {
        let clear = Clear { colour: Rgb332(0x1c), depth: 7 }.encode();
        [&clear[..], &swap(), &Fence { tag: 9 }.encode()].concat()
    }

    #[test]
    fn packets_come_with_their_places() {
        let mut words = good();
        words.splice(2..2, [0x7f02_0000, 1, 2]);
        let file = WordFile::from_bytes(&to_bytes(&words));
        let places: Vec<_> = file.entries().map(|entry| (entry.word, entry.length, entry.packet.is_ok())).collect();
        assert_eq!(places, [(0, 2, true), (2, 3, false), (5, 1, true), (6, 2, true)]);
        assert_eq!(file.check_end(), Ok(()));
        assert_eq!(WordFile::from_bytes(&[]).check_end(), Ok(()));
    }

    #[test]
    fn every_cut_is_told_with_word_kind_and_what_is_missing() {
        let bytes = to_bytes(&good());
        let message = |length: usize| WordFile::from_bytes(&bytes[..length]).check_end().map_err(|it| it.to_string());
        let expected = "the stream ends inside the fence packet at word 3: 1 of its 2 words missing";
        assert_eq!(message(16), Err(format!("{expected}; write the file again, whole")));
        let expected = format!("{expected} (of the first of them 3 of 4 bytes are there); write the file again, whole");
        assert_eq!(message(19), Err(expected));
        assert!(message(14).expect_err("a cut header").starts_with("the stream ends inside word 3, a packet's header"));
        for length in 0..=bytes.len() {
            assert_eq!(message(length).is_ok(), [0, 8, 12, 20].contains(&length), "{length}");
        }
        let cut_bad = WordFile::from_bytes(&to_bytes(&[0x7f02_0000, 1])).check_end().expect_err("cut").to_string();
        assert!(cut_bad.contains("bad (unknown packet kind: header 0x7f020000) packet at word 0"), "{cut_bad}");
    }
}
