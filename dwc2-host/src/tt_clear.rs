//! Requests to clear a transaction translator's buffer.

use crate::endpoint::{Endpoint, Kind, Route};
use crate::transfer::Transfer;

/// Requests that wait at most; a later one replaces none of them and is lost.
const LENGTH: usize = 4;

/// A hub's translator may hold a buffer that nobody will fetch any more: its driver should send this on its control
/// pipe (CLEAR_TT_BUFFER, USB 2.0 §11.24.2.3), else the buffer stays taken until the hub is reset.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TtClear {
    /// Address of the hub.
    pub hub: u8,
    /// The request; it has no data.
    pub setup: [u8; 8],
}

impl TtClear {
    /// For a hub with one translator for all its ports (wIndex 1).
    pub(crate) fn of(endpoint: &Endpoint, transfer: &Transfer) -> Option<Self> {
        let Route::Split { hub, .. } = endpoint.route else { return None };
        if endpoint.periodic() {
            return None;
        }
        let input = endpoint.kind == Kind::Bulk && transfer.input();
        let value = u16::from(endpoint.number)
            | u16::from(endpoint.address) << 4
            | (endpoint.kind as u16) << 11
            | u16::from(input) << 15;
        let [low, high] = value.to_le_bytes();
        Some(Self { hub, setup: [0x23, 8, low, high, 1, 0, 0, 0] })
    }
}

/// Those that wait.
#[derive(Default)]
pub(crate) struct TtClears([Option<TtClear>; LENGTH]);

impl TtClears {
    pub(crate) fn push(&mut self, request: Option<TtClear>) {
        if let Some(place) = self.0.iter_mut().find(|place| place.is_none()) {
            *place = request;
        }
    }

    /// One for this hub.
    pub(crate) fn take(&mut self, hub: u8) -> Option<TtClear> {
        self.0.iter_mut().find(|place| place.is_some_and(|request| request.hub == hub))?.take()
    }
}
