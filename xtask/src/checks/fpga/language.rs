//! The SystemVerilog keeps to what Quartus Prime Standard and Lite take, the only ones for a Cyclone V.
//!
//! Their front end is older than Pro's. What it refuses, or is reported to get wrong:
//!
//! | construct | source |
//! | --- | --- |
//! | `import` in a module's header | openhwgroup/cv32e40p issues 943, 1050; rggen/rggen-sv-rtl issue 18 (24.1std) |
//! | `localparam` in a parameter list | pulp-platform/common_cells pull request 49; ZipCPU/wb2axip issue 31 |
//! | generate loops and conditions without `generate`, `genvar` in the loop's head, unnamed blocks | lowRISC/ibex issue 117; MarekPikula/quartus-sv-gotchas 27.4, 27.5 |
//! | `inside` | the same, 11.4.13, 12.5.4 |
//! | `case (1'b1)`: synthesizes wrongly | the same, 12.5.2 |
//! | two semicolons in a row | the same |

use super::Problems;
use super::verilog::Source;

pub(super) fn check(source: &Source, problems: &mut Problems) {
    header(source, problems);
    let mut in_generate = false;
    let mut at = 0;
    for line in source.text.split_inclusive('\n') {
        let place = source.place(at);
        at += line.len();
        let words: Vec<&str> =
            line.split(|character: char| !(character.is_alphanumeric() || character == '_')).collect();
        let squeezed: String = line.split_whitespace().collect();
        match words.iter().copied().find(|word| ["generate", "endgenerate"].contains(word)) {
            Some("generate") => in_generate = true,
            Some(_) => in_generate = false,
            None => {}
        }
        let findings = [
            (squeezed.contains("for(genvar"), "declare the genvar before the loop"),
            (squeezed.contains("begin:g_") && !in_generate, "put generate and endgenerate around generated blocks"),
            (words.contains(&"inside"), "Quartus has no `inside`: compare with == and <="),
            (squeezed.contains("case(1'b1)"), "Quartus gets case (1'b1) wrong: write if and else if"),
            (squeezed.contains(";;"), "Quartus refuses two semicolons in a row: take one away"),
        ];
        for (_, remedy) in findings.into_iter().filter(|(found, _)| *found) {
            problems.add(&place, remedy.to_owned());
        }
    }
}

fn header(source: &Source, problems: &mut Problems) {
    let (Some(start), Some(header)) = (source.find_word("module", 0), source.header()) else { return };
    if let Some(at) = source.find_word("import", start).filter(|at| *at < header.ports.start) {
        let remedy = "Quartus takes no import in a module's header: import behind it, and write package::type in ports";
        problems.add(&source.place(at), remedy.to_owned());
    }
    let Some(parameters) = header.parameters else { return };
    if let Some(at) = source.find_word("localparam", parameters.start).filter(|at| parameters.contains(at)) {
        let remedy = "Quartus takes no localparam among the parameters: move it behind the header";
        problems.add(&source.place(at), remedy.to_owned());
    }
}
