//! Hands the linker the scripts of cortex-a-rt and defmt, and the board's memory map.
//!
//! Does nothing for a host build, or when no board's feature is on.

use std::{env, path::Path};

/// What QEMU's vexpress-a9, run with at least 256 MiB (`-m 256M`), has in place of the root
/// memory.x' numbers. The display's frames follow the data, at 0x68000000.
/// `src/vexpress_a9/memory_map.rs` maps the same addresses for the MMU.
const VEXPRESS_A9: [(&str, u32); 4] = [
    ("_code_start", 0x6000_0000),
    ("_data_start", 0x6100_0000),
    ("_data_length", 112 << 20),
    ("_l2_cache_controller", 0x1E00_A000),
];

/// QEMU's raspi2b takes the image where the DE1-SoC does. The Cortex-A7 has no PL310.
const RASPI2B: [(&str, u32); 1] = [("_l2_cache_controller", 0)];

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=../memory.x");
    println!("cargo::rerun-if-env-changed=DEFMT_LOG");
    if env::var("CARGO_CFG_TARGET_ARCH").as_deref() != Ok("arm") {
        return;
    }
    let board = |feature: &str| env::var_os(format!("CARGO_FEATURE_{feature}")).is_some();
    let (vexpress_a9, raspi2b) = (board("VEXPRESS_A9"), board("RASPI2B"));
    if !vexpress_a9 && !raspi2b && !board("DE1_SOC") {
        return;
    }
    let crate_root = env::var("CARGO_MANIFEST_DIR").expect("cargo sets CARGO_MANIFEST_DIR");
    let workspace = Path::new(&crate_root).parent().expect("the crate lies in the workspace");
    println!("cargo::rustc-link-search={}", workspace.display());
    println!("cargo::rustc-link-arg-bins=-Tlink.x");
    let symbols: &[(&str, u32)] = if vexpress_a9 {
        &VEXPRESS_A9
    } else if raspi2b {
        &RASPI2B
    } else {
        &[]
    };
    for (symbol, value) in symbols {
        println!("cargo::rustc-link-arg-bins=--defsym={symbol}={value:#x}");
    }
    if vexpress_a9 {
        println!("cargo::rustc-link-arg-bins=-Tdefmt.x");
        // defmt's own default leaves all but errors out.
        if env::var_os("DEFMT_LOG").is_none() {
            println!("cargo::rustc-env=DEFMT_LOG=info");
        }
    }
}
