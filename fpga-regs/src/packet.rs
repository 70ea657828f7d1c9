//! The command packets that travel in the FIFO.
//!
//! A packet is a [`Header`] and as many more words as its length says. The device takes them in
//! order, one packet after another; nothing else orders commands.
//!
//! **Bad packets.** A header of unknown kind, a length that is not its kind's, a reserved bit
//! that is set, or a box that is empty or leaves the screen makes a *bad packet*: the device
//! skips as many words as the header's length says, sets `ERRORS.bad_packet`, counts it in
//! BAD_PACKETS, draws nothing for it and goes on. So no stream of words can hang it. A header of
//! zero is bad: a FIFO fed with zeros says so. A bad header counts when it is taken, a bad word
//! behind it when the packet's last word is.
//!
//! **Arithmetic.** The device adds edge values and depths modulo 2³², so that words which no setup
//! makes draw the same wrong pixels everywhere.
//!
//! **Formats of a triangle.** With A, B the steps of an edge function and E its value, a pixel is
//! inside where all three E ≥ 0 ([Pineda 1988]); the fill rule is folded into E by software.
//!
//! | quantity | format | range that setup produces |
//! | --- | --- | --- |
//! | edge step (A per pixel in x, B in y) | signed 16-bit integer | ±16,382: a difference of two coordinates in the [guard band](crate::screen::GUARD_BAND) |
//! | edge value at a pixel of the screen | signed integer, in steps of an edge | ±2²⁴: twice the area of a triangle in the guard band's square, ≤ 2²⁸, over [`SUBPIXEL`](crate::screen::SUBPIXEL) |
//! | depth and its steps | signed Q20.12 **modulo 2³²** | any; at every covered pixel the sum lies in −1…65,536 |
//! | a colour channel and its steps | Q9.12 **modulo 2²¹** | any; at every covered pixel the sum lies in −1…256 |
//!
//! Depth is modular on purpose. A plane seen nearly edge-on has slopes past any range, but a sum
//! of linear steps taken modulo 2³² is right wherever its true value is in range, and that is
//! so at every covered pixel. The device takes bits 31…12 as a signed integer and saturates it
//! to 0…65,535. The third edge's steps are not sent: the three sum to zero.
//!
//! A colour channel is modular for the same reason. The device takes bits 20…12 of the sum: up to
//! 255 they are the channel, 256…383 are 255 (just above), 384…511 are 0 (just below).
//!
//! [Pineda 1988]: https://doi.org/10.1145/54852.378457

mod commands;
mod decode;
mod flat_triangle;
mod gouraud_triangle;
mod header;
mod triangle_shape;

pub use commands::{Clear, ClearDepth, Fence, swap};
pub use decode::Packet;
pub use flat_triangle::FlatTriangle;
pub use gouraud_triangle::{Channels, ChannelsHigh, ChannelsLow, GouraudTriangle};
pub use header::{BadPacket, Header, Kind, PacketInfo, PixelMode, WordInfo};
pub use triangle_shape::{EdgeSteps, Span, TriangleShape};

#[cfg(test)]
mod tests;
