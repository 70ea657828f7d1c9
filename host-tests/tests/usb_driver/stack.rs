//! As much of a USB stack as the tests need: enumeration, and a hub's ports.

use dwc2_host::{Allocator, Pipe};
use embassy_usb_driver::host::pipe::{Control, In, InOut, Interrupt, Out};
use embassy_usb_driver::host::{
    DeviceEvent, PipeError, SplitInfo, SplitSpeed, UsbHostAllocator, UsbHostController, UsbPipe, pipe,
};
use embassy_usb_driver::{Direction, EndpointAddress, EndpointInfo, EndpointType, Speed};

use crate::rig::Rig;

pub type ControlPipe = Pipe<'static, Control, InOut>;

pub fn endpoint(number: usize, kind: EndpointType, input: bool, bytes: u16, interval_ms: u8) -> EndpointInfo {
    let direction = if input { Direction::In } else { Direction::Out };
    EndpointInfo {
        addr: EndpointAddress::from_parts(number, direction),
        ep_type: kind,
        max_packet_size: bytes,
        interval_ms,
    }
}

/// A device that has an address.
#[derive(Clone, Copy)]
pub struct Known {
    pub allocator: Allocator<'static>,
    pub address: u8,
    pub split: Option<SplitInfo>,
}

impl Known {
    pub fn pipe<T: pipe::Type, D: pipe::Direction>(&self, info: &EndpointInfo) -> Pipe<'static, T, D> {
        self.allocator.alloc_pipe::<T, D>(self.address, info, self.split).expect("a free pipe")
    }

    pub fn control(&self, bytes: u16) -> ControlPipe {
        self.pipe(&endpoint(0, EndpointType::Control, true, bytes, 0))
    }

    /// Tells its translator, if it has one, to forget what it holds for endpoint 0; a full-speed hub refuses.
    pub async fn clear_buffer(&self) {
        self.clear_half_buffer(false).await;
        self.clear_half_buffer(true).await;
    }

    /// Does it for what goes to the device alone, or for what comes.
    pub async fn clear_half_buffer(&self, input: bool) {
        if let Some(split) = self.split {
            let hub = Self { address: split.hub_addr(), split: None, ..*self };
            let value = u16::from(input) << 15 | u16::from(self.address) << 4;
            let _ = hub.control(64).control_out(&setup(0x23, 8, value, 1, 0), &[]).await;
        }
    }

    /// Interrupt endpoint 1.
    pub fn reports(&self, bytes: u16, interval_ms: u8) -> Pipe<'static, Interrupt, In> {
        self.pipe(&endpoint(1, EndpointType::Interrupt, true, bytes, interval_ms))
    }

    /// Interrupt endpoint 2.
    pub fn output(&self, bytes: u16, interval_ms: u8) -> Pipe<'static, Interrupt, Out> {
        self.pipe(&endpoint(2, EndpointType::Interrupt, false, bytes, interval_ms))
    }
}

pub fn setup(kind: u8, request: u8, value: u16, index: u16, length: u16) -> [u8; 8] {
    let ([a, b], [c, d], [e, f]) = (value.to_le_bytes(), index.to_le_bytes(), length.to_le_bytes());
    [kind, request, a, b, c, d, e, f]
}

/// Waits for a device on the root port.
pub async fn connected(rig: &Rig) -> Speed {
    loop {
        if let DeviceEvent::Connected(speed) = rig.driver.controller().wait_for_device_event().await {
            return speed;
        }
    }
}

/// Address, descriptors, configuration.
pub async fn enumerate(rig: &Rig, speed: Speed, split: Option<SplitInfo>, address: u8) -> Result<Known, PipeError> {
    let allocator = rig.driver.allocator();
    let first = if speed == Speed::Low { 8 } else { 64 };
    let known = Known { allocator, address: 0, split };
    let mut control = known.control(first);
    let mut descriptor = [0; 18];
    control.control_in(&setup(0x80, 6, 0x0100, 0, 8), &mut descriptor[..8]).await?;
    control.control_out(&setup(0, 5, address.into(), 0, 0), &[]).await?;
    drop(control);
    // USB 2.0 §9.2.6.3.
    rig.sleep(2_000).await;
    let known = Known { address, ..known };
    if !matches!(descriptor[7], 8 | 16 | 32 | 64) {
        return Err(PipeError::BadResponse);
    }
    let mut control = known.control(descriptor[7].into());
    control.control_in(&setup(0x80, 6, 0x0100, 0, 18), &mut descriptor).await?;
    let mut configuration = [0; 64];
    control.control_in(&setup(0x80, 6, 0x0200, 0, 64), &mut configuration).await?;
    control.control_out(&setup(0, 9, 1, 0, 0), &[]).await?;
    Ok(known)
}

/// A device on the root port.
pub async fn enumerate_root(rig: &Rig, address: u8) -> Result<Known, PipeError> {
    let speed = connected(rig).await;
    enumerate(rig, speed, None, address).await
}

/// A hub that has been configured.
pub struct HubHost {
    pub known: Known,
    pub control: ControlPipe,
    speed: Speed,
}

impl HubHost {
    /// The hub on the root port: address 1, all ports with power.
    pub async fn on_root(rig: &Rig) -> Result<Self, PipeError> {
        let speed = connected(rig).await;
        let known = enumerate(rig, speed, None, 1).await?;
        let mut hub = Self { known, control: known.control(64), speed };
        for port in 1..=4 {
            hub.feature(true, 8, port).await?;
        }
        // bPwrOn2PwrGood, USB 2.0 §11.11.
        rig.sleep(100_000).await;
        Ok(hub)
    }

    pub async fn feature(&mut self, on: bool, feature: u16, port: u16) -> Result<(), PipeError> {
        let request = if on { 3 } else { 1 };
        self.control.control_out(&setup(0x23, request, feature, port, 0), &[]).await
    }

    /// wPortStatus and wPortChange.
    pub async fn status(&mut self, port: u16) -> Result<(u16, u16), PipeError> {
        let mut bytes = [0; 4];
        self.control.control_in(&setup(0xa3, 0, 0, port, 4), &mut bytes).await?;
        Ok((u16::from_le_bytes([bytes[0], bytes[1]]), u16::from_le_bytes([bytes[2], bytes[3]])))
    }

    /// A device that was in a port all the time, from its reset on.
    pub async fn enumerate_again(&mut self, rig: &Rig, port: u16, address: u8) -> Result<Known, PipeError> {
        let speed = self.reset_now(rig, port).await?;
        enumerate(rig, speed, self.route(port, speed), address).await
    }

    /// Waits for a device in a port, resets it; its speed.
    pub async fn reset_port(&mut self, rig: &Rig, port: u16) -> Result<Speed, PipeError> {
        while self.status(port).await?.0 & 1 == 0 {
            rig.sleep(5_000).await;
        }
        self.feature(false, 16, port).await?;
        // TATTDB, USB 2.0 §7.1.7.3.
        rig.sleep(100_000).await;
        self.reset_now(rig, port).await
    }

    async fn reset_now(&mut self, rig: &Rig, port: u16) -> Result<Speed, PipeError> {
        self.feature(true, 4, port).await?;
        let status = loop {
            rig.sleep(2_000).await;
            let (status, change) = self.status(port).await?;
            if change & 1 << 4 != 0 {
                break status;
            }
        };
        self.feature(false, 20, port).await?;
        // TRSTRCY, USB 2.0 §7.1.7.5.
        rig.sleep(10_000).await;
        Ok(match status >> 9 & 3 {
            0 => Speed::Full,
            1 => Speed::Low,
            _ => Speed::High,
        })
    }

    /// How a device of this speed is reached.
    pub fn route(&self, port: u16, speed: Speed) -> Option<SplitInfo> {
        let slow = match speed {
            Speed::Low => SplitSpeed::Low,
            Speed::Full => SplitSpeed::Full,
            Speed::High => return None,
        };
        let same = self.speed == Speed::Full && speed == Speed::Full;
        (!same).then(|| SplitInfo::new(self.known.address, port as u8, slow))
    }

    /// The device in a port, with an address.
    pub async fn enumerate(&mut self, rig: &Rig, port: u16, address: u8) -> Result<Known, PipeError> {
        let speed = self.reset_port(rig, port).await?;
        enumerate(rig, speed, self.route(port, speed), address).await
    }
}
