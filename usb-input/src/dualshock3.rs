//! What a DualShock 3 wants to be told.

use core::cell::Cell;
use core::convert::Infallible;
use core::future::poll_fn;
use core::task::Poll;

use crate::bring_up::unless_refused;
use crate::descriptor::HidInterface;
use crate::link::Link;
use crate::setup::{ReportType, Setup};
use crate::timing::PULSE_US;
use crate::{Fault, Identity, Step};

/// idVendor and idProduct.
pub(crate) const PRODUCT: (u16, u16) = (0x054C, 0x0268);

/// Length of output report 0x01 without its id (Linux `hid-sony.c`).
const OUTPUT_LENGTH: usize = 35;

/// Tells the pad to send reports, which it does not by itself.
///
/// Reading feature report 0xF2 does for Linux, writing 0xF4 for many others; both go out, and either may be refused.
/// Pads made by others want 0xF5 read and a byte written to their interrupt endpoint as well, but for
/// ShanWan's, which that makes shake for ever (Linux `hid-sony.c`). How these two end does not matter.
pub(crate) async fn wake(link: &Link<'_>, hid: &HidInterface, identity: &Identity) -> Result<(), Fault> {
    const DOING: Step = Step::Wake;
    let get_feature = |id| Setup::get_report(ReportType::Feature, id, hid.number);
    unless_refused(link.read(DOING, get_feature(0xF2), 17).await)?;
    if let (Ok(count), Some(output), false) =
        (link.read(DOING, get_feature(0xF5), 8).await, hid.output, is_shanwan(identity))
    {
        let byte = link.data(count).first().copied().unwrap_or(0);
        let _ = link.send(DOING, output, &[byte]).await;
    }
    let operational = Setup::set_report(ReportType::Feature, 0xF4, hid.number);
    unless_refused(link.write(DOING, operational, &[0x42, 0x0C, 0, 0]).await)?;
    Ok(())
}

fn is_shanwan(identity: &Identity) -> bool {
    const MAKER: &[u8] = b"shanwan";
    let names = [&identity.maker, &identity.name];
    names.iter().any(|name| name.as_bytes().windows(MAKER.len()).any(|part| part.eq_ignore_ascii_case(MAKER)))
}

/// Lights the player's lamp once the pad has sent its first report, which ends its own blinking, and gives a pulse
/// whenever the pose is frozen, if that is wanted. Failures are left at that.
pub(crate) async fn outputs(link: &Link<'_>, hid: &HidInterface, reported: &Cell<bool>) -> Infallible {
    let memory = link.memory;
    let player = memory.config.player;
    let setup = Setup::set_report(ReportType::Output, 0x01, hid.number);
    wait_until(|| reported.get()).await;
    loop {
        let _ = link.write(Step::Reports, setup, &output(player, false)).await;
        wait_until(|| !memory.frozen.get()).await;
        wait_until(|| memory.config.pulse_on_freeze && memory.frozen.get()).await;
        let _ = link.write(Step::Reports, setup, &output(player, true)).await;
        memory.sleep(PULSE_US).await;
    }
}

async fn wait_until(condition: impl Fn() -> bool) {
    poll_fn(|_| if condition() { Poll::Ready(()) } else { Poll::Pending }).await;
}

/// Makes output report 0x01, without its id: the small motor on or off, one of four lamps lit.
fn output(player: u8, shake: bool) -> [u8; OUTPUT_LENGTH] {
    const MOTOR_DURATION: usize = 1;
    const MOTOR: usize = 2;
    const LAMPS: usize = 9;
    const PATTERNS: usize = 10;
    /// Total time, duty, enabled, time off, time on: steady light.
    const STEADY: [u8; 5] = [0xFF, 0x27, 0x10, 0x00, 0x32];
    let mut report = [0; OUTPUT_LENGTH];
    if shake {
        // Some units of about 20 ms, should the word to stop be lost.
        report[MOTOR_DURATION] = 0x10;
        report[MOTOR] = 1;
    }
    if let 1..=4 = player {
        report[LAMPS] = 1 << player;
    }
    for pattern in report[PATTERNS..].chunks_exact_mut(STEADY.len()).take(4) {
        pattern.copy_from_slice(&STEADY);
    }
    report
}

#[cfg(test)]
mod tests {
    use super::output;

    /// What Linux was seen to send for the first player.
    #[test]
    fn the_lamps_are_as_on_the_wire() {
        let mut wanted = [0; 35];
        wanted[9] = 0x02;
        for pattern in wanted[10..30].chunks_mut(5) {
            pattern.copy_from_slice(&[0xFF, 0x27, 0x10, 0x00, 0x32]);
        }
        assert_eq!(output(1, false), wanted);
        assert_eq!([output(4, false)[9], output(0, false)[9], output(5, false)[9]], [0x10, 0, 0]);
    }

    #[test]
    fn a_pulse_is_the_small_motor() {
        assert_eq!(output(1, true)[1..5], [0x10, 1, 0, 0]);
    }
}
