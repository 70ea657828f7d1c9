//! Words in, packets out.

use fpga_regs::packet::{BadPacket, Header, Packet};

/// Where a stream stands that ended inside a packet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MidPacket {
    /// The packet's header; [`Header::check`] gives its kind, or why its words are being skipped.
    pub header: Header,
    /// Words that have not come yet, 1…255.
    pub missing: usize,
}

impl MidPacket {
    /// Returns how many of the packet's words have come, the header among them: 1…255.
    pub fn taken(self) -> usize {
        1 + usize::from(self.header.length()) - self.missing
    }
}

/// A decoder that takes words as they come, in pieces of any size.
#[derive(Debug, Default)]
pub(crate) struct Decoder {
    header: Header,
    /// Words of the packet under way that have not come yet; 0 between packets.
    missing: usize,
    /// Whether the packet under way has a bad header, so that its words are not kept.
    skipping: bool,
    payload: [u32; Packet::MAX_WORDS - 1],
}

impl Decoder {
    /// Takes words off the front of `words` up to the next packet, good or bad.
    ///
    /// Returns a packet, or what is wrong with one: for a fault in the header as soon as the
    /// header has come (the words behind it are skipped by later calls), otherwise with the
    /// packet's last word. Returns `None` when `words` is used up.
    pub(crate) fn take(&mut self, words: &mut &[u32]) -> Option<Result<Packet, BadPacket>> {
        loop {
            if self.missing == 0 {
                let (header, rest) = words.split_first()?;
                *words = rest;
                self.header = Header(*header);
                self.missing = usize::from(self.header.length());
                let checked = self.header.check();
                self.skipping = checked.is_err();
                if let Err(bad) = checked {
                    return Some(Err(bad));
                }
            }
            let length = usize::from(self.header.length());
            let (now, rest) = words.split_at(words.len().min(self.missing));
            *words = rest;
            if !self.skipping {
                self.payload[length - self.missing..][..now.len()].copy_from_slice(now);
            }
            self.missing -= now.len();
            if self.missing > 0 {
                return None;
            }
            if !self.skipping {
                return Some(Packet::decode(self.header, &self.payload[..length]));
            }
        }
    }

    /// Returns where the stream stands inside a packet, or `None` between packets.
    pub(crate) fn mid_packet(&self) -> Option<MidPacket> {
        (self.missing > 0).then_some(MidPacket { header: self.header, missing: self.missing })
    }
}
