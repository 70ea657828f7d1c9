//! The Platform Designer system: our agents at their addresses, the interrupt, and what it shows to the top level.

use std::collections::HashMap;

use fpga_regs::de1_soc;

use super::components::Component;
use super::script::Call;
use super::verilog::Direction;
use super::{Place, Problems};

/// The number of the FPGA's first interrupt in the processor's GIC (Intel's `alt_int_device.h`).
const FIRST_INTERRUPT: u32 = 72;

/// A port of the generated system.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct SystemPort {
    pub name: String,
    pub direction: Direction,
    pub width: u32,
}

/// What the scripts say of the system.
pub(super) struct System<'a> {
    /// Instance to component.
    instances: HashMap<&'a str, &'a str>,
    /// Instance and parameter to value.
    parameters: HashMap<(&'a str, &'a str), &'a str>,
    components: &'a [Component],
}

impl<'a> System<'a> {
    pub fn new(calls: &'a [Call], components: &'a [Component]) -> Self {
        let of = |name: &'static str| calls.iter().filter(move |call| call.name == name);
        let instances = of("add_instance").map(|call| (call.argument(0), call.argument(1))).collect();
        let parameters = of("set_instance_parameter_value")
            .map(|call| ((call.argument(0), call.argument(1)), call.argument(2)))
            .collect();
        Self { instances, parameters, components }
    }

    /// Returns whether there is an instance of that name.
    pub fn has(&self, instance: &str) -> bool {
        self.instances.contains_key(instance)
    }

    /// Returns our component behind an instance.
    fn component(&self, instance: &str) -> Option<&'a Component> {
        let name = self.instances.get(instance)?;
        self.components.iter().find(|component| component.name == **name)
    }

    /// Checks instances, connections and addresses.
    pub fn check(&self, calls: &[Call], problems: &mut Problems) {
        let mut used: Vec<&str> = Vec::new();
        let mut start = Place::new("fpga/system.tcl".to_owned(), 1);
        for call in calls {
            let ends: &[&str] = match call.name.as_str() {
                "add_connection" => &[call.argument(0), call.argument(1)],
                "set_interface_property" if call.argument(1) == "EXPORT_OF" => &[call.argument(2)],
                "set_instance_parameter_value" => {
                    self.parameter(call, problems);
                    continue;
                }
                "add_instance" => {
                    start = call.place.clone();
                    continue;
                }
                _ => continue,
            };
            used.extend(ends);
            for end in ends {
                let (instance, interface) = end.split_once('.').unwrap_or((end, ""));
                if !self.has(instance) {
                    problems.add(&call.place, format!("`{end}`: there is no instance `{instance}`: mend the name"));
                } else if self.component(instance).is_some_and(|component| !component.has_interface(interface)) {
                    problems
                        .add(&call.place, format!("`{end}`: {instance} has no interface `{interface}`: mend the name"));
                }
            }
        }
        for instance in self.instances.keys() {
            let Some(component) = self.component(instance) else { continue };
            for (interface, ..) in &component.interfaces {
                let end = format!("{instance}.{interface}");
                if !used.contains(&end.as_str()) {
                    problems.add(&start, format!("`{end}` is neither connected nor exported"));
                }
            }
        }
        self.addresses(calls, problems);
    }

    fn parameter(&self, call: &Call, problems: &mut Problems) {
        let [instance, name] = [call.argument(0), call.argument(1)];
        if !self.has(instance) {
            problems.add(&call.place, format!("there is no instance `{instance}`: add it first"));
        } else if self.component(instance).is_some_and(|component| !component.parameters.iter().any(|own| own == name))
        {
            problems.add(&call.place, format!("`{instance}` has no parameter `{name}`: mend the name"));
        }
    }

    /// Addresses and interrupt are those that software uses.
    fn addresses(&self, calls: &[Call], problems: &mut Problems) {
        let lightweight = |address: usize| (address - de1_soc::LIGHTWEIGHT_BRIDGE) as u64;
        let expected = [
            ("hps.h2f_lw_axi_master/halfspace.registers", "baseAddress", lightweight(de1_soc::REGISTERS)),
            ("hps.h2f_lw_axi_master/board_io.registers", "baseAddress", lightweight(de1_soc::BOARD_IO)),
            ("hps.h2f_axi_master/halfspace.fifo", "baseAddress", (de1_soc::FIFO_APERTURE - de1_soc::BRIDGE) as u64),
            ("hps.f2h_irq0/halfspace.interrupt", "irqNumber", u64::from(de1_soc::INTERRUPT - FIRST_INTERRUPT)),
        ];
        for (connection, property, value) in expected {
            let found = calls.iter().find(|call| {
                call.name == "set_connection_parameter_value"
                    && call.argument(0) == connection
                    && call.argument(1) == property
            });
            let Some(call) = found else {
                let place = Place::new("fpga/system.tcl".to_owned(), 1);
                problems.add(&place, format!("{connection} has no {property}: set it to {value:#x}"));
                continue;
            };
            if number(call.argument(2)) != Some(value) {
                let message =
                    format!("{property} of {connection} is {}, but {value:#x} in fpga-regs", call.argument(2));
                problems.add(&call.place, message);
            }
        }
        for (instance, interface, bytes) in [
            ("halfspace", "fifo", 4 * fpga_regs::screen::FIFO_APERTURE_WORDS as u64),
            ("halfspace", "registers", fpga_regs::registers::REGISTER_BYTES as u64),
            ("board_io", "registers", size_of::<fpga_regs::board_io::BoardIoBlock>() as u64),
        ] {
            let Some(component) = self.component(instance) else { continue };
            let Some(address) = component.ports_of(interface).find(|port| port.role == "address") else { continue };
            let span = 4 << address.width;
            let fits = if interface == "fifo" { span == bytes } else { span >= bytes && span <= 0x1000 };
            if !fits {
                let message = format!("{instance}.{interface} spans {span:#x} bytes, fpga-regs gives it {bytes:#x}");
                problems.add(&address.place, message);
            }
        }
    }

    /// Returns the ports of the generated system, from what is exported.
    pub fn ports(&self, calls: &[Call], problems: &mut Problems) -> Vec<SystemPort> {
        let mut ports = Vec::new();
        for call in calls.iter().filter(|call| call.name == "set_interface_property" && call.argument(1) == "EXPORT_OF")
        {
            let [export, end] = [call.argument(0), call.argument(2)];
            let (instance, interface) = end.split_once('.').unwrap_or((end, ""));
            let before = ports.len();
            let mut add = |role: &str, direction, width| {
                ports.push(SystemPort { name: format!("{export}_{role}"), direction, width });
            };
            if let Some(component) = self.component(instance) {
                component.ports_of(interface).for_each(|port| add(&port.role, port.direction, port.width));
            }
            match (self.instances.get(instance).copied().unwrap_or_default(), interface) {
                ("clock_source", "clk_in") => add("clk", Direction::Input, 1),
                ("clock_source", "clk_in_reset") | ("altera_reset_bridge", "in_reset") => {
                    add("reset_n", Direction::Input, 1);
                }
                ("altera_clock_bridge", "out_clk") => add("clk", Direction::Output, 1),
                ("altera_pll", "locked") => add("export", Direction::Output, 1),
                ("altera_hps", "memory") => {
                    memory(|name| number(self.parameters.get(&(instance, name))?), &mut add);
                }
                _ => {}
            }
            if ports.len() == before {
                problems
                    .add(&call.place, format!("`{end}` has no ports that this check knows: mend the name or teach it"));
            }
        }
        ports
    }
}

/// The memory conduit of the processor's component, as wide as its parameters make it.
fn memory(parameter: impl Fn(&str) -> Option<u64>, add: &mut impl FnMut(&str, Direction, u32)) {
    let width = |name| parameter(name).map_or(0, |width| width as u32);
    let data = width("MEM_DQ_WIDTH");
    add("mem_a", Direction::Output, width("MEM_ROW_ADDR_WIDTH"));
    add("mem_ba", Direction::Output, width("MEM_BANKADDR_WIDTH"));
    for name in ["ck", "ck_n", "cke", "cs_n", "ras_n", "cas_n", "we_n", "reset_n", "odt"] {
        add(&format!("mem_{name}"), Direction::Output, 1);
    }
    add("mem_dq", Direction::Bidirectional, data);
    add("mem_dqs", Direction::Bidirectional, data / 8);
    add("mem_dqs_n", Direction::Bidirectional, data / 8);
    add("mem_dm", Direction::Output, data / 8);
    add("oct_rzqin", Direction::Input, 1);
}

fn number(text: &str) -> Option<u64> {
    match text.strip_prefix("0x") {
        Some(digits) => u64::from_str_radix(digits, 16).ok(),
        None => text.parse().ok(),
    }
}
