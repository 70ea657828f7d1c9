//! Small programs on the simulated board.

mod access;
mod caches;
mod common;
