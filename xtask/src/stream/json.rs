//! Packets as lines of JSON.

use fpga_regs::packet::{FlatTriangle, Packet, Span};
use fpga_regs::screen::PacketDepth;
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
        columns: [u16; 2],
        rows: [u16; 2],
        edges: [i32; 3],
        steps: [[i16; 2]; 2],
        depth: f64,
        depth_step_x: f64,
        depth_step_y: f64,
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

impl From<&Entry> for Line {
    fn from(entry: &Entry) -> Self {
        let body = match entry.packet {
            Ok(Packet::Clear(clear)) => Body::Clear { colour: clear.colour.0, depth: clear.depth },
            Ok(Packet::FlatTriangle(triangle)) => flat_triangle(&triangle),
            Ok(Packet::Swap) => Body::Swap,
            Ok(Packet::Fence(fence)) => Body::Fence { tag: fence.tag },
            Err(bad) => Body::Bad { reason: bad.to_string(), header: entry.header.0 },
        };
        Self { word: entry.word, length: entry.length, body }
    }
}

fn flat_triangle(triangle: &FlatTriangle) -> Body {
    let span = |span: Span| [span.first(), span.last()];
    // 32 bits of Q20.12 are exact in a double.
    let depth = |depth: PacketDepth| depth.to_num::<f64>();
    Body::FlatTriangle {
        colour: triangle.colour.0,
        columns: span(triangle.columns),
        rows: span(triangle.rows),
        edges: triangle.edges,
        steps: triangle.steps.map(|steps| [steps.step_x(), steps.step_y()]),
        depth: depth(triangle.depth),
        depth_step_x: depth(triangle.depth_step_x),
        depth_step_y: depth(triangle.depth_step_y),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stream::{WordFile, to_bytes};
    use fpga_regs::packet::{Clear, EdgeSteps, Fence, swap};
    use fpga_regs::screen::Rgb332;

    #[test]
    fn every_kind_is_a_line() {
        let triangle = FlatTriangle {
            colour: Rgb332(0xe3),
            columns: Span::new(3, 319),
            rows: Span::new(0, 239),
            edges: [-1, 0, 9],
            steps: [EdgeSteps::new(-5, 6), EdgeSteps::new(7, -8)],
            depth: PacketDepth::from_num(-1.5),
            depth_step_x: PacketDepth::from_num(0.25),
            depth_step_y: PacketDepth::from_num(3),
        };
        let clear = Clear { colour: Rgb332(1), depth: 65_535 };
        let words =
            [&clear.encode()[..], &triangle.encode(), &swap(), &Fence { tag: 5 }.encode(), &[0x7f01_0000, 0]].concat();
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
                r#"{"word":13,"length":1,"kind":"swap"}"#,
                r#"{"word":14,"length":2,"kind":"fence","tag":5}"#,
                r#"{"word":16,"length":2,"kind":"bad","reason":"unknown packet kind","header":2130771968}"#,
            ]
        );
    }
}
