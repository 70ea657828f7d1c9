//! The tools behind `cargo xtask`: everything a person or CI does with Halfspace starts here.
//!
//! | module | its one idea |
//! | --- | --- |
//! | [`cli`] | the commands and their flags |
//! | [`commands`] | one file per command |
//! | [`setup`] | makes this machine able: Rust target, QEMU, Verilator |
//! | [`firmware_build`] | builds a board's ELF file; [`cargo_build`] runs cargo for it |
//! | [`boot`] | from nothing to a firmware that runs |
//! | [`qemu`] | one running QEMU with its console, link and log; [`qmp`] is its remote control |
//! | [`machine`] | QEMU, or this process, as something that is stepped frame by frame |
//! | [`session`] | what a controller said, frame by frame, and playing it on a machine |
//! | [`fake_pad`] | a DualShock 3 for QEMU that says what it is told to |
//! | [`demo`] | the demonstration session on a machine; [`report`] what it took, [`golden`] what it must show |
//! | [`recorded_game`] | the recorded game, replayed |
//! | [`render`] | a model file to a picture |
//! | [`stream`] | files of packet words |
//! | [`software_fpga`] | the FPGA's software model with memory of its own |
//! | [`simulated`] | the DE1-SoC's simulator, as a program that is started |
//! | [`verilated`] | the FPGA's design in Verilator, as a program that is started |
//! | [`prove`], [`yosys`] | theorems about the FPGA's design, proven |
//! | [`measure`] | what a vertex, a triangle and a pixel cost; [`code_size`] what the USB code takes, [`usb_cost`] what it does |
//! | [`fill`] | what more pixel units bring; [`plot`] draws it |
//! | [`card`] | what goes on the DE1-SoC's SD card |
//! | [`frame_model`] | how long a frame would take on the board, and what bounds it |
//! | [`checks`] | the steps of `cargo xtask test` |
//! | [`generated`] | the files that are written from one source and committed |
//! | [`model`] | a model from a file as a mesh |
//! | [`log_decoder`] | turns the firmware's defmt bytes into text |
//! | [`picture`] | RGB pictures, PNG, animated PNG and depth files |
//! | [`progress`], [`table`] | what is said while working, and what is shown at the end |
//! | [`paths`] | where the workspace is and where results go |

#![forbid(unsafe_code)]

#[cfg(not(unix))]
compile_error!("xtask talks to QEMU over Unix sockets: build it on Linux, macOS or in WSL");

pub mod area;
pub mod boot;
pub mod card;
pub mod cargo_build;
pub mod checks;
pub mod cli;
pub mod code_size;
pub mod commands;
pub mod console;
pub mod demo;
pub mod fake_pad;
pub mod fill;
pub mod firmware_build;
pub mod found_mesh;
pub mod frame_model;
pub mod generated;
pub mod golden;
pub mod log_decoder;
pub mod machine;
pub mod measure;
pub mod model;
pub mod paths;
pub mod picture;
pub mod plot;
pub mod progress;
pub mod prove;
pub mod qemu;
pub mod qmp;
pub mod recorded_game;
pub mod render;
pub mod report;
pub mod session;
pub mod setup;
pub mod simulated;
pub mod software_fpga;
pub mod stream;
pub mod table;
pub mod usb_cost;
pub mod verilated;
pub mod yosys;

#[cfg(test)]
mod test_elf;
#[cfg(test)]
mod test_random;
