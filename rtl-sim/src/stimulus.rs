//! Words for the device: random numbers that repeat, triangles from vertices, and words that no setup makes.

pub mod random;
pub mod shapes;
