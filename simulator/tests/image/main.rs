//! The image that is flashed, on the simulated board: its start, and everything that can go wrong around it.
//!
//! `cargo xtask test --only simulator` builds the image and runs these tests.

mod board;
mod bridges;
mod caches;
mod configuration;
mod fpga_faults;
mod line;
mod pad;
mod resets;
mod start;
mod stops;
mod usb;
