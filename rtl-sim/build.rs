//! Verilates the design once for each number of pixel units and compiles it with a C interface.
//!
//! What Verilator writes for a width is compiled as two units, so that its headers, most of the work,
//! are read twice and not nine times: what runs every clock with `shim.cpp`, optimised, and what runs
//! at start or for a wave. As many compilers run at a time as there are processors.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;
use std::{env, fs, thread};

/// Builds: pixel units.
const UNITS: [u32; 4] = [1, 2, 4, 8];

const MISSING: &str = "install it (Debian: apt-get install verilator g++)";

fn main() {
    let here = PathBuf::from(env::var("CARGO_MANIFEST_DIR").expect("cargo sets it"));
    let design = Design::new(&here);
    let out = PathBuf::from(env::var("OUT_DIR").expect("cargo sets it"));
    let waves = env::var_os("CARGO_FEATURE_WAVES").is_some();

    thread::scope(|scope| {
        for units in UNITS {
            let (design, out) = (&design, &out);
            scope.spawn(move || design.verilate(units, waves, &out.join(prefix(units))));
        }
    });

    let runtime = verilator_root().join("include");
    let mut files = vec![runtime.join("verilated.cpp"), runtime.join("verilated_threads.cpp")];
    if waves {
        files.extend([runtime.join("verilated_fst_c.cpp"), here.join("src/wave_reader.cpp")]);
    }
    // The longest first.
    let mut jobs: Vec<Job> = files.into_iter().map(|file| Job::of(file, 1, &out)).collect();
    for units in UNITS.into_iter().rev() {
        jobs.extend(units_of(units, &here.join("src/shim.cpp"), &out.join(prefix(units))));
    }
    let mut library = compiler(&runtime, waves);
    library.objects(compile(jobs, &runtime, waves));
    library.compile("halfspace");
    if waves {
        println!("cargo::rustc-link-lib=z");
    }
}

/// The sources.
struct Design {
    waivers: PathBuf,
    sources: Vec<PathBuf>,
}

impl Design {
    /// Finds them, and has cargo watch them.
    fn new(here: &Path) -> Self {
        let rtl = here.join("../rtl");
        let list = rtl.join("files.f");
        let mut sources: Vec<PathBuf> = fs::read_to_string(&list)
            .unwrap_or_else(|error| panic!("cannot read {}: {error}", list.display()))
            .lines()
            .filter(|line| !line.starts_with("//") && !line.is_empty())
            .map(|line| rtl.join(line))
            .collect();
        sources.push(here.join("verilog/halfspace_sim.sv"));
        sources.push(here.join("verilog/public.vlt"));
        let design = Self { waivers: rtl.join("lint/waivers.vlt"), sources };
        for path in design.sources.iter().chain([&list, &design.waivers]) {
            println!("cargo::rerun-if-changed={}", path.display());
        }
        for name in ["build.rs", "src/shim.cpp", "src/wave_reader.cpp"] {
            println!("cargo::rerun-if-changed={name}");
        }
        design
    }

    /// Lets Verilator write the design's C++ for a number of pixel units to `folder`.
    fn verilate(&self, units: u32, waves: bool, folder: &Path) {
        // The files' names change with the design: older ones must not stay.
        if folder.exists() {
            fs::remove_dir_all(folder).unwrap_or_else(|error| panic!("cannot empty {}: {error}", folder.display()));
        }
        let status = Command::new("verilator")
            .args(["--cc", "--threads", "1", "-O3", "--x-assign", "fast", "--x-initial", "fast", "--assert"])
            .args(waves.then_some(["--trace-fst", "--trace-structs"]).iter().flatten())
            .args(["--top-module", "halfspace_sim", "--prefix", &prefix(units)])
            .arg(format!("-GPixelUnits={units}"))
            // A word that is given up after 42 ms at 50 MHz: more than a frame, so that swaps are waited for.
            .args(["-GFifoPatience=2000000"])
            .arg("--Mdir")
            .arg(folder)
            .arg(&self.waivers)
            .args(&self.sources)
            .status()
            .unwrap_or_else(|error| panic!("cannot run verilator ({error}): {MISSING}"));
        assert!(status.success(), "verilator refused the design: its words stand above");
    }
}

/// A file for the C++ compiler.
struct Job {
    source: PathBuf,
    optimisation: u32,
    folder: PathBuf,
}

impl Job {
    fn of(source: PathBuf, optimisation: u32, folder: &Path) -> Self {
        Self { source, optimisation, folder: folder.into() }
    }
}

/// Gathers a width's C++ in two units of compilation: what runs every clock, and what runs once.
fn units_of(units: u32, shim: &Path, folder: &Path) -> [Job; 2] {
    let prefix = prefix(units);
    let (mut often, mut once) = (String::new(), String::new());
    for entry in fs::read_dir(folder).expect("verilator has made it") {
        let path = entry.expect("readable").path();
        let name = path.file_name().and_then(|name| name.to_str()).expect("a name in ASCII");
        if name.starts_with(&prefix) && name.ends_with(".cpp") {
            let every_clock = name.ends_with("__0.cpp") && !name.contains("__Trace__");
            let unit = if every_clock { &mut often } else { &mut once };
            unit.push_str(&format!("#include \"{name}\"\n"));
        }
    }
    often.push_str(&format!(
        "#define UNITS {units}\n#define MODEL {prefix}\n#define HEADER \"{prefix}.h\"\n\
         #define ROOT_HEADER \"{prefix}___024root.h\"\n#include \"{}\"\n",
        shim.display()
    ));
    [("often.cc", often, 3), ("once.cc", once, 0)].map(|(name, text, optimisation)| {
        let source = folder.join(name);
        fs::write(&source, text).unwrap_or_else(|error| panic!("cannot write {}: {error}", source.display()));
        Job::of(source, optimisation, folder)
    })
}

/// Compiles, in parallel, and returns the objects.
fn compile(jobs: Vec<Job>, runtime: &Path, waves: bool) -> Vec<PathBuf> {
    let (jobs, objects) = (Mutex::new(jobs.into_iter()), Mutex::new(Vec::new()));
    let next = || jobs.lock().expect("no thread panicked").next();
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                while let Some(job) = next() {
                    let mut build = compiler(runtime, waves);
                    build.opt_level(job.optimisation).include(&job.folder).out_dir(&job.folder).file(job.source);
                    objects.lock().expect("no thread panicked").extend(build.compile_intermediates());
                }
            });
        }
    });
    objects.into_inner().expect("no thread panicked")
}

fn compiler(runtime: &Path, waves: bool) -> cc::Build {
    let mut build = cc::Build::new();
    let switch = |on: bool| if on { "1" } else { "0" };
    build
        .cpp(true)
        .std("c++17")
        .debug(false)
        .force_frame_pointer(false)
        .warnings(false)
        .flag("-fno-strict-aliasing")
        .define("VERILATOR", "1")
        .define("VM_COVERAGE", "0")
        .define("VM_SC", "0")
        .define("VM_TRACE", switch(waves))
        .define("VM_TRACE_FST", switch(waves))
        .include(runtime)
        .include(runtime.join("vltstd"));
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
        .unwrap_or_else(|error| panic!("cannot run verilator ({error}): {MISSING}"));
    PathBuf::from(String::from_utf8(output.stdout).expect("a path in UTF-8").trim())
}
