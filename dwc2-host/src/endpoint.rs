//! What a pipe talks to, and by which way.

use embassy_usb_driver::host::{HostError, SplitInfo, SplitSpeed};
use embassy_usb_driver::{EndpointInfo, EndpointType, Speed};

use crate::PIPE_BUFFER_BYTES;
use crate::timing::{FRAME_US, MICROFRAME_US};

/// Kind of endpoint, as HCCHAR wants it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Control = 0,
    Bulk = 2,
    Interrupt = 3,
}

/// The way to a device.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Route {
    /// At the root port's own speed.
    Direct,
    /// A low-speed device behind a full-speed hub: the core sends a preamble (USB 2.0 §11.8.4).
    Preamble,
    /// By split transactions through this hub's transaction translator.
    Split { hub: u8, port: u8 },
}

/// An endpoint and the way to it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Endpoint {
    pub(crate) address: u8,
    pub(crate) number: u8,
    pub(crate) kind: Kind,
    /// Largest packet; never 0.
    pub(crate) packet_bytes: u16,
    pub(crate) low_speed: bool,
    pub(crate) high_speed: bool,
    pub(crate) route: Route,
    pub(crate) interval_us: u32,
}

impl Endpoint {
    /// # Errors
    ///
    /// `InvalidDescriptor` for an address, number, size or kind that USB does not have or this driver does not do
    /// (isochronous); `InsufficientMemory` for packets larger than a pipe's buffer.
    pub(crate) fn new(
        root: Speed,
        address: u8,
        info: &EndpointInfo,
        split: Option<SplitInfo>,
    ) -> Result<Self, HostError> {
        let kind = match info.ep_type {
            EndpointType::Control => Kind::Control,
            EndpointType::Bulk => Kind::Bulk,
            EndpointType::Interrupt => Kind::Interrupt,
            EndpointType::Isochronous => return Err(HostError::InvalidDescriptor),
        };
        let slow = split.is_some_and(|split| split.device_speed() == SplitSpeed::Low);
        let route = match split {
            Some(split) if root == Speed::High => Route::Split { hub: split.hub_addr(), port: split.port() },
            Some(_) if root == Speed::Full && slow => Route::Preamble,
            _ => Route::Direct,
        };
        let (bytes, low_speed) = (info.max_packet_size, slow || root == Speed::Low);
        let high_speed = root == Speed::High && route == Route::Direct;
        // USB 2.0 §5.5.3, §5.7.3 and §5.8.3. Packets of these sizes keep every DMA address on a multiple of four.
        let size_exists = match (kind, low_speed, high_speed) {
            (Kind::Control, true, _) => bytes == 8,
            (Kind::Control, _, true) => bytes == 64,
            (Kind::Control, ..) => matches!(bytes, 8 | 16 | 32 | 64),
            (Kind::Interrupt, true, _) => matches!(bytes, 1..=8),
            (Kind::Interrupt, _, true) => matches!(bytes, 1..=1_024),
            (Kind::Interrupt, ..) => matches!(bytes, 1..=64),
            (Kind::Bulk, true, _) => false,
            (Kind::Bulk, _, true) => bytes == 512,
            (Kind::Bulk, ..) => matches!(bytes, 8 | 16 | 32 | 64),
        };
        if !size_exists || address > 127 || info.addr.index() > 15 {
            return Err(HostError::InvalidDescriptor);
        }
        if usize::from(bytes) > PIPE_BUFFER_BYTES {
            return Err(HostError::InsufficientMemory);
        }
        Ok(Self {
            address,
            number: info.addr.index() as u8,
            kind,
            packet_bytes: bytes,
            low_speed,
            high_speed,
            route,
            interval_us: u32::from(info.interval_ms.max(1)) * 1_000,
        })
    }

    /// It has its turn in certain (micro)frames.
    pub(crate) fn periodic(&self) -> bool {
        self.kind == Kind::Interrupt
    }

    /// By split transactions.
    pub(crate) fn splits(&self) -> bool {
        matches!(self.route, Route::Split { .. })
    }

    /// The hub that splits for it.
    pub(crate) fn hub(&self) -> Option<u8> {
        match self.route {
            Route::Split { hub, .. } => Some(hub),
            _ => None,
        }
    }

    /// One packet at a time, and at most one step of it in a (micro)frame: what splits want, and what preambles are
    /// safe with (two in a frame make some cores disable the port: `hathach/tinyusb` PR 3864).
    pub(crate) fn paced(&self) -> bool {
        self.route != Route::Direct
    }

    /// Bytes that the channel may move between two stops.
    pub(crate) fn chunk_bytes(&self) -> usize {
        let packet = usize::from(self.packet_bytes);
        PIPE_BUFFER_BYTES / packet * packet
    }

    /// How long before its time a periodic transaction is handed to the core: it goes out in the next (micro)frame.
    pub(crate) fn lead_us(&self) -> u64 {
        if self.high_speed { MICROFRAME_US } else { FRAME_US }
    }

    /// How much sooner than its interval has passed a periodic transaction may be handed to the core. Behind a
    /// translator it waits for its microframe up to half a frame after a poll, and the next turn is found by a poll too;
    /// it is in another frame in any case.
    pub(crate) fn slack_us(&self) -> u64 {
        if self.splits() { 5 * MICROFRAME_US } else { self.lead_us() / 4 }
    }
}
