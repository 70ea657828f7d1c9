//! Steps that plug devices into the USB bus of QEMU's raspi2b, whose controller is the DE1-SoC's.
//!
//! The firmware tallies what it took in: how many reports of each source, and a checksum over their
//! bytes. So a report that was lost, doubled or changed shows, whatever the picture looks like.

mod keyboards;
mod pads;
mod plugging;
mod rig;
mod stalls;

pub(super) use keyboards::{behind_a_hub, on_the_root_port};
pub(super) use pads::{long_run, session_beside_a_keyboard};
pub(super) use plugging::{behind_a_hub as plugging_behind_a_hub, on_the_root_port as plugging_on_the_root_port};
pub(super) use stalls::{frame_rate, stalled_requests};
