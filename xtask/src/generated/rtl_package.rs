//! The SystemVerilog package of registers, packets and formats.

use std::fmt::Write as _;

use fpga_regs::layout::Field;
use fpga_regs::packet::{Channels, Header, Kind, Packet, TriangleShape};
use fpga_regs::registers::{ID_HALF, REGISTERS, RegisterInfo, VERSION_MAJOR, VERSION_MINOR};
use fpga_regs::screen;

/// Returns the package.
pub fn text() -> String {
    let mut package = String::from(
        "// Registers, packets and number formats of the contract between software and FPGA.\n\
         // Generated from the crate fpga-regs by `cargo xtask generate`: change it there.\n\
         `default_nettype none\n\n\
         package halfspace_pkg;\n\n",
    );
    sizes(&mut package);
    registers(&mut package);
    packets(&mut package);
    package.push_str("endpackage\n\n`default_nettype wire\n");
    package
}

fn constant(package: &mut String, kind: &str, name: &str, value: impl std::fmt::Display, doc: &str) {
    let _ = writeln!(package, "  localparam {kind} {name} = {value};  // {doc}");
}

fn sizes(package: &mut String) {
    let unsigned = "int unsigned";
    package.push_str("  // Sizes and formats.\n");
    for (name, value, doc) in [
        ("Width", screen::WIDTH, "pixels"),
        ("Height", screen::HEIGHT, "pixels"),
        ("SubpixelBits", screen::SUBPIXEL_BITS, "fraction bits of a screen coordinate"),
        ("DepthFractionBits", screen::DEPTH_FRACTION_BITS, "fraction bits of depth in a packet"),
        ("ColourFractionBits", screen::COLOUR_FRACTION_BITS, "fraction bits of a colour channel in a packet"),
        ("ChannelBits", Channels::BITS, "bits of a colour channel in a packet"),
        ("DepthFar", u32::from(screen::DEPTH_FAR), "far plane, and what a clear leaves"),
        ("GuardBand", screen::GUARD_BAND as u32, "largest magnitude of a vertex's coordinate, sub-pixels"),
        ("FifoApertureWords", screen::FIFO_APERTURE_WORDS as u32, "address space of the FIFO agent"),
    ] {
        constant(package, unsigned, name, value, doc);
    }
    let thresholds = screen::DITHER.concat();
    let digits: String = thresholds.iter().rev().map(|threshold| format!("{threshold:x}")).collect();
    constant(
        package,
        "logic [15:0][3:0]",
        "Dither",
        format!("64'h{digits}"),
        "thresholds of ordered dithering, by 4 y + x",
    );
    package.push('\n');
}

fn registers(package: &mut String) {
    package.push_str("  // Registers: byte offsets from the agent's start.\n");
    constant(package, "logic [31:0]", "IdHalf", format!("32'h{ID_HALF:08x}"), "what ID reads: \"HALF\"");
    constant(
        package,
        "logic [15:0]",
        "VersionMajor",
        format!("16'd{VERSION_MAJOR}"),
        "changes with incompatible changes",
    );
    constant(
        package,
        "logic [15:0]",
        "VersionMinor",
        format!("16'd{VERSION_MINOR}"),
        "grows with compatible additions",
    );
    register_table(package, REGISTERS);
}

/// An agent's registers: an enum of their offsets, and a structure for each that has fields.
pub(super) fn register_table(package: &mut String, table: &[RegisterInfo]) {
    package.push_str("  typedef enum logic [7:0] {\n");
    for (index, register) in table.iter().enumerate() {
        let comma = if index + 1 < table.len() { "," } else { "" };
        let _ = writeln!(package, "    Reg{} = 8'h{:02x}{comma}", camel(register.name), register.offset);
    }
    package.push_str("  } register_e;\n\n");
    for register in table.iter().filter(|register| !register.fields.is_empty()) {
        structure(package, &register.name.to_lowercase(), register.doc, register.fields);
    }
}

fn packets(package: &mut String) {
    package.push_str("  // Packets: a header and as many words as its length says.\n  typedef enum logic [7:0] {\n");
    for (index, kind) in Kind::ALL.iter().enumerate() {
        let comma = if index + 1 < Kind::ALL.len() { "," } else { "" };
        let _ = writeln!(package, "    Kind{} = 8'h{:02x}{comma}", camel(kind.info().name), *kind as u8);
    }
    package.push_str("  } kind_e;\n\n");
    for kind in Kind::ALL {
        let name = format!("{}Words", camel(kind.info().name));
        constant(package, "int unsigned", &name, kind.length(), "words behind the header");
    }
    constant(
        package,
        "int unsigned",
        "PayloadWordsMax",
        Packet::MAX_WORDS - 1,
        "words behind the longest packet's header",
    );
    constant(
        package,
        "int unsigned",
        "ShapeWords",
        TriangleShape::WORDS,
        "words of a shape, a triangle packet's last ones",
    );
    package.push('\n');
    structure(package, "header", Header::DOC, Header::FIELDS);
    let mut seen = Vec::new();
    for kind in Kind::ALL {
        for (index, word) in kind.info().words.iter().enumerate() {
            let name = format!("{}{}", camel(kind.info().name), camel(word.name));
            constant(package, "int unsigned", &format!("{name}Word"), index, word.doc.trim());
            if !word.fields.is_empty() && !seen.contains(&word.fields) {
                seen.push(word.fields);
                let type_name = if word.fields.iter().any(|field| field.name == "first") {
                    "span".to_string()
                } else if word.fields.iter().any(|field| field.name == "step_x") {
                    "edge_steps".to_string()
                } else if word.fields.iter().any(|field| field.name == "green_low") {
                    "channels_low".to_string()
                } else if word.fields.iter().any(|field| field.name == "green_high") {
                    "channels_high".to_string()
                } else {
                    format!("{}_{}", kind.info().name.to_lowercase(), word.name)
                };
                structure(package, &type_name, word.doc, word.fields);
            }
        }
    }
}

/// A packed structure of 32 bits, highest field first, gaps filled.
fn structure(package: &mut String, name: &str, doc: &str, fields: &[Field]) {
    let mut sorted: Vec<&Field> = fields.iter().collect();
    sorted.sort_by_key(|field| std::cmp::Reverse(field.high));
    let _ = writeln!(package, "  // {}", doc.trim());
    package.push_str("  typedef struct packed {\n");
    let mut above = 32;
    for field in sorted {
        gap(package, above, field.high + 1);
        let sign = if field.signed { " signed" } else { "" };
        let _ = writeln!(
            package,
            "    logic{sign} [{}:0] {};  // {}",
            field.high - field.low,
            field.name,
            field.doc.trim()
        );
        above = field.low;
    }
    gap(package, above, 0);
    let _ = writeln!(package, "  }} {name}_t;\n");
}

fn gap(package: &mut String, above: u32, low: u32) {
    if above > low {
        let _ = writeln!(package, "    logic [{}:0] unused_{low};", above - low - 1);
    }
}

/// `PIXELS_TESTED` to `PixelsTested`.
fn camel(name: &str) -> String {
    let words = name.split('_').map(|word| {
        let mut letters = word.chars();
        letters.next().map_or(String::new(), |first| {
            first.to_uppercase().chain(letters.flat_map(char::to_lowercase)).collect::<String>()
        })
    });
    words.collect()
}
