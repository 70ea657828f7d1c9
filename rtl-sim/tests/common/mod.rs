//! What the tests share: random numbers, triangles from vertices, and the device next to its model.
#![allow(dead_code, reason = "every test binary uses its own part")]

pub mod pair;
pub mod random;
pub mod shapes;
