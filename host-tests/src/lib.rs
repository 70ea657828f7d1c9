//! Tests that need more than one crate, and what they compare with.
//!
//! The tests are in `tests/`, one idea a file. This library holds the references: each is worked
//! out in another way than the code under test, in `f64` or in wide integers, and as plainly as
//! can be.
//!
//! | module | holds |
//! | --- | --- |
//! | [`float_matrix`] | OpenGL's matrices and the viewport in `f64` |
//! | [`twin`] | one transformation twice, in `f64` and as the code under test makes it |
//! | [`visible_part`] | which pixels see a triangle in clip space, without clipping it |
//! | [`exact_triangle`] | which pixels a screen triangle covers, by the definition; its depth as a fraction |
//! | [`packet_pixels`] | which pixels a packet covers and at which depth, by the formats' definition |
//! | [`collect`] | a sink that keeps what `geometry` draws |
//! | [`lent`] | a software model with memory of its own |
//! | [`rng`] | random numbers that are the same in every run |
#![forbid(unsafe_code)]

pub mod collect;
pub mod exact_triangle;
pub mod float_matrix;
pub mod lent;
pub mod packet_pixels;
pub mod rng;
pub mod twin;
pub mod visible_part;
