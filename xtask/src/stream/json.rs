//! Packets as lines of JSON.

use fpga_regs::packet::{Channels, Packet, PixelMode, Span, TriangleShape};
use fpga_regs::screen::{COLOUR_FRACTION_BITS, PacketDepth};
use serde::Serialize;

use super::Entry;

/// One line: where the packet stands, and what it is.
#[derive(Debug, Serialize)]
pub struct Line {
    word: usize,
    length: usize,
    #[serde(flatten)]
    body: Body,
}

/// A packet's fields; colours are RGB332 bytes, spans the first and last pixel, depths in units
/// of the depth buffer with their fraction, each step the one to the right and the one down.
#[derive(Debug, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
enum Body {
    Clear {
        colour: u8,
        depth: u16,
    },
    FlatTriangle {
        colour: u8,
        #[serde(flatten)]
        mode: Mode,
        #[serde(flatten)]
        shape: Shape,
    },
    GouraudTriangle {
        colour: [f64; 3],
        colour_step_x: [f64; 3],
        colour_step_y: [f64; 3],
        #[serde(flatten)]
        mode: Mode,
        #[serde(flatten)]
        shape: Shape,
    },
    Swap,
    Fence {
        tag: u32,
    },
    Bad {
        reason: String,
        header: u32,
    },
}

/// What is unusual about a triangle's pixels; what is usual is not written.
#[derive(Debug, Serialize)]
struct Mode {
    #[serde(skip_serializing_if = "is_false")]
    keep_depth: bool,
    #[serde(skip_serializing_if = "is_false")]
    keep_colour: bool,
    #[serde(skip_serializing_if = "is_false")]
    depth_grey: bool,
}

fn is_false(flag: &bool) -> bool {
    !flag
}

impl From<PixelMode> for Mode {
    fn from(PixelMode { keep_depth, keep_colour, depth_grey }: PixelMode) -> Self {
        Self { keep_depth, keep_colour, depth_grey }
    }
}

/// What all triangles have.
#[derive(Debug, Serialize)]
struct Shape {
    columns: [u16; 2],
    rows: [u16; 2],
    edges: [i32; 3],
    steps: [[i16; 2]; 2],
    depth: f64,
    depth_step_x: f64,
    depth_step_y: f64,
}

impl From<&Entry> for Line {
    fn from(entry: &Entry) -> Self {
        let body = match entry.packet {
            Ok(Packet::Clear(clear)) => Body::Clear { colour: clear.colour.0, depth: clear.depth },
            Ok(Packet::FlatTriangle(triangle)) => Body::FlatTriangle {
                colour: triangle.colour.0,
                mode: triangle.mode.into(),
                shape: (&triangle.shape).into(),
            },
            Ok(Packet::GouraudTriangle(triangle)) => Body::GouraudTriangle {
                colour: channels(triangle.colour),
                colour_step_x: channels(triangle.colour_step_x),
                colour_step_y: channels(triangle.colour_step_y),
                mode: triangle.mode.into(),
                shape: (&triangle.shape).into(),
            },
            Ok(Packet::Swap) => Body::Swap,
            Ok(Packet::Fence(fence)) => Body::Fence { tag: fence.tag },
            Err(bad) => Body::Bad { reason: bad.to_string(), header: entry.header.0 },
        };
        Self { word: entry.word, length: entry.length, body }
    }
}

impl From<&TriangleShape> for Shape {
    fn from(shape: &TriangleShape) -> Self {
        let span = |span: Span| [span.first(), span.last()];
        // 32 bits of Q20.12 are exact in a double.
        let depth = |depth: PacketDepth| depth.to_num::<f64>();
        Self {
            columns: span(shape.columns),
            rows: span(shape.rows),
            edges: shape.edges,
            steps: shape.steps.map(|steps| [steps.step_x(), steps.step_y()]),
            depth: depth(shape.depth),
            depth_step_x: depth(shape.depth_step_x),
            depth_step_y: depth(shape.depth_step_y),
        }
    }
}

/// A channel as a number around 0: modulo 512, so that a step down shows as negative.
fn channels(channels: Channels) -> [f64; 3] {
    let unused = 32 - Channels::BITS;
    channels.0.map(|channel| f64::from(channel << unused >> unused) / f64::from(1 << COLOUR_FRACTION_BITS))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stream::{WordFile, to_bytes};
    use fpga_regs::packet::{Clear, EdgeSteps, Fence, FlatTriangle, GouraudTriangle, swap};
    use fpga_regs::screen::Rgb332;

    #[test]
    fn every_kind_is_a_line() {
        let shape = TriangleShape {
            columns: Span::new(3, 319),
            rows: Span::new(0, 239),
            edges: [-1, 0, 9],
            steps: [EdgeSteps::new(-5, 6), EdgeSteps::new(7, -8)],
            depth: PacketDepth::from_num(-1.5),
            depth_step_x: PacketDepth::from_num(0.25),
            depth_step_y: PacketDepth::from_num(3),
        };
        let triangle = FlatTriangle { colour: Rgb332(0xe3), mode: PixelMode::USUAL, shape };
        let gouraud = GouraudTriangle {
            colour: Channels([255 << 12, 0, 0x800]),
            colour_step_x: Channels([-0x1800, 1 << 12, 0]),
            colour_step_y: Channels([0, 0, -1 << 12]),
            mode: PixelMode { keep_depth: true, ..PixelMode::USUAL },
            shape,
        };
        let clear = Clear { colour: Rgb332(1), depth: 65_535 };
        let words = [
            &clear.encode()[..],
            &triangle.encode(),
            &gouraud.encode(),
            &swap(),
            &Fence { tag: 5 }.encode(),
            &[0x7f01_0000, 0],
        ]
        .concat();
        let file = WordFile::from_bytes(&to_bytes(&words));
        let lines: Vec<String> =
            file.entries().map(|entry| serde_json::to_string(&Line::from(&entry)).expect("plain data")).collect();
        assert_eq!(
            lines,
            [
                r#"{"word":0,"length":2,"kind":"clear","colour":1,"depth":65535}"#,
                concat!(
                    r#"{"word":2,"length":11,"kind":"flat_triangle","colour":227,"columns":[3,319],"rows":[0,239],"#,
                    r#""edges":[-1,0,9],"steps":[[-5,6],[7,-8]],"depth":-1.5,"depth_step_x":0.25,"depth_step_y":3.0}"#
                ),
                concat!(
                    r#"{"word":13,"length":17,"kind":"gouraud_triangle","colour":[255.0,0.0,0.5],"#,
                    r#""colour_step_x":[-1.5,1.0,0.0],"colour_step_y":[0.0,0.0,-1.0],"keep_depth":true,"columns":[3,319],"#,
                    r#""rows":[0,239],"#,
                    r#""edges":[-1,0,9],"steps":[[-5,6],[7,-8]],"depth":-1.5,"depth_step_x":0.25,"depth_step_y":3.0}"#
                ),
                r#"{"word":30,"length":1,"kind":"swap"}"#,
                r#"{"word":31,"length":2,"kind":"fence","tag":5}"#,
                r#"{"word":33,"length":2,"kind":"bad","reason":"unknown packet kind","header":2130771968}"#,
            ]
        );
    }
}
