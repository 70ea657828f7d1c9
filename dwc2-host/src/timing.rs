//! Every wait, with the paragraph that asks for it. Microseconds.

/// What may pass in one visit between its look at the clock and its last access: every wait of the port's is longer by
/// that. Ours.
pub(crate) const VISIT_US: u64 = 500;
/// A connection must last this long before the reset: TATTDB, USB 2.0 §7.1.7.3.
pub(crate) const DEBOUNCE_US: u64 = 100_000;
/// Reset on a root port: TDRSTR, USB 2.0 §7.1.7.5.
pub(crate) const ROOT_RESET_US: u64 = 50_000;
/// What a device may take to recover from a reset: TRSTRCY, USB 2.0 §7.1.7.5.
pub(crate) const RESET_RECOVERY_US: u64 = 10_000;
/// The port enables itself within microseconds of the end of a reset (hardware facts §4.3); ours to give up.
pub(crate) const ENABLE_LIMIT_US: u64 = 20_000;
/// What the core needs to change its role once it is forced: Linux, `dwc2_force_mode`.
pub(crate) const FORCE_HOST_US: u64 = 25_000;
/// Past that the core does not become a host: Linux waits 50 to 110 ms.
pub(crate) const FORCE_HOST_LIMIT_US: u64 = 110_000;
/// Past that a soft reset, a flush, or the bus master's last beat does not end any more: Linux gives each 10 ms.
pub(crate) const SELF_CLEARING_LIMIT_US: u64 = 10_000;
/// Past that a channel that was told to halt does not. A packet takes at most 1.4 ms (1,023 bytes at full speed).
pub(crate) const HALT_LIMIT_US: u64 = 10_000;
/// After a fault, before the core is started anew; ours.
pub(crate) const FAULT_PAUSE_US: u64 = 1_000_000;
/// A transaction translator has an answer by then: its bulk and control share of several frames (USB 2.0 §11.17), and ours to give up.
pub(crate) const SPLIT_DRAIN_US: u64 = 20_000;
/// Between two tries of a start split that was answered by NAK three times: Linux, `hcd_queue.c`.
pub(crate) const NAK_PAUSE_US: u64 = 1_000;
/// A frame, USB 2.0 §8.4.3.1.
pub(crate) const FRAME_US: u64 = 1_000;
/// A microframe, USB 2.0 §8.4.3.1.
pub(crate) const MICROFRAME_US: u64 = 125;
