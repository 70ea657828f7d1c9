//! Verilates the design once for each number of pixel units and compiles it with a C interface.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

/// Builds: pixel units.
const UNITS: [u32; 4] = [1, 2, 4, 8];

fn main() {
    let here = PathBuf::from(env::var("CARGO_MANIFEST_DIR").expect("cargo sets it"));
    let out = PathBuf::from(env::var("OUT_DIR").expect("cargo sets it"));
    let rtl = here.join("../rtl");
    let top = here.join("verilog/halfspace_sim.sv");
    let list = rtl.join("files.f");
    let mut sources: Vec<PathBuf> = fs::read_to_string(&list)
        .unwrap_or_else(|error| panic!("cannot read {}: {error}", list.display()))
        .lines()
        .filter(|line| !line.starts_with("//") && !line.is_empty())
        .map(|line| rtl.join(line))
        .collect();
    sources.push(top);
    for path in
        sources.iter().chain([&list, &here.join("src/shim.cpp"), &rtl.join("lint/waivers.vlt"), &here.join("build.rs")])
    {
        println!("cargo::rerun-if-changed={}", path.display());
    }

    let root = verilator_root();
    let waivers = rtl.join("lint/waivers.vlt");
    std::thread::scope(|scope| {
        for units in UNITS {
            let (sources, waivers, root, here, out) = (&sources, &waivers, &root, &here, &out);
            scope.spawn(move || {
                verilate(units, sources, waivers, out);
                compile(units, root, here, out);
            });
        }
    });
    // What all builds share.
    let mut runtime = compiler(&root);
    for file in ["verilated.cpp", "verilated_threads.cpp"] {
        runtime.file(root.join("include").join(file));
    }
    runtime.compile("verilated");
}

fn verilate(units: u32, sources: &[PathBuf], waivers: &Path, out: &Path) {
    let status = Command::new("verilator")
        .args(["--cc", "--threads", "1", "-O3", "--x-assign", "fast", "--x-initial", "fast", "--assert"])
        .args(["--top-module", "halfspace_sim", "--prefix", &prefix(units)])
        .arg(format!("-GPixelUnits={units}"))
        // A word that is given up after 42 ms at 50 MHz: more than a frame, so that swaps are waited for.
        .args(["-GFifoPatience=2000000"])
        .arg("--Mdir")
        .arg(out.join(prefix(units)))
        .arg(waivers)
        .args(sources)
        .status()
        .unwrap_or_else(|error| panic!("cannot run verilator ({error}): apt-get install verilator"));
    assert!(status.success(), "verilator refused the design");
}

fn compile(units: u32, root: &Path, here: &Path, out: &Path) {
    let folder = out.join(prefix(units));
    let mut build = compiler(root);
    build
        .include(&folder)
        // The shim's object would have the same name in every build.
        .out_dir(&folder)
        .define("UNITS", units.to_string().as_str())
        .define("MODEL", prefix(units).as_str())
        .define("HEADER", format!("\"{}.h\"", prefix(units)).as_str())
        .file(here.join("src/shim.cpp"));
    for entry in fs::read_dir(&folder).expect("verilator has made it") {
        let path = entry.expect("readable").path();
        if path.extension().is_some_and(|extension| extension == "cpp") {
            build.file(path);
        }
    }
    build.compile(&format!("halfspace_{units}"));
}

fn compiler(root: &Path) -> cc::Build {
    let mut build = cc::Build::new();
    build
        .cpp(true)
        .std("c++17")
        .opt_level(3)
        .debug(false)
        .force_frame_pointer(false)
        .warnings(false)
        .flag("-fno-strict-aliasing")
        .define("VERILATOR", "1")
        .define("VM_COVERAGE", "0")
        .define("VM_SC", "0")
        .define("VM_TRACE", "0")
        .include(root.join("include"))
        .include(root.join("include/vltstd"));
    build
}

fn prefix(units: u32) -> String {
    format!("Vhalfspace{units}")
}

/// Asks Verilator where its run-time sources lie.
fn verilator_root() -> PathBuf {
    let output = Command::new("verilator")
        .args(["--getenv", "VERILATOR_ROOT"])
        .output()
        .unwrap_or_else(|error| panic!("cannot run verilator ({error}): apt-get install verilator"));
    PathBuf::from(String::from_utf8(output.stdout).expect("a path in UTF-8").trim())
}
