//! Reading a device's reports, for as long as it is there.

use core::cell::Cell;
use core::convert::Infallible;

use embassy_futures::select::{Either, select};
use embassy_futures::yield_now;
use embassy_usb_driver::host::{PipeError, UsbHostAllocator, UsbPipe, pipe};

use crate::descriptor::{HidInterface, PACKET_MAXIMUM};
use crate::link::Link;
use crate::reader::{Reader, Reading, low_battery};
use crate::setup::Setup;
use crate::timing::{READ_ERRORS_MAXIMUM, READ_PAUSE_US};
use crate::{Clock, Event, Fault, Step, dualshock3};

/// Packets of one device that one poll takes at most.
const PACKETS_A_ROUND: u32 = 4;

/// What is remembered of a device from one report to the next.
#[derive(Default)]
struct Course {
    /// It has sent a report.
    reported: Cell<bool>,
    /// Failed transfers in a row.
    errors: Cell<u32>,
    /// A short report was told of.
    short_told: Cell<bool>,
    /// A low battery was told of.
    battery_told: Cell<bool>,
}

/// Reads reports until the device fails for good.
pub(crate) async fn serve<'d, A: UsbHostAllocator<'d>, K: Clock>(
    link: Link<'_, A, K>,
    hid: HidInterface,
    reader: &Reader,
) -> Result<Infallible, Fault> {
    let course = Course::default();
    let mut pipe = link.interrupt_pipe::<pipe::In>(Step::Reports, hid.input).await?;
    loop {
        let outputs = async {
            match reader {
                Reader::DualShock3 => dualshock3::outputs(&link, &hid, &course.reported).await,
                _ => core::future::pending().await,
            }
        };
        let packet = usize::from(hid.input.packet);
        let error = match select(read(&link, &mut pipe, packet, reader, &course), outputs).await {
            Either::First(error) => error,
            Either::Second(never) => match never {},
        };
        let errors = course.errors.get();
        if errors >= READ_ERRORS_MAXIMUM {
            return Err(Fault::Transfer { doing: Step::Reports, error });
        }
        course.errors.set(errors + 1);
        link.bus.sleep(READ_PAUSE_US << errors).await;
        if error == PipeError::Stall {
            link.write(Step::Reports, Setup::clear_halt(0x80 | hid.input.number), &[]).await?;
            pipe.reset_data_toggle();
        }
    }
}

/// Reads reports until a transfer fails.
async fn read<'d, A: UsbHostAllocator<'d>, K: Clock>(
    link: &Link<'_, A, K>,
    pipe: &mut impl UsbPipe<pipe::Interrupt, pipe::In>,
    packet: usize,
    reader: &Reader,
    course: &Course,
) -> PipeError {
    let memory = link.bus.memory;
    let mut report = [0; PACKET_MAXIMUM as usize];
    let (mut filled, mut round, mut packets) = (0, memory.round.get(), 0);
    loop {
        // A slice of exactly one packet: it ends at a short packet or when the report is whole, whatever
        // a controller makes of a longer one.
        let count = match pipe.request_in(&mut report[filled..filled + packet]).await {
            Ok(count) => count.min(packet),
            Err(error) => return error,
        };
        course.errors.set(0);
        filled += count;
        if count < packet || filled >= reader.length() || filled + packet > report.len() {
            take(link, reader.read(&report[..filled]), filled, course).await;
            filled = 0;
        }
        if round != memory.round.get() {
            (round, packets) = (memory.round.get(), 0);
        }
        packets += 1;
        if packets >= PACKETS_A_ROUND {
            yield_now().await;
        }
    }
}

/// Tells what a report of some bytes says.
async fn take<'d, A: UsbHostAllocator<'d>, K: Clock>(
    link: &Link<'_, A, K>,
    reading: Reading,
    length: usize,
    course: &Course,
) {
    let device = link.route.place;
    match reading {
        Reading::Keyboard(report) => {
            course.reported.set(true);
            link.bus.tell(Event::KeyboardReport { device, report }).await;
        }
        Reading::Pad(report) => {
            course.reported.set(true);
            link.bus.tell(Event::PadReport { device, report }).await;
            let low = low_battery(&report);
            if let (Some(battery), false) = (low, course.battery_told.get()) {
                link.bus.tell(Event::BatteryLow { device, battery }).await;
            }
            course.battery_told.set(low.is_some());
        }
        Reading::Short if !course.short_told.replace(true) => {
            link.bus.tell_fault(device, Fault::Report { length: length as u8 }).await;
        }
        Reading::Short | Reading::Nothing => {}
    }
}
