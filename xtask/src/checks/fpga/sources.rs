//! The project lists the sources of `rtl/files.f`, and every file that it lists is there.

use std::path::Path;

use super::Problems;
use super::script::Call;

/// Where the generated system's sources come to lie; made by every build.
const GENERATED: &str = "halfspace_system/";

/// Checks the component's files against `rtl/files.f`.
pub(super) fn component(root: &Path, list: &[String], calls: &[Call], problems: &mut Problems) {
    let added: Vec<&Call> = calls.iter().filter(|call| call.name == "add_fileset_file").collect();
    exist(root, &added, 3, problems);
    let names: Vec<&str> = added.iter().map(|call| call.argument(0)).collect();
    if names != list {
        let missing: Vec<&str> = list.iter().map(String::as_str).filter(|name| !names.contains(name)).collect();
        let extra: Vec<&str> = names.iter().copied().filter(|name| !list.iter().any(|own| own == name)).collect();
        problems.add_file(
            "fpga/ip/halfspace_hw.tcl",
            format!("its sources are not those of rtl/files.f in their order (missing: {missing:?}, extra: {extra:?})"),
        );
    }
}

/// Checks that the files of a component or project are there.
pub(super) fn files(root: &Path, calls: &[Call], problems: &mut Problems) {
    let added: Vec<&Call> = calls.iter().filter(|call| call.name == "add_fileset_file").collect();
    exist(root, &added, 3, problems);
    let assigned = calls.iter().filter(|call| {
        call.name == "set_global_assignment" && call.after("-name").is_some_and(|name| name.ends_with("_FILE"))
    });
    let listed: Vec<&Call> = assigned.filter(|call| !call.argument(2).starts_with(GENERATED)).collect();
    exist(root, &listed, 2, problems);
}

fn exist(root: &Path, calls: &[&Call], argument: usize, problems: &mut Problems) {
    for call in calls {
        let path = call.argument(argument);
        if !root.join(path).is_file() {
            problems.add(&call.place, format!("there is no file {path}: mend the path"));
        }
    }
}

/// Returns the names that `rtl/files.f` lists.
pub(super) fn list(text: &str) -> Vec<String> {
    text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with("//")).map(str::to_owned).collect()
}
