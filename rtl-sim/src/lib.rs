//! Halfspace's FPGA as Verilator sees it: the design in `rtl/` behind a Rust type.
//!
//! | module | holds |
//! | --- | --- |
//! | [`rtl`] | [`Rtl`]: bus writes and reads, clocks, and a look into the memories |
//! | [`vga`] | [`Frame`]: a picture taken from the VGA pins, with its timing checked |
//! | [`memories`] | [`Memories`]: the buffers as they stand |
//! | `wave` | reads back what [`Rtl::record_wave`] writes; with the feature `waves` |
//! | [`stimulus`] | words to give it: triangles from vertices, garbage |
//! | [`replay`] | a stream's frames, and what each costs |
//! | [`bench`] | how many clocks work takes |
//!
//! `build.rs` verilates the design for 1, 2, 4 and 8 pixel units, assertions on.

pub mod bench;
mod calls;
pub mod memories;
pub mod replay;
pub mod rtl;
pub mod stimulus;
pub mod vga;
#[cfg(feature = "waves")]
pub mod wave;

pub use memories::Memories;
pub use rtl::{Rtl, UNITS};
pub use vga::Frame;
