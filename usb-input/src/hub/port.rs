//! One port of a hub.

use embassy_usb_driver::Speed;
use embassy_usb_driver::host::UsbHostAllocator;

use crate::link::Link;
use crate::setup::Setup;
use crate::slots::SlotIndex;
use crate::timing::{ATTEMPTS, PORT_DEBOUNCE_US, PORT_RESET_STEP_US, PORT_RESET_TIMEOUT_US, RETRY_PAUSE_US};
use crate::{Clock, Fault, Step};

/// Feature selectors (USB 2.0 table 11-17).
pub(super) mod feature {
    pub(in crate::hub) const ENABLE: u8 = 1;
    pub(in crate::hub) const RESET: u8 = 4;
    pub(in crate::hub) const POWER: u8 = 8;
    /// The first of those that clear a port's changes, in the order of their bits.
    pub(in crate::hub) const CHANGES: u8 = 16;
    pub(in crate::hub) const CHANGE_RESET: u8 = 20;
}

/// Bits of a port's status and of its changes (USB 2.0 §11.24.2.7.1, §11.24.2.7.2).
mod bit {
    pub(super) const CONNECTION: u16 = 1 << 0;
    pub(super) const ENABLE: u16 = 1 << 1;
    pub(super) const OVER_CURRENT: u16 = 1 << 3;
    pub(super) const RESET: u16 = 1 << 4;
    pub(super) const LOW_SPEED: u16 = 1 << 9;
    pub(super) const HIGH_SPEED: u16 = 1 << 10;
    /// The highest change that is defined.
    pub(super) const LAST_CHANGE: u8 = 4;
}

/// What a port says of itself.
#[derive(Clone, Copy)]
struct Status {
    status: u16,
    changes: u16,
}

impl Status {
    const fn is(self, bit: u16) -> bool {
        self.status & bit != 0
    }

    const fn has_changed(self, bit: u16) -> bool {
        self.changes & bit != 0
    }

    const fn speed(self) -> Speed {
        match (self.is(bit::LOW_SPEED), self.is(bit::HIGH_SPEED)) {
            (true, _) => Speed::Low,
            (false, true) => Speed::High,
            (false, false) => Speed::Full,
        }
    }
}

/// One port.
pub(super) struct Port {
    number: u8,
    /// Who is there, as far as it has been reset.
    device: Option<SlotIndex>,
    /// When who is there may be reset.
    due_us: Option<u64>,
    /// How often it was reset since it was plugged in.
    attempts: u8,
}

impl Port {
    pub(super) const fn new(number: u8) -> Self {
        Self { number, device: None, due_us: None, attempts: 0 }
    }

    pub(super) const fn number(&self) -> u8 {
        self.number
    }

    /// Asks the port what has changed, and takes note of it.
    pub(super) async fn look<'d, A: UsbHostAllocator<'d>, K: Clock>(
        &mut self,
        link: &Link<'_, A, K>,
    ) -> Result<(), Fault> {
        let port = self.status(link).await?;
        for change in (0..=bit::LAST_CHANGE).filter(|change| port.has_changed(1 << change)) {
            self.clear(link, feature::CHANGES + change).await?;
        }
        if port.has_changed(bit::OVER_CURRENT) {
            if port.is(bit::OVER_CURRENT) {
                link.bus.tell_fault(link.route.place, Fault::OverCurrent).await;
            } else {
                self.set(link, feature::POWER).await?;
            }
        }
        let connected = port.is(bit::CONNECTION);
        let unnoticed = connected && self.device.is_none() && self.due_us.is_none() && self.attempts == 0;
        if port.has_changed(bit::CONNECTION) || unnoticed || !connected {
            self.let_go(link);
            self.attempts = 0;
            self.due_us = connected.then(|| link.bus.now_us() + PORT_DEBOUNCE_US);
        } else if port.has_changed(bit::ENABLE) && !port.is(bit::ENABLE) && self.device.is_some() {
            // The hub cut it off for what it did on the bus (§11.8.1).
            self.let_go(link);
            self.due_us = Some(link.bus.now_us() + RETRY_PAUSE_US);
        }
        Ok(())
    }

    fn let_go<A, K>(&mut self, link: &Link<'_, A, K>) {
        if let Some(device) = self.device.take() {
            link.bus.memory.slots.leave(device);
        }
    }

    /// Tells whether who is there wants a reset now.
    pub(super) fn wants_attention<A, K: Clock>(&self, link: &Link<'_, A, K>) -> bool {
        let slots = &link.bus.memory.slots;
        let may_begin = || super::place_below(link.route.place, self.number).is_none_or(|place| slots.may_begin(place));
        self.device.is_some_and(|device| slots.has_failed(device))
            || self.due_us.is_some_and(|due_us| link.bus.has_come(due_us) && may_begin())
    }

    /// Resets who is there.
    pub(super) async fn attend<'d, A: UsbHostAllocator<'d>, K: Clock>(
        &mut self,
        link: &Link<'_, A, K>,
    ) -> Result<(), Fault> {
        if self.device.is_some() {
            self.let_go(link);
            self.due_us = Some(link.bus.now_us() + RETRY_PAUSE_US);
            return Ok(());
        }
        self.due_us = None;
        if self.attempts >= ATTEMPTS {
            return self.give_up(link, Fault::GivenUp).await;
        }
        let Some(place) = super::place_below(link.route.place, self.number) else {
            return self.give_up(link, Fault::TooDeep).await;
        };
        // Takes the turn at address 0; from here on it has to be begun or let go.
        let Some(device) = link.bus.memory.slots.reserve(Some(link.slot), place) else {
            return self.give_up(link, Fault::TooManyDevices).await;
        };
        self.device = Some(device);
        self.attempts += 1;
        match self.reset(link).await? {
            Some(speed) => {
                let route = link.route.below(link.address, self.number, place, speed);
                link.bus.memory.slots.begin(device, route);
            }
            None => {
                self.let_go(link);
                self.due_us = Some(link.bus.now_us() + RETRY_PAUSE_US);
            }
        }
        Ok(())
    }

    /// Resets the port; returns the device's speed, or `None` if it is not there, or not enabled.
    async fn reset<'d, A: UsbHostAllocator<'d>, K: Clock>(
        &self,
        link: &Link<'_, A, K>,
    ) -> Result<Option<Speed>, Fault> {
        self.set(link, feature::RESET).await?;
        let end_us = link.bus.now_us() + PORT_RESET_TIMEOUT_US;
        let port = loop {
            link.bus.sleep(PORT_RESET_STEP_US).await;
            let port = self.status(link).await?;
            if port.has_changed(bit::RESET) {
                break port;
            }
            if link.bus.now_us() >= end_us {
                return Ok(None);
            }
        };
        self.clear(link, feature::CHANGE_RESET).await?;
        // Another connection in between will be looked at as a change.
        let steady = port.is(bit::CONNECTION) && !port.has_changed(bit::CONNECTION);
        Ok((steady && port.is(bit::ENABLE)).then(|| port.speed()))
    }

    /// Leaves who is there alone until it is plugged in again.
    async fn give_up<'d, A: UsbHostAllocator<'d>, K: Clock>(
        &mut self,
        link: &Link<'_, A, K>,
        fault: Fault,
    ) -> Result<(), Fault> {
        self.attempts = ATTEMPTS;
        self.clear(link, feature::ENABLE).await?;
        let place = super::place_below(link.route.place, self.number).unwrap_or(link.route.place);
        link.bus.tell_fault(place, fault).await;
        Ok(())
    }

    async fn status<'d, A: UsbHostAllocator<'d>, K: Clock>(&self, link: &Link<'_, A, K>) -> Result<Status, Fault> {
        status(link, self.number).await
    }

    async fn set<'d, A: UsbHostAllocator<'d>, K: Clock>(
        &self,
        link: &Link<'_, A, K>,
        feature: u8,
    ) -> Result<(), Fault> {
        link.write(Step::Port, Setup::set_port_feature(feature, self.number), &[]).await
    }

    async fn clear<'d, A: UsbHostAllocator<'d>, K: Clock>(
        &self,
        link: &Link<'_, A, K>,
        feature: u8,
    ) -> Result<(), Fault> {
        link.write(Step::Port, Setup::clear_hub_feature(feature, self.number), &[]).await
    }
}

async fn status<'d, A: UsbHostAllocator<'d>, K: Clock>(link: &Link<'_, A, K>, port: u8) -> Result<Status, Fault> {
    let mut bytes = [0; 4];
    let count = link.read(Step::Port, Setup::hub_status(port), &mut bytes).await?;
    if count < bytes.len() {
        return Err(Fault::Descriptor { doing: Step::Port });
    }
    let [s0, s1, c0, c1] = bytes;
    Ok(Status { status: u16::from_le_bytes([s0, s1]), changes: u16::from_le_bytes([c0, c1]) })
}

/// Asks the hub itself what has changed: its local power (bit 0) or its current (bit 1), and takes note
/// (USB 2.0 §11.24.2.6).
pub(super) async fn look_at_hub<'d, A: UsbHostAllocator<'d>, K: Clock>(link: &Link<'_, A, K>) -> Result<(), Fault> {
    let hub = status(link, 0).await?;
    for change in (0..2).filter(|change| hub.has_changed(1 << change)) {
        link.write(Step::Port, Setup::clear_hub_feature(change, 0), &[]).await?;
    }
    if hub.changes & hub.status & 1 << 1 != 0 {
        link.bus.tell_fault(link.route.place, Fault::OverCurrent).await;
    }
    Ok(())
}
