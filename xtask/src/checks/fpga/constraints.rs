//! Timing constraints name what is there, and leave no crossing and no pin out.

use super::Problems;
use super::pins::PROCESSOR;
use super::script::Call;
use super::system::System;
use super::verilog::{Direction, Port, Source};

pub(super) fn check(ports: &[Port], sources: &[Source], system: &System<'_>, calls: &[Call], problems: &mut Problems) {
    let mut constrained: Vec<String> = Vec::new();
    for call in calls {
        let pattern = call.arguments.last().map_or("", String::as_str);
        match call.name.as_str() {
            "get_ports" => port(pattern, ports, call, problems),
            "get_registers" => register(pattern, sources, call, problems),
            "get_pins" => pin(pattern, sources, system, call, problems),
            "create_clock" | "set_false_path" | "set_output_delay" | "set_input_delay" | "create_generated_clock" => {
                constrained.extend(call.arguments.iter().filter_map(|argument| query("get_ports", argument)));
            }
            _ => {}
        }
    }
    for needed in ["derive_pll_clocks", "derive_clock_uncertainty"] {
        if !calls.iter().any(|call| call.name == needed) {
            problems
                .add_file("fpga/de1_soc.sdc", format!("{needed} is missing: the PLLs' clocks are unknown without it"));
        }
    }
    for port in ports.iter().filter(|port| !port.name.starts_with(PROCESSOR)) {
        if !constrained.iter().any(|name| name.trim_end_matches("[*]") == port.name) {
            let flag = if port.direction == Direction::Input { "-from" } else { "-to" };
            let message = format!(
                "{} has no timing: give fpga/de1_soc.sdc a delay for it, or set_false_path {flag} its port",
                port.name
            );
            problems.add(&port.place, message);
        }
    }
    crossings(sources, calls, problems);
}

/// Every synchronizer of the design is named.
fn crossings(sources: &[Source], calls: &[Call], problems: &mut Problems) {
    let cut = |kind: &str, pattern: &str| {
        calls.iter().filter(|call| call.name == "set_false_path").any(|call| {
            call.arguments.iter().any(|argument| query(kind, argument).is_some_and(|found| found.ends_with(pattern)))
        })
    };
    for source in sources {
        for (name, place) in source.instances("synchronizer") {
            if !cut("get_registers", &format!("|synchronizer:{name}|first_q[*]")) {
                let remedy = format!("set_false_path -to [get_registers {{*|synchronizer:{name}|first_q[*]}}]");
                problems.add(&place, format!("the crossing {name} is not in fpga/de1_soc.sdc: add `{remedy}`"));
            }
        }
        for (name, place) in source.instances("reset_synchronizer") {
            for register in ["first_q", "second_q"] {
                if !cut("get_pins", &format!("|{name}|{register}|clrn")) {
                    let remedy =
                        format!("set_false_path -to [get_pins -compatibility_mode {{*|{name}|{register}|clrn}}]");
                    problems.add(&place, format!("the reset {name} is not in fpga/de1_soc.sdc: add `{remedy}`"));
                }
            }
        }
    }
}

/// Returns the pattern of a query such as `get_ports {KEY[*]}`.
fn query(kind: &str, argument: &str) -> Option<String> {
    let rest = argument.strip_prefix(kind)?.strip_prefix(' ')?;
    let pattern = rest.strip_prefix("-compatibility_mode ").unwrap_or(rest);
    Some(pattern.trim_start_matches('{').trim_end_matches('}').to_owned())
}

fn port(pattern: &str, ports: &[Port], call: &Call, problems: &mut Problems) {
    let name = pattern.trim_end_matches("[*]");
    match ports.iter().find(|port| port.name == name) {
        None => problems.add(&call.place, format!("the top level has no port `{name}`: mend the name")),
        Some(port) if port.vector != (name != pattern) => {
            let right = if port.vector { format!("{name}[*]") } else { name.to_owned() };
            problems.add(&call.place, format!("`{pattern}` finds no bit of {name}: write {right}"));
        }
        Some(_) => {}
    }
}

/// `*|synchronizer:u_to_vga|first_q[*]`: an instance of the module, and a register in it.
fn register(pattern: &str, sources: &[Source], call: &Call, problems: &mut Problems) {
    let mut parts = pattern.rsplit('|');
    let name = parts.next().unwrap_or_default().trim_end_matches("[*]");
    let Some((module, instance)) = parts.next().and_then(|part| part.split_once(':')) else {
        problems.add(&call.place, format!("`{pattern}`: write *|module:instance|register"));
        return;
    };
    if !sources.iter().any(|source| source.instances(module).iter().any(|(own, _)| own == instance)) {
        problems.add(&call.place, format!("no {module} is called `{instance}` in rtl/ or fpga/: mend the name"));
    }
    if !sources.iter().any(|source| source.module() == Some(module) && source.has_register(name)) {
        problems.add(&call.place, format!("{module} has no register `{name}`: mend the name"));
    }
}

/// `*|u_reset|first_q|clrn`: an instance and a register in it; or an instance of the system and a pin of Intel's.
fn pin(pattern: &str, sources: &[Source], system: &System<'_>, call: &Call, problems: &mut Problems) {
    let parts: Vec<&str> = pattern.split('|').collect();
    let known = match parts.as_slice() {
        ["*", instance, "*", _] => system.has(instance),
        ["*", instance, register, "clrn"] => sources.iter().any(|source| {
            let module = source.module().unwrap_or_default();
            source.has_register(register)
                && sources.iter().any(|user| user.instances(module).iter().any(|(own, _)| own == instance))
        }),
        _ => false,
    };
    if !known {
        problems
            .add(&call.place, format!("`{pattern}` finds nothing in rtl/, fpga/ or fpga/system.tcl: mend the name"));
    }
}
