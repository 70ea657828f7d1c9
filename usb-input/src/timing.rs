//! Every wait, and who asks for it. All in microseconds.

const MILLISECOND: u64 = 1_000;
const SECOND: u64 = 1_000_000;

/// A port's connection has to be steady this long before its reset: TATTDB, USB 2.0 §7.1.7.3.
pub(crate) const PORT_DEBOUNCE_US: u64 = 100 * MILLISECOND;
/// How often a port is asked whether its reset is over. The hub drives it for 10 to 20 ms: TDRST,
/// USB 2.0 §7.1.7.5, §11.5.1.5.
pub(crate) const PORT_RESET_STEP_US: u64 = 10 * MILLISECOND;
/// When a port's reset that did not end has failed: ten times TDRST's maximum.
pub(crate) const PORT_RESET_TIMEOUT_US: u64 = 200 * MILLISECOND;
/// After a reset a device may be deaf this long: TRSTRCY, USB 2.0 §7.1.7.5.
pub(crate) const RESET_RECOVERY_US: u64 = 10 * MILLISECOND;
/// After SET_ADDRESS a device may be deaf this long: USB 2.0 §9.2.6.3.
pub(crate) const ADDRESS_RECOVERY_US: u64 = 2 * MILLISECOND;
/// The unit of a hub's bPwrOn2PwrGood: USB 2.0 §11.23.2.1.
pub(crate) const POWER_GOOD_UNIT_US: u64 = 2 * MILLISECOND;
/// A device has this long for each packet of a data stage: USB 2.0 §9.2.6.4. For a standard request
/// without one §9.2.6.4 grants 50 ms, for a class's nothing but [`CONTROL_TIMEOUT_US`] holds; both
/// get as long as one packet, because slow keyboards take more than 50 ms.
pub(crate) const STAGE_TIMEOUT_US: u64 = 500 * MILLISECOND;
/// No request takes longer: USB 2.0 §9.2.6.1.
pub(crate) const CONTROL_TIMEOUT_US: u64 = 5 * SECOND;
/// When a device that is not ready yet has failed, from the end of its reset on. Ours: as long as the longest
/// request, because others wait for their turn meanwhile.
pub(crate) const READY_TIMEOUT_US: u64 = CONTROL_TIMEOUT_US;
/// Between a device's failure and its next reset. Ours.
pub(crate) const RETRY_PAUSE_US: u64 = 100 * MILLISECOND;
/// How often a device is reset before it is given up. Ours.
pub(crate) const ATTEMPTS: u8 = 3;
/// After so many attempts, the root port's device is reset this seldom: it may be a hub on the board,
/// which nobody can plug in again. Ours.
pub(crate) const ROOT_RETRY_PAUSE_US: u64 = 10 * SECOND;
/// The pause after a failed interrupt transfer; it doubles from one to the next. Ours.
pub(crate) const READ_PAUSE_US: u64 = 10 * MILLISECOND;
/// Failed interrupt transfers in a row before the device has failed; with the doubling, 1.27 s: longer than any
/// hub takes to tell that the device was unplugged (bInterval at most 255 ms). Ours.
pub(crate) const READ_ERRORS_MAXIMUM: u32 = 7;
/// How long a DualShock 3 shakes when the pose is frozen. Ours.
pub(crate) const PULSE_US: u64 = 80 * MILLISECOND;
