//! Verilates the design once for each number of pixel units, and once with all else different, and compiles it with
//! a C interface.
//!
//! What Verilator writes for a build is compiled as two units, so that its headers, most of the work,
//! are read twice and not nine times: what runs every clock with `shim.cpp`, optimised, and what runs
//! at start or for a wave. As many compilers run at a time as there are processors.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;
use std::{env, fs, thread};

/// A configuration of the design.
struct Build {
    /// Its name in the C interface.
    name: &'static str,
    units: u32,
    /// What Verilator is told besides.
    arguments: &'static [&'static str],
}

/// Begins as costs least.
const FAST: &[&str] = &["--x-assign", "fast", "--x-initial", "fast"];
const BUILDS: [Build; 5] = [
    Build { name: "1", units: 1, arguments: FAST },
    Build { name: "2", units: 2, arguments: FAST },
    Build { name: "4", units: 4, arguments: FAST },
    Build { name: "8", units: 8, arguments: FAST },
    // Whatever has no reset, or no value, gets one at run time, by a seed.
    Build {
        name: "scrambled",
        units: 2,
        arguments: &["--x-assign", "unique", "--x-initial", "unique", "-GFifoDepth=64", "-GInterruptWired=1'b0"],
    },
];

/// What `shim.cpp` is made of.
const SHIM: [&str; 5] =
    ["src/shim.cpp", "src/shim/falling_edges.h", "src/shim/scan.h", "src/shim/unwatched.h", "src/shim/wave.h"];

const MISSING: &str = "install it (Debian: apt-get install verilator g++)";

fn main() {
    let here = PathBuf::from(env::var("CARGO_MANIFEST_DIR").expect("cargo sets it"));
    let design = Design::new(&here);
    let out = PathBuf::from(env::var("OUT_DIR").expect("cargo sets it"));
    let waves = env::var_os("CARGO_FEATURE_WAVES").is_some();

    thread::scope(|scope| {
        for build in &BUILDS {
            let (design, out) = (&design, &out);
            scope.spawn(move || design.verilate(build, waves, &out.join(build.prefix())));
        }
    });

    let runtime = verilator_root().join("include");
    let mut files = vec![runtime.join("verilated.cpp"), runtime.join("verilated_threads.cpp")];
    if waves {
        files.extend([runtime.join("verilated_fst_c.cpp"), here.join("src/wave_reader.cpp")]);
    }
    // The longest first.
    let mut jobs: Vec<Job> = files.into_iter().map(|file| Job::of(file, 1, &out)).collect();
    for build in BUILDS.iter().rev() {
        jobs.extend(units_of(build, &here.join("src/shim.cpp"), &out.join(build.prefix())));
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
        for name in SHIM.into_iter().chain(["build.rs", "src/wave_reader.cpp"]) {
            println!("cargo::rerun-if-changed={name}");
        }
        design
    }

    /// Lets Verilator write the design's C++ for a build to `folder`.
    fn verilate(&self, build: &Build, waves: bool, folder: &Path) {
        // The files' names change with the design: older ones must not stay.
        if folder.exists() {
            fs::remove_dir_all(folder).unwrap_or_else(|error| panic!("cannot empty {}: {error}", folder.display()));
        }
        let status = Command::new("verilator")
            .args(["--cc", "--threads", "1", "-O3", "--assert"])
            .args(build.arguments)
            .args(waves.then_some(["--trace-fst", "--trace-structs"]).iter().flatten())
            .args(["--top-module", "halfspace_sim", "--prefix", &build.prefix()])
            .arg(format!("-GPixelUnits={}", build.units))
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

/// Gathers a build's C++ in two units of compilation: what runs every clock, and what runs once.
fn units_of(build: &Build, shim: &Path, folder: &Path) -> [Job; 2] {
    let Build { name: build_name, units, .. } = build;
    let prefix = build.prefix();
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
        "#define BUILD {build_name}\n#define UNITS {units}\n#define MODEL {prefix}\n#define HEADER \"{prefix}.h\"\n\
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

impl Build {
    /// What Verilator's files and classes begin with.
    fn prefix(&self) -> String {
        format!("Vhalfspace_{}", self.name)
    }
}

/// Asks Verilator where its run-time sources lie.
fn verilator_root() -> PathBuf {
    let output = Command::new("verilator")
        .args(["--getenv", "VERILATOR_ROOT"])
        .output()
        .unwrap_or_else(|error| panic!("cannot run verilator ({error}): {MISSING}"));
    PathBuf::from(String::from_utf8(output.stdout).expect("a path in UTF-8").trim())
}
