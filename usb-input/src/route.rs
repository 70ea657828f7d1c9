//! How a device is reached.

use embassy_usb_driver::Speed;
use embassy_usb_driver::host::{SplitInfo, SplitSpeed};

use crate::Place;

/// How a device is reached.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Route {
    pub(crate) place: Place,
    pub(crate) speed: Speed,
    /// The transaction translator in between (USB 2.0 §11.14), or the full-speed hub that takes low-speed
    /// packets (§8.6.5), if any.
    pub(crate) split: Option<SplitInfo>,
}

impl Route {
    /// Returns the way to the root port's device.
    pub(crate) const fn root(speed: Speed) -> Self {
        Self { place: Place::ROOT, speed, split: None }
    }

    /// Returns the way to a device at a port of the hub that this is the way to.
    ///
    /// The first high-speed hub above a slower device translates, for all that hangs below it
    /// (USB 2.0 §11.14.1). No device is faster than its hub, whatever the hub says.
    pub(crate) fn below(self, hub_address: u8, port: u8, place: Place, speed: Speed) -> Self {
        let speed = match (self.speed, speed) {
            (Speed::High, speed) => speed,
            (_, Speed::Low) => Speed::Low,
            _ => Speed::Full,
        };
        let translator = match self.split {
            Some(split) => Some((split.hub_addr(), split.port())),
            None if speed != self.speed => Some((hub_address, port)),
            None => None,
        };
        let split_speed = if speed == Speed::Low { SplitSpeed::Low } else { SplitSpeed::Full };
        Self { place, speed, split: translator.map(|(hub, port)| SplitInfo::new(hub, port, split_speed)) }
    }
}

#[cfg(test)]
mod tests {
    use super::Route;
    use embassy_usb_driver::Speed;
    use embassy_usb_driver::host::SplitSpeed;

    fn below(route: Route, address: u8, port: u8, speed: Speed) -> Route {
        route.below(address, port, route.place.below(port).unwrap(), speed)
    }

    fn split(route: Route) -> Option<(u8, u8, SplitSpeed)> {
        route.split.map(|split| (split.hub_addr(), split.port(), split.device_speed()))
    }

    #[test]
    fn the_first_high_speed_hub_translates_for_all_below() {
        let hub = Route::root(Speed::High);
        assert_eq!(split(hub), None);
        assert_eq!(split(below(hub, 1, 2, Speed::High)), None);
        assert_eq!(split(below(hub, 1, 2, Speed::Full)), Some((1, 2, SplitSpeed::Full)));
        let inner = below(hub, 1, 2, Speed::High);
        assert_eq!(split(below(inner, 5, 3, Speed::Low)), Some((5, 3, SplitSpeed::Low)));
        let slow = below(hub, 1, 2, Speed::Full);
        assert_eq!(split(below(slow, 6, 4, Speed::Full)), Some((1, 2, SplitSpeed::Full)));
        assert_eq!(split(below(slow, 6, 4, Speed::Low)), Some((1, 2, SplitSpeed::Low)));
    }

    #[test]
    fn on_a_full_speed_bus_only_low_speed_is_special() {
        let hub = Route::root(Speed::Full);
        assert_eq!(split(below(hub, 1, 1, Speed::Full)), None);
        assert_eq!(split(below(hub, 1, 1, Speed::Low)), Some((1, 1, SplitSpeed::Low)));
        let inner = below(hub, 1, 1, Speed::Full);
        assert_eq!(split(below(inner, 2, 7, Speed::Low)), Some((2, 7, SplitSpeed::Low)));
    }

    #[test]
    fn a_slow_hub_has_no_fast_devices() {
        assert_eq!(below(Route::root(Speed::Full), 1, 1, Speed::High).speed, Speed::Full);
    }
}
