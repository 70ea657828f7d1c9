//! Messages between a board and a PC over the second serial line.
//!
//! They travel in the frames of [`controls::serial`], so that lost bytes cost a message and no
//! more. Kinds 0x01…0x03 are controllers' reports and belong to `controls`; these are the
//! application's own. Payloads are `postcard`'s encoding.

use controls::serial::{self, EncodeError, FRAME_SIZE_MAXIMUM, PAYLOAD_MAXIMUM, kind};
use serde::{Deserialize, Serialize};

use crate::intake::Tally;

/// Frame kind of a [`HostMessage`].
pub const HOST_MESSAGE: u8 = kind::APPLICATION;
/// Frame kind of a [`BoardMessage`].
pub const BOARD_MESSAGE: u8 = kind::APPLICATION + 1;

/// What a PC asks of a board.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum HostMessage {
    /// Answer with [`BoardMessage::Hello`].
    Identify,
    /// Forget everything that controllers said, start the scene of this number afresh, and from
    /// now on draw a frame only at [`Step`](Self::Step). So a session repeats exactly.
    Begin {
        /// Index into [`Scene::ALL`](crate::scene::Scene::ALL); one too large is the last.
        scene: u8,
    },
    /// Draw a frame from what the controllers have said, and answer with
    /// [`BoardMessage::Frame`] once it shows.
    Step,
    /// Run freely again.
    Run,
    /// Commit a fault, so that its report can be seen; only firmware that was built with the feature
    /// `fault-injection` does.
    Fault(Fault),
    /// Answer with [`BoardMessage::Status`].
    Ask,
    /// Show another scene from its beginning, or in another style, and go on; numbers that there are not change
    /// nothing and are told on the console. A scene begins in its own style.
    Show {
        /// Index into [`Scene::ALL`](crate::scene::Scene::ALL).
        scene: Option<u8>,
        /// Index into [`Style::ALL`](crate::style::Style::ALL).
        style: Option<u8>,
    },
}

/// A fault on purpose.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Fault {
    /// A write to an address that nothing is mapped to.
    DataAbort,
    /// A jump to one.
    PrefetchAbort,
    /// A write to the program's own code.
    WriteToCode,
    /// An instruction that does not exist.
    UndefinedInstruction,
    /// A recursion without end.
    StackOverflow,
    /// A panic.
    Panic,
}

/// What a board tells a PC.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum BoardMessage {
    /// Who it is.
    Hello {
        /// Ticks of [`FrameReport`]'s durations in a second.
        ticks_per_second: u32,
        /// How many scenes there are.
        scenes: u8,
    },
    /// A session begins; the reports that follow count for it.
    Begun {
        /// The scene that was chosen.
        scene: u8,
    },
    /// A frame shows.
    Frame(FrameReport),
    /// A frame could not be drawn; the reason stands on the console. The renderer was reset.
    Failed,
    /// How it goes.
    Status(Status),
}

/// How it goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Status {
    /// The board's time, in ticks.
    pub ticks: u64,
    /// Frames drawn since the scene began.
    pub frames: u32,
    /// Longest time from the end of a frame to the end of the next since the last answer, in ticks.
    pub slowest_frame_ticks: u32,
    /// What controllers said.
    pub tally: Tally,
}

/// What a frame took and made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct FrameReport {
    /// Frames drawn before this one since the scene began.
    pub index: u32,
    /// Vertices transformed.
    pub vertices: u32,
    /// Triangles that the scene's meshes have.
    pub triangles_submitted: u32,
    /// Triangles that had to be clipped.
    pub triangles_clipped: u32,
    /// Triangles that went to the FPGA.
    pub triangles_drawn: u32,
    /// Packets of every kind.
    pub packets: u32,
    /// Words of these packets.
    pub words: u32,
    /// Time for transforming vertices, in ticks.
    pub vertex_ticks: u32,
    /// Time for clipping, culling, lighting, set-up and packet words, in ticks.
    pub face_ticks: u32,
    /// Points, where the scene is a game.
    pub score: Option<u32>,
    /// CRC-32 of the picture that shows, RGB332, row 0 first; `None` where the processor cannot
    /// see the framebuffer.
    pub checksum: Option<u32>,
}

/// Puts a message into `buffer`, framed, and returns the bytes to send.
///
/// # Errors
/// [`EncodeError`] as of [`serial::encode`]; no message of this module meets it.
pub fn encode<'a>(
    kind: u8,
    message: &impl Serialize,
    buffer: &'a mut [u8; FRAME_SIZE_MAXIMUM],
) -> Result<&'a [u8], EncodeError> {
    let mut payload = [0; PAYLOAD_MAXIMUM];
    // The messages' own size is far below the maximum: postcard cannot run out of room.
    let payload = postcard::to_slice(message, &mut payload).map_or(&mut [][..], |payload| payload);
    serial::encode(kind, payload, buffer)
}

/// Reads a message from a frame's payload; `None` if it is not one.
#[must_use]
pub fn decode<'a, M: Deserialize<'a>>(payload: &'a [u8]) -> Option<M> {
    match postcard::take_from_bytes(payload) {
        Ok((message, [])) => Some(message),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use controls::serial::Decoder;

    #[test]
    fn messages_come_back_through_the_line() {
        let report = FrameReport { index: u32::MAX, checksum: Some(u32::MAX), words: 1 << 31, ..Default::default() };
        for message in [
            BoardMessage::Frame(report),
            BoardMessage::Failed,
            BoardMessage::Hello { ticks_per_second: 100_000_000, scenes: 3 },
            BoardMessage::Status(Status { ticks: u64::MAX, frames: 7, ..Default::default() }),
        ] {
            let mut buffer = [0; FRAME_SIZE_MAXIMUM];
            let bytes = encode(BOARD_MESSAGE, &message, &mut buffer).unwrap();
            let mut decoder = Decoder::new();
            let mut seen = 0;
            for byte in bytes {
                if let Some(frame) = decoder.feed(*byte) {
                    let frame = frame.unwrap();
                    assert_eq!((frame.kind, decode(frame.payload)), (BOARD_MESSAGE, Some(message)));
                    seen += 1;
                }
            }
            assert_eq!(seen, 1);
        }
    }

    #[test]
    fn bytes_that_are_no_message_are_none() {
        for payload in [&[][..], &[0xff], &[2, 0], &[1], &[2, 1, 2, 3]] {
            assert!(decode::<HostMessage>(payload).is_none() || payload == [1, 0], "{payload:?}");
        }
        assert_eq!(decode::<HostMessage>(&[1, 2]), Some(HostMessage::Begin { scene: 2 }));
    }
}
