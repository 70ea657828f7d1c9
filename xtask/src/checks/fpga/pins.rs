//! Every pin of the top level is assigned once, with its I/O standard, and nothing else is.

use std::collections::HashMap;

use super::Problems;
use super::script::Call;
use super::verilog::Port;

/// Ports of the processor's own pins: their places are fixed in the chip, their standards come with the
/// memory controller.
pub(super) const PROCESSOR: &str = "HPS_";

pub(super) fn check(ports: &[Port], calls: &[Call], problems: &mut Problems) {
    let bits: Vec<(&Port, String)> = ports.iter().flat_map(|port| bits(port).map(move |bit| (port, bit))).collect();
    let mut locations: HashMap<&str, Vec<&Call>> = HashMap::new();
    let mut standards: HashMap<&str, Vec<&Call>> = HashMap::new();
    let mut pins: HashMap<&str, &Call> = HashMap::new();
    for call in calls {
        let kind = match call.name.as_str() {
            "set_location_assignment" => &mut locations,
            "set_instance_assignment" if call.after("-name") == Some("IO_STANDARD") => &mut standards,
            _ => continue,
        };
        let Some(to) = call.after("-to") else {
            problems.add(&call.place, format!("{} without -to: name the port", call.name));
            continue;
        };
        kind.entry(to).or_default().push(call);
        match bits.iter().find(|(_, bit)| bit == to) {
            None => problems.add(
                &call.place,
                format!("`{to}` is assigned, but the top level has no such port: mend the name or take the line away"),
            ),
            Some((port, _)) if port.name.starts_with(PROCESSOR) => problems.add(
                &call.place,
                format!("`{to}` is the processor's and has its place in the chip: take the line away"),
            ),
            Some(_) => {}
        }
        if call.name == "set_location_assignment" {
            let pin = call.argument(0);
            if !is_pin(pin) {
                problems.add(&call.place, format!("`{pin}` of {to} is no pin: write PIN_ and a ball, such as PIN_A11"));
            }
            if let Some(other) = pins.insert(pin, call) {
                let first = other.after("-to").unwrap_or_default();
                problems.add(&call.place, format!("{pin} of {to} has been given to {first} before ({})", other.place));
            }
        }
    }
    for (port, bit) in bits.iter().filter(|(port, _)| !port.name.starts_with(PROCESSOR)) {
        for (what, map) in [("pin", &locations), ("I/O standard", &standards)] {
            match map.get(bit.as_str()).map_or(&[][..], Vec::as_slice) {
                [_] => {}
                [] => problems.add(&port.place, format!("{bit} has no {what}: assign one in fpga/pins.tcl")),
                [.., last] => problems.add(&last.place, format!("{bit} has a second {what}: keep one")),
            }
        }
    }
}

/// The bits of a port as Quartus names them.
fn bits(port: &Port) -> impl Iterator<Item = String> + '_ {
    let count = port.width.unwrap_or(0);
    (0..count).map(|index| if port.vector { format!("{}[{index}]", port.name) } else { port.name.clone() })
}

fn is_pin(text: &str) -> bool {
    let Some(ball) = text.strip_prefix("PIN_") else { return false };
    let row = ball.trim_end_matches(|character: char| character.is_ascii_digit());
    let column = &ball[row.len()..];
    (1..=2).contains(&row.len())
        && row.bytes().all(|byte| byte.is_ascii_uppercase())
        && column.parse::<u32>().is_ok_and(|column| (1..=30).contains(&column))
}
