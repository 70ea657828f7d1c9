//! Reading a device's reports, for as long as it is there.

use core::cell::Cell;
use core::convert::Infallible;

use embassy_futures::select::{Either, select};

use crate::descriptor::{HidInterface, PACKET_MAXIMUM};
use crate::link::Link;
use crate::listen::Patience;
use crate::mailbox::ListenError;
use crate::reader::{Reader, Reading, low_battery};
use crate::{Event, Fault, Step, dualshock3};

/// What is remembered of a device from one report to the next.
#[derive(Default)]
struct Course {
    /// It has sent a report.
    reported: Cell<bool>,
    /// A packet came since a transfer failed last.
    heard: Cell<bool>,
    /// A short report was told of.
    short_told: Cell<bool>,
    /// A low battery was told of.
    battery_told: Cell<bool>,
}

/// Reads reports until the device fails for good.
pub(crate) async fn serve(link: Link<'_>, hid: HidInterface, reader: &Reader) -> Result<Infallible, Fault> {
    let course = Course::default();
    let mut patience = Patience::default();
    link.listen(hid.input);
    loop {
        let outputs = async {
            match reader {
                Reader::DualShock3 => dualshock3::outputs(&link, &hid, &course.reported).await,
                _ => core::future::pending().await,
            }
        };
        let error = match select(read(&link, &hid, reader, &course), outputs).await {
            Either::First(error) => error,
            Either::Second(never) => match never {},
        };
        if course.heard.take() {
            patience = Patience::default();
        }
        patience.recover(&link, Step::Reports, hid.input, error).await?;
    }
}

/// Reads reports until a transfer fails.
async fn read(link: &Link<'_>, hid: &HidInterface, reader: &Reader, course: &Course) -> ListenError {
    let packet = usize::from(hid.input.packet);
    let mut report = [0; PACKET_MAXIMUM as usize];
    let mut filled = 0;
    loop {
        let arrival = link.mailbox().packet(|bytes| {
            let count = bytes.len().min(report.len() - filled);
            report[filled..filled + count].copy_from_slice(&bytes[..count]);
            count
        });
        let count = match arrival.await {
            Ok(count) => count,
            Err(error) => return error,
        };
        course.heard.set(true);
        filled += count;
        // A report ends with a packet that is not full, or when it is whole.
        if count < packet || filled >= reader.length() || filled + packet > report.len() {
            let reading = reader.read(&report[..filled]);
            take(link, reading, filled, course).await;
            filled = 0;
        }
    }
}

/// Tells what a report of some bytes says.
async fn take(link: &Link<'_>, reading: Reading, length: usize, course: &Course) {
    let (memory, device) = (link.memory, link.route.place);
    let event = match reading {
        Reading::Keyboard(report) => Event::KeyboardReport { device, report },
        Reading::Pad(report) => {
            course.reported.set(true);
            let low = low_battery(&report);
            if let (Some(battery), false) = (low, course.battery_told.replace(low.is_some())) {
                memory.tell(Event::BatteryLow { device, battery }).await;
            }
            Event::PadReport { device, report }
        }
        Reading::Short if !course.short_told.replace(true) => {
            Event::Fault { device, fault: Fault::Report { length: length as u8 } }
        }
        Reading::Short | Reading::Nothing => return,
    };
    memory.tell(event).await;
}
