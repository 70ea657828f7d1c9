//! A component's description for Platform Designer says what its module has.

use super::script::Call;
use super::verilog::{Direction, Port, Source};
use super::{Place, Problems};

/// An interface's port: `add_interface_port INTERFACE PORT ROLE DIRECTION WIDTH`.
#[derive(Debug, Clone)]
pub(super) struct RolePort {
    pub place: Place,
    pub interface: String,
    pub role: String,
    pub direction: Direction,
    pub width: u32,
}

/// A component as its `_hw.tcl` describes it.
#[derive(Debug, Clone)]
pub(super) struct Component {
    pub name: String,
    /// Interfaces: name, kind, direction, place.
    pub interfaces: Vec<(String, String, String, Place)>,
    pub ports: Vec<RolePort>,
    /// Names of its parameters.
    pub parameters: Vec<String>,
}

impl Component {
    pub fn ports_of(&self, interface: &str) -> impl Iterator<Item = &RolePort> {
        self.ports.iter().filter(move |port| port.interface == interface)
    }

    pub fn has_interface(&self, name: &str) -> bool {
        self.interfaces.iter().any(|(interface, ..)| interface == name)
    }
}

/// Checks a description against its module and returns it.
pub(super) fn check(source: &Source, calls: &[Call], problems: &mut Problems) -> Component {
    let module = source.module().unwrap_or_default();
    let start = calls.first().map_or(Place::new(source.path.clone(), 1), |call| call.place.clone());
    let mut component = Component { name: String::new(), interfaces: vec![], ports: vec![], parameters: vec![] };
    let module_ports = source.ports();
    let mut covered: Vec<&str> = Vec::new();
    for call in calls {
        match call.name.as_str() {
            "set_module_property" if call.argument(0) == "NAME" => component.name = call.argument(1).to_owned(),
            "set_fileset_property" if call.argument(1) == "TOP_LEVEL" && call.argument(2) != module => problems.add(
                &call.place,
                format!("TOP_LEVEL is {}, but the module of {} is {module}", call.argument(2), source.path),
            ),
            "add_interface" => {
                let [name, kind, direction] = [0, 1, 2].map(|index| call.argument(index).to_owned());
                component.interfaces.push((name, kind, direction, call.place.clone()));
            }
            "set_interface_property" => property(call, &component, problems),
            "add_parameter" => {
                component.parameters.push(call.argument(0).to_owned());
                parameter(call, source, problems);
            }
            "add_interface_port" => {
                let name = call.argument(1);
                let Some(port) = role_port(call, problems) else { continue };
                if !component.has_interface(&port.interface) {
                    problems.add(&call.place, format!("there is no interface `{}`: add it first", port.interface));
                }
                match module_ports.iter().find(|module_port| module_port.name == name) {
                    None => problems.add(&call.place, format!("{module} has no port `{name}`: mend the name")),
                    Some(module_port) => same_port(call, &port, module_port, problems),
                }
                if let Some(taken) = module_ports.iter().find(|port| port.name == name) {
                    if covered.contains(&name) {
                        problems.add(&call.place, format!("port `{name}` is in an interface already: keep one"));
                    }
                    covered.push(&taken.name);
                }
                component.ports.push(port);
            }
            _ => {}
        }
    }
    for port in module_ports.iter().filter(|port| !covered.contains(&port.name.as_str())) {
        problems.add(&port.place, format!("port `{}` is in no interface: add it to {}", port.name, start.file));
    }
    component
}

fn role_port(call: &Call, problems: &mut Problems) -> Option<RolePort> {
    let direction = match call.argument(3) {
        "Input" => Direction::Input,
        "Output" => Direction::Output,
        "Bidir" => Direction::Bidirectional,
        other => {
            problems.add(&call.place, format!("`{other}` is no direction: write Input, Output or Bidir"));
            return None;
        }
    };
    let Ok(width) = call.argument(4).parse() else {
        problems.add(&call.place, format!("`{}` is no width: write a number of bits", call.argument(4)));
        return None;
    };
    let [interface, role] = [call.argument(0), call.argument(2)].map(str::to_owned);
    Some(RolePort { place: call.place.clone(), interface, role, direction, width })
}

fn same_port(call: &Call, port: &RolePort, module_port: &Port, problems: &mut Problems) {
    let name = &module_port.name;
    if port.direction != module_port.direction {
        let message =
            format!("`{name}` is {:?} here and {:?} in {}", port.direction, module_port.direction, module_port.place);
        problems.add(&call.place, message);
    }
    match module_port.width {
        None => problems.add(&module_port.place, format!("the width of `{name}` is no plain number: write one")),
        Some(width) if width != port.width => {
            problems.add(
                &call.place,
                format!("`{name}` has {} bits here and {width} in {}", port.width, module_port.place),
            );
        }
        Some(_) => {}
    }
}

/// `associatedClock` and its like name an interface that is there.
fn property(call: &Call, component: &Component, problems: &mut Problems) {
    let [interface, property, value] = [0, 1, 2].map(|index| call.argument(index));
    let names = if property.starts_with("associated") { vec![interface, value] } else { vec![interface] };
    for name in names.into_iter().filter(|name| !component.has_interface(name)) {
        problems.add(&call.place, format!("there is no interface `{name}`: mend the name or add it first"));
    }
}

/// A parameter is the module's, with the module's default.
fn parameter(call: &Call, source: &Source, problems: &mut Problems) {
    let [name, default] = [call.argument(0), call.argument(2)];
    let text = source.header().and_then(|header| header.parameters).map_or("", |range| &source.text[range]);
    let of_module = text.split(',').find_map(|item| {
        let (before, value) = item.split_once('=')?;
        (before.split_whitespace().last() == Some(name)).then(|| value.trim())
    });
    match of_module {
        None => problems.add(&call.place, format!("{} has no parameter `{name}`: mend the name", source.path)),
        Some(value) if value != default => {
            problems.add(&call.place, format!("`{name}` is {default} by default here and {value} in {}", source.path));
        }
        Some(_) => {}
    }
}
