//! The device descriptor (USB 2.0 §9.6.1).

use embassy_usb_driver::Speed;

use crate::setup::descriptor;

/// What the device descriptor says.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Device {
    pub(crate) class: u8,
    pub(crate) vendor: u16,
    pub(crate) product: u16,
    /// Indices of the strings, 0 for none.
    pub(crate) maker: u8,
    pub(crate) name: u8,
}

impl Device {
    /// Its length in bytes.
    pub(crate) const LENGTH: usize = 18;
    /// As much of it as tells endpoint 0's packet size, and fits in the smallest packet.
    pub(crate) const FIRST_BYTES: usize = 8;

    /// Reads endpoint 0's packet size from the first eight bytes; `None` unless it is one that the speed
    /// allows (§5.5.3).
    pub(crate) fn packet(bytes: &[u8], speed: Speed) -> Option<u16> {
        let &[18..=255, descriptor::DEVICE, _, _, _, _, _, packet] = bytes else {
            return None;
        };
        let allowed = match speed {
            Speed::Low => packet == 8,
            Speed::Full => matches!(packet, 8 | 16 | 32 | 64),
            Speed::High => packet == 64,
        };
        allowed.then_some(packet.into())
    }

    /// Reads the whole descriptor; `None` if it is none.
    pub(crate) fn parse(bytes: &[u8]) -> Option<Self> {
        let &[18..=255, descriptor::DEVICE, _, _, class, _, _, _, v0, v1, p0, p1, _, _, maker, name, _, _] = bytes
        else {
            return None;
        };
        let [vendor, product] = [[v0, v1], [p0, p1]].map(u16::from_le_bytes);
        Some(Self { class, vendor, product, maker, name })
    }
}

#[cfg(test)]
mod tests {
    use super::Device;
    use embassy_usb_driver::Speed;

    /// A DualShock 3's, as captured.
    const BYTES: [u8; 18] = [0x12, 1, 0, 2, 0, 0, 0, 0x40, 0x4C, 5, 0x68, 2, 0, 1, 1, 2, 0, 1];

    #[test]
    fn a_pad_is_read() {
        let device = Device::parse(&BYTES).unwrap();
        assert_eq!((device.vendor, device.product, device.class), (0x054C, 0x0268, 0));
        assert_eq!((device.maker, device.name), (1, 2));
    }

    #[test]
    fn a_packet_size_has_to_fit_the_speed() {
        let packet = |size, speed| Device::packet(&[18, 1, 0, 2, 0, 0, 0, size], speed);
        assert_eq!(packet(64, Speed::Full), Some(64));
        assert_eq!(packet(8, Speed::Low), Some(8));
        for (size, speed) in
            [(0, Speed::Full), (9, Speed::Full), (255, Speed::High), (8, Speed::High), (64, Speed::Low)]
        {
            assert_eq!(packet(size, speed), None, "{size} {speed:?}");
        }
    }

    #[test]
    fn what_is_short_or_of_another_type_is_none() {
        for length in 0..18 {
            assert!(Device::parse(&BYTES[..length]).is_none());
        }
        assert!(Device::packet(&BYTES[..7], Speed::Full).is_none());
        let mut other = BYTES;
        other[1] = 2;
        assert!(Device::parse(&other).is_none() && Device::packet(&other[..8], Speed::Full).is_none());
        other = BYTES;
        other[0] = 17;
        assert!(Device::parse(&other).is_none() && Device::packet(&other[..8], Speed::Full).is_none());
    }
}
