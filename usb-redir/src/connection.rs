//! Reading and writing packets.

use std::io::{self, ErrorKind, Read, Write};
use std::os::unix::net::UnixStream;
use std::time::Duration;

use crate::packet::{Packet, capabilities, capability, hello, kind};

/// Longest content that is taken: QEMU sends at most a control transfer's 64 KiB.
const CONTENT_MAXIMUM: usize = 1 << 17;
/// Longest time until QEMU has said what it can do.
const HELLO_LIMIT: Duration = Duration::from_secs(10);
/// Longest time that QEMU may take no byte.
const WRITE_LIMIT: Duration = Duration::from_secs(10);

/// A connection to QEMU, both sides known to each other.
pub struct Connection {
    stream: UnixStream,
    /// What came in, and is not a whole packet yet.
    received: Vec<u8>,
    /// What both sides can do.
    shared: u32,
}

impl Connection {
    /// Says HELLO and waits for QEMU's.
    ///
    /// # Errors
    /// When it does not come, or the other side speaks another protocol.
    pub fn open(stream: UnixStream) -> io::Result<Self> {
        stream.set_nonblocking(false)?;
        stream.set_write_timeout(Some(WRITE_LIMIT))?;
        let mut connection = Self { stream, received: Vec::new(), shared: 0 };
        connection.send(kind::HELLO, 0, &hello())?;
        let Some(packet) = connection.receive(HELLO_LIMIT)? else {
            return Err(wrong(format!(
                "nobody said hello within {} s: is it QEMU's usb-redir?",
                HELLO_LIMIT.as_secs()
            )));
        };
        if packet.kind != kind::HELLO {
            return Err(wrong(format!("a packet of kind {} came before hello: is it QEMU's usb-redir?", packet.kind)));
        }
        connection.shared = capabilities(&packet).map_err(wrong)? & capability::OURS;
        Ok(connection)
    }

    /// Returns whether both sides have a capability.
    pub fn can(&self, capability: u32) -> bool {
        self.shared & capability != 0
    }

    /// Sends a packet.
    ///
    /// # Errors
    /// When QEMU has gone, or takes nothing.
    pub fn send(&mut self, kind: u32, id: u64, content: &[u8]) -> io::Result<()> {
        let mut bytes = [kind.to_le_bytes(), (content.len() as u32).to_le_bytes()].concat();
        bytes.extend_from_slice(&id.to_le_bytes()[..self.id_bytes()]);
        bytes.extend_from_slice(content);
        self.stream.write_all(&bytes)
    }

    /// Returns the next packet; `None` when none has come within `limit`.
    ///
    /// # Errors
    /// When QEMU has gone, or sends nonsense.
    pub fn receive(&mut self, limit: Duration) -> io::Result<Option<Packet>> {
        // A limit of nothing would be no limit.
        self.stream.set_read_timeout(Some(limit.max(Duration::from_micros(1))))?;
        loop {
            if let Some(packet) = self.take_packet()? {
                return Ok(Some(packet));
            }
            let mut bytes = [0; 4_096];
            match self.stream.read(&mut bytes) {
                Ok(0) => return Err(ErrorKind::UnexpectedEof.into()),
                Ok(count) => self.received.extend_from_slice(&bytes[..count]),
                Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => return Ok(None),
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
    }

    /// Takes a whole packet out of what came in.
    fn take_packet(&mut self) -> io::Result<Option<Packet>> {
        let head = 8 + self.id_bytes();
        let Some((&[k0, k1, k2, k3, l0, l1, l2, l3], rest)) = self.received.split_first_chunk() else {
            return Ok(None);
        };
        let (kind, length) = (u32::from_le_bytes([k0, k1, k2, k3]), u32::from_le_bytes([l0, l1, l2, l3]) as usize);
        if length > CONTENT_MAXIMUM {
            return Err(wrong(format!("a packet of kind {kind} with {length} bytes: is it QEMU's usb-redir?")));
        }
        if self.received.len() < head + length {
            return Ok(None);
        }
        let mut id = [0; 8];
        id[..head - 8].copy_from_slice(&rest[..head - 8]);
        let content = self.received[head..head + length].to_vec();
        self.received.drain(..head + length);
        Ok(Some(Packet { kind, id: u64::from_le_bytes(id), content }))
    }

    fn id_bytes(&self) -> usize {
        if self.can(capability::LONG_IDS) { 8 } else { 4 }
    }
}

/// An error about what came in.
pub fn wrong(text: String) -> io::Error {
    io::Error::new(ErrorKind::InvalidData, text)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Opens a connection to a side that says `first`; returns its end, too.
    fn open(first: &[u8]) -> (io::Result<Connection>, UnixStream) {
        let (here, mut there) = UnixStream::pair().expect("sockets");
        there.write_all(first).expect("room");
        (Connection::open(here), there)
    }

    fn hello_with(capabilities: u32) -> Vec<u8> {
        [&0_u32.to_le_bytes()[..], &68_u32.to_le_bytes(), &[0; 4], &[b'q'; 64], &capabilities.to_le_bytes()].concat()
    }

    #[test]
    fn ids_are_as_long_as_both_sides_can() {
        for (capabilities, id_bytes) in [(0xFF, 8), (0xFF ^ capability::LONG_IDS, 4)] {
            let (connection, mut there) = open(&hello_with(capabilities));
            let mut connection = connection.expect("a good hello");
            let mut bytes = [0; 12 + 68];
            there.read_exact(&mut bytes).expect("our hello, with a short id");
            connection.send(kind::RESET, 0x1_0000_0002, &[9]).expect("it is read");
            let mut bytes = vec![0; 8 + id_bytes + 1];
            there.read_exact(&mut bytes).expect("a packet");
            assert_eq!(bytes[..12], [3, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0]);
            assert_eq!(bytes.last(), Some(&9));
        }
    }

    #[test]
    fn a_packet_in_pieces_is_put_together() {
        let (connection, mut there) = open(&hello_with(0xFF));
        let mut connection = connection.expect("a good hello");
        let bytes = [&100_u32.to_le_bytes()[..], &2_u32.to_le_bytes(), &7_u64.to_le_bytes(), &[1, 2]].concat();
        let moment = Duration::from_millis(5);
        for byte in &bytes[..bytes.len() - 1] {
            there.write_all(&[*byte]).expect("it is read");
            assert_eq!(connection.receive(moment).expect("no end"), None);
        }
        there.write_all(&[2, 0xFF]).expect("it is read");
        let packet = connection.receive(moment).expect("no end");
        assert_eq!(packet, Some(Packet { kind: 100, id: 7, content: vec![1, 2] }));
        there.shutdown(std::net::Shutdown::Write).expect("it is open");
        assert_eq!(connection.receive(moment).expect_err("the end").kind(), ErrorKind::UnexpectedEof);
    }

    #[test]
    fn another_protocol_is_named() {
        for (first, expected) in [
            (&b"GET / HTTP/1.1\r\n\r\n"[..], "with 1414012975 bytes"),
            (&[&3_u32.to_le_bytes()[..], &[0; 8]].concat(), "a packet of kind 3 came before hello"),
            (&[&0_u32.to_le_bytes()[..], &2_u32.to_le_bytes(), &[0; 6]].concat(), "has 2 bytes, at least 64 expected"),
        ] {
            let error = open(first).0.err().expect("no usbredir").to_string();
            assert!(error.contains(expected), "{error}");
        }
    }
}
