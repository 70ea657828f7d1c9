//! The reference page of registers and packets.

use std::fmt::Write as _;

use fpga_regs::board_io::BOARD_REGISTERS;
use fpga_regs::layout::Field;
use fpga_regs::packet::{Header, Kind};
use fpga_regs::registers::{Access, REGISTERS, RegisterInfo};
use fpga_regs::{de1_soc, screen};

/// Returns the page, in Markdown.
pub fn text() -> String {
    let mut page = String::from(
        "# Registers and packets\n\n\
         Generated from `fpga-regs` by `cargo xtask generate`: change it there.\n\n\
         All words have 32 bits. Offsets are bytes from the start of the register agent; the FIFO aperture is\n\
         an agent of its own, and so are a board's inputs and outputs.\n\n## Registers\n\n",
    );
    registers(&mut page, REGISTERS);
    unusual_accesses(&mut page);
    packets(&mut page);
    sizes(&mut page);
    page.push_str(
        "\n## The board's inputs and outputs\n\n\
         An agent of its own, apart from the rasterizer; offsets are bytes from its start.\n\n",
    );
    registers(&mut page, BOARD_REGISTERS);
    de1_soc_addresses(&mut page);
    page
}

fn registers(page: &mut String, table: &[RegisterInfo]) {
    page.push_str("| offset | name | access | reset | holds |\n| --- | --- | --- | --- | --- |\n");
    for register in table {
        let access = match register.access {
            Access::ReadOnly => "read only",
            Access::ReadWrite => "read, write",
            Access::WriteOneToClear => "write 1 to clear",
        };
        let reset = register.reset.map_or("by build or state".to_string(), |value| format!("{value:#010x}"));
        let _ = writeln!(
            page,
            "| {:#04x} | {} | {access} | {reset} | {} |",
            register.offset,
            register.name,
            register.doc.trim()
        );
    }
    page.push_str("\n### Fields\n\nBits that no field names read 0 and ignore what is written.\n\n");
    page.push_str("| register | bits | field | meaning |\n| --- | --- | --- | --- |\n");
    for register in table {
        for field in register.fields {
            let _ = writeln!(page, "| {} | {} |", register.name, field_row(field));
        }
    }
}

/// What no driver should do, and what then happens all the same.
fn unusual_accesses(page: &mut String) {
    page.push_str(
        "\n### Where nothing is\n\n\
         | access | what happens |\n| --- | --- |\n\
         | read of an address of the register agent (4 KiB) at which no register is | gives 0 |\n\
         | write to such an address, or to a register that is read only | is ignored, nothing is flagged |\n\
         | read of the FIFO aperture | gives 0 at once, even while a write would wait; takes no word |\n\
         | write to the FIFO aperture, whatever the word's address in it | appends the word |\n\
         | write of a part of a word | is not defined: the agents take whole, aligned words and have no byte enables |\n",
    );
}

fn de1_soc_addresses(page: &mut String) {
    let _ = write!(
        page,
        "\n## Addresses on the DE1-SoC\n\n| agent | bridge | address |\n| --- | --- | --- |\n\
         | registers | lightweight HPS-to-FPGA | {:#X} |\n\
         | board inputs and outputs | lightweight HPS-to-FPGA | {:#X} |\n\
         | FIFO aperture | HPS-to-FPGA, 32 bits wide | {:#X} |\n\n\
         The interrupt is the processor's number {} (the FPGA's first). The project is set so that any other\n\
         address of the two bridges answers with an error.\n",
        de1_soc::REGISTERS,
        de1_soc::BOARD_IO,
        de1_soc::FIFO_APERTURE,
        de1_soc::INTERRUPT,
    );
}

fn field_row(field: &Field) -> String {
    let bits = if field.high == field.low { field.high.to_string() } else { format!("{}…{}", field.high, field.low) };
    let sign = if field.signed { " (signed)" } else { "" };
    format!("{bits} | {}{sign} | {}", field.name, field.doc.trim())
}

fn packets(page: &mut String) {
    page.push_str(
        "\n## Packets\n\nA packet is a header and as many words as it says. A header of unknown kind, with a length that is\n\
         not its kind's or with a reserved bit set, or a box that is empty or leaves the screen, makes a bad\n\
         packet: it is skipped by its header's length, flagged in ERRORS and counted in BAD_PACKETS.\n\n\
         ### Header\n\n| bits | field | meaning |\n| --- | --- | --- |\n",
    );
    for field in Header::FIELDS {
        let _ = writeln!(page, "| {} |", field_row(field));
    }
    for kind in Kind::ALL {
        let info = kind.info();
        let _ = write!(
            page,
            "\n### {} ({:#04x})\n\n{}\n\n| word | name | bits | field | meaning |\n| --- | --- | --- | --- | --- |\n",
            info.name, *kind as u8, info.doc
        );
        let colour = if kind.has_colour() { " with a colour" } else { "" };
        let _ = writeln!(page, "| 0 | header | 31…0 | {:#010x}{colour} | |", Header::of(*kind).0);
        for (index, word) in info.words.iter().enumerate() {
            let (index, name) = (index + 1, word.name);
            if word.fields.is_empty() {
                let _ = writeln!(page, "| {index} | {name} | 31…0 | | {} |", word.doc.trim());
            }
            for field in word.fields {
                let _ = writeln!(page, "| {index} | {name} | {} |", field_row(field));
            }
        }
    }
    page.push_str(
        "\n### Formats of a triangle\n\n\
         | quantity | format | range that setup produces |\n| --- | --- | --- |\n\
         | edge step | signed 16-bit integer | ±16,382: a difference of two coordinates in the guard band |\n\
         | edge value at a pixel of the screen | signed integer in steps of an edge | ±2^24 |\n\
         | depth and its steps | signed Q20.12 modulo 2^32 | any; at a covered pixel the sum is in −1…65,536 |\n\n\
         A pixel is inside where all three edge values are 0 or more; the third edge's steps are minus the sum of\n\
         the others'. Its depth is bits 31…12 of the sum, saturated to 0…65,535; it is drawn when that is less\n\
         than the depth buffer holds.\n\n\
         A channel of a Gouraud triangle is bits 20…12 of its sum: up to 255 as they are, 256…383 are taken for 255,\n\
         384…511 for 0. With v such a channel and t the threshold of the pixel below, red and green are\n\
         (v − ⌊v/8⌋ + 2t + 1) / 32 and blue is (v − ⌊v/4⌋ + 4t + 2) / 64, fractions dropped.\n\n\
         | y mod 4 | x mod 4 = 0 | 1 | 2 | 3 |\n| --- | --- | --- | --- | --- |\n",
    );
    for (row, thresholds) in screen::DITHER.iter().enumerate() {
        let [first, second, third, fourth] = thresholds;
        let _ = writeln!(page, "| {row} | {first} | {second} | {third} | {fourth} |");
    }
}

fn sizes(page: &mut String) {
    let _ = write!(
        page,
        "\n## Sizes\n\n| what | value |\n| --- | --- |\n\
         | screen | {}×{} pixels, RGB332, row 0 on top |\n\
         | depth | 16 bits, 0 near, {} far and after a clear |\n\
         | sub-pixel | 1/{} pixel |\n\
         | guard band | ±{} sixteenths of a pixel |\n\
         | FIFO aperture | {} words; {:#x} behind the registers when both are on the lightweight bridge |\n",
        screen::WIDTH,
        screen::HEIGHT,
        screen::DEPTH_FAR,
        screen::SUBPIXEL,
        screen::GUARD_BAND,
        screen::FIFO_APERTURE_WORDS,
        screen::LIGHTWEIGHT_APERTURE_OFFSET,
    );
}
