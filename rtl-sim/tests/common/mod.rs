//! What the tests share: the device next to its model, and the stimulus of `rtl_sim`.
#![allow(dead_code, unused_imports, reason = "every test binary uses its own part")]

pub mod pair;
pub mod stream;
pub use rtl_sim::stimulus::{random, shapes};
