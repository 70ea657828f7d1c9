//! Where a device hangs.

use core::fmt;

/// The way from the root port to a device, port by port; it names a device while it is attached.
///
/// Shown as `root` for what is plugged into the root port, else as the hubs' ports from the root on:
/// `1.3` is port 3 of the hub on port 1 of the root port's hub.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Place(u32);

impl Place {
    /// The root port itself.
    pub const ROOT: Self = Self(0);
    /// Hubs in a row, at most: seven tiers with the root and the device (USB 2.0 §4.1.1).
    pub const HUBS_MAXIMUM: usize = 5;
    const PORT_BITS: u32 = 4;
    /// The highest port that a place can name.
    pub const PORT_MAXIMUM: u8 = (1 << Self::PORT_BITS) - 1;

    /// Returns the place at a port, 1…[`PORT_MAXIMUM`](Self::PORT_MAXIMUM), of the hub that is here;
    /// `None` beyond [`HUBS_MAXIMUM`](Self::HUBS_MAXIMUM) hubs and for any other port.
    #[must_use]
    pub const fn below(self, port: u8) -> Option<Self> {
        if self.depth() >= Self::HUBS_MAXIMUM || port == 0 || port > Self::PORT_MAXIMUM {
            return None;
        }
        Some(Self(self.0 | (port as u32) << (Self::PORT_BITS * self.depth() as u32)))
    }

    /// Returns how many hubs are above it, 0…5.
    #[must_use]
    pub const fn depth(self) -> usize {
        (u32::BITS - self.0.leading_zeros()).div_ceil(Self::PORT_BITS) as usize
    }

    /// Goes through the ports on the way, from the root on.
    pub fn ports(self) -> impl Iterator<Item = u8> {
        (0..self.depth() as u32).map(move |tier| (self.0 >> (Self::PORT_BITS * tier)) as u8 & Self::PORT_MAXIMUM)
    }
}

impl fmt::Display for Place {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if *self == Self::ROOT {
            return formatter.write_str("root");
        }
        for (tier, port) in self.ports().enumerate() {
            let dot = if tier == 0 { "" } else { "." };
            write!(formatter, "{dot}{port}")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::Place;
    use std::string::ToString;

    #[test]
    fn a_place_reads_as_its_ports() {
        let place = Place::ROOT.below(1).unwrap().below(3).unwrap().below(15).unwrap();
        assert_eq!(place.to_string(), "1.3.15");
        assert_eq!(Place::ROOT.to_string(), "root");
        assert_eq!(place.depth(), 3);
        assert!(place.ports().eq([1, 3, 15]));
    }

    #[test]
    fn five_hubs_are_the_most() {
        let mut place = Place::ROOT;
        for hubs in 0..5 {
            assert_eq!(place.depth(), hubs);
            place = place.below(15).unwrap();
        }
        assert_eq!(place.below(1), None);
        assert_eq!((Place::ROOT.below(0), Place::ROOT.below(16)), (None, None));
    }
}
