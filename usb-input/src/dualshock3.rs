//! What a DualShock 3 wants to be told.

use core::cell::Cell;
use core::convert::Infallible;
use core::future::poll_fn;
use core::task::Poll;

use embassy_usb_driver::host::{PipeError, UsbHostAllocator, UsbPipe, pipe};

use crate::descriptor::HidInterface;
use crate::link::Link;
use crate::setup::{ReportType, Setup};
use crate::timing::{PULSE_US, STAGE_TIMEOUT_US};
use crate::{Clock, Fault, Identity, Step};

/// idVendor and idProduct.
pub(crate) const PRODUCT: (u16, u16) = (0x054C, 0x0268);

/// Length of output report 0x01 without its id (Linux `hid-sony.c`).
const OUTPUT_LENGTH: usize = 35;

/// Takes a refusal for an answer: not every pad knows every request.
fn unless_refused<T>(result: Result<T, Fault>) -> Result<Option<T>, Fault> {
    match result {
        Ok(value) => Ok(Some(value)),
        Err(Fault::Transfer { error: PipeError::Stall, .. }) => Ok(None),
        Err(fault) => Err(fault),
    }
}

/// Tells the pad to send reports, which it does not by itself.
///
/// Reading feature report 0xF2 does for Linux, writing 0xF4 for many others; both go out, and either may be refused.
/// Pads made by others want 0xF5 read and a byte written to their interrupt endpoint as well, but for
/// ShanWan's, which that makes shake for ever (Linux `hid-sony.c`). How these two end does not matter.
pub(crate) async fn wake<'d, A: UsbHostAllocator<'d>, K: Clock>(
    link: &Link<'_, A, K>,
    hid: &HidInterface,
    identity: &Identity,
) -> Result<(), Fault> {
    let mut answer = [0; 17];
    unless_refused(link.read(Step::Wake, get_feature(0xF2, hid), &mut answer).await)?;
    let asked = link.read(Step::Wake, get_feature(0xF5, hid), &mut answer[..8]).await.is_ok();
    if let (true, Some(output), false) = (asked, hid.output, is_shanwan(identity))
        && let Ok(mut pipe) = link.interrupt_pipe::<pipe::Out>(Step::Wake, output).await
    {
        let _ = link.bus.within(STAGE_TIMEOUT_US, pipe.request_out(&answer[..1], false)).await;
    }
    let operational = Setup::set_report(ReportType::Feature, 0xF4, hid.number);
    unless_refused(link.write(Step::Wake, operational, &[0x42, 0x0C, 0, 0]).await)?;
    Ok(())
}

fn get_feature(id: u8, hid: &HidInterface) -> Setup {
    Setup::get_report(ReportType::Feature, id, hid.number)
}

fn is_shanwan(identity: &Identity) -> bool {
    const MAKER: &[u8] = b"shanwan";
    let names = [&identity.maker, &identity.name];
    names.iter().any(|name| name.as_bytes().windows(MAKER.len()).any(|part| part.eq_ignore_ascii_case(MAKER)))
}

/// Lights the player's lamp once the pad has sent its first report, which ends its own blinking, and gives a pulse
/// whenever the pose is frozen, if that is wanted. Failures are left at that.
pub(crate) async fn outputs<'d, A: UsbHostAllocator<'d>, K: Clock>(
    link: &Link<'_, A, K>,
    hid: &HidInterface,
    reported: &Cell<bool>,
) -> Infallible {
    let memory = link.bus.memory;
    let player = memory.config.player;
    wait_until(|| reported.get()).await;
    let _ = send(link, hid, &output(player, false)).await;
    loop {
        wait_until(|| !memory.frozen.get()).await;
        wait_until(|| memory.config.pulse_on_freeze && memory.frozen.get()).await;
        let _ = send(link, hid, &output(player, true)).await;
        link.bus.sleep(PULSE_US).await;
        let _ = send(link, hid, &output(player, false)).await;
    }
}

async fn wait_until(condition: impl Fn() -> bool) {
    poll_fn(|_| if condition() { Poll::Ready(()) } else { Poll::Pending }).await;
}

async fn send<'d, A: UsbHostAllocator<'d>, K: Clock>(
    link: &Link<'_, A, K>,
    hid: &HidInterface,
    report: &[u8; OUTPUT_LENGTH],
) -> Result<(), Fault> {
    link.write(Step::Reports, Setup::set_report(ReportType::Output, 0x01, hid.number), report).await
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
