//! The configuration descriptor, and the interfaces and endpoints that come with it (USB 2.0 §9.6.3…6).

use embassy_usb_driver::Speed;
use heapless::Vec;

use crate::setup::descriptor;

/// HID interfaces of a device that are looked at.
const HID_INTERFACES_MAXIMUM: usize = 4;
/// The largest interrupt packet that is read: all that full speed has, and more than boards' buffers like beyond.
pub(crate) const PACKET_MAXIMUM: u16 = 64;
/// The largest interrupt packet at low speed (USB 2.0 §5.7.3); some devices say more.
const LOW_SPEED_PACKET_MAXIMUM: u16 = 8;
const CLASS_HID: u8 = 3;
const CLASS_HUB: u8 = 9;

/// An interrupt endpoint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Endpoint {
    /// 1…15.
    pub(crate) number: u8,
    /// Bytes in a packet, 1…[`PACKET_MAXIMUM`].
    pub(crate) packet: u16,
    /// bInterval.
    interval: u8,
}

/// A HID interface with an endpoint for its reports.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct HidInterface {
    pub(crate) number: u8,
    /// Subclass and protocol say that it is a boot keyboard.
    pub(crate) boot_keyboard: bool,
    /// Length of its report descriptor, in bytes.
    pub(crate) report_descriptor: u16,
    pub(crate) input: Endpoint,
    pub(crate) output: Option<Endpoint>,
}

/// What a configuration has that is of use.
#[derive(Debug, Clone, Default)]
pub(crate) struct Configuration {
    /// bConfigurationValue, not 0.
    pub(crate) value: u8,
    /// The first interface's class.
    pub(crate) class: u8,
    pub(crate) hid: Vec<HidInterface, HID_INTERFACES_MAXIMUM>,
    /// A hub's endpoint for what has changed.
    pub(crate) hub: Option<Endpoint>,
}

/// An interface that is being read.
#[derive(Default)]
struct Open {
    number: u8,
    class: u8,
    boot_keyboard: bool,
    report_descriptor: u16,
    input: Option<Endpoint>,
    output: Option<Endpoint>,
}

impl Configuration {
    /// Length of its own part, in bytes.
    pub(crate) const HEADER_LENGTH: usize = 9;

    /// Reads how long it is with all that belongs to it; `None` if it is no configuration.
    pub(crate) fn total_length(bytes: &[u8]) -> Option<usize> {
        match *bytes {
            [9..=255, descriptor::CONFIGURATION, low, high, _, value, _, _, _, ..] if value != 0 => {
                Some(usize::from(u16::from_le_bytes([low, high]))).filter(|&total| total >= Self::HEADER_LENGTH)
            }
            _ => None,
        }
    }

    /// Reads it and what belongs to it, as far as it makes sense; `None` if it is no configuration.
    pub(crate) fn parse(bytes: &[u8], speed: Speed) -> Option<Self> {
        let total = Self::total_length(bytes)?;
        let mut configuration = Self { value: bytes[5], ..Self::default() };
        let mut open: Option<Open> = None;
        for bytes in Descriptors(&bytes[..total.min(bytes.len())]) {
            match *bytes {
                [9..=255, descriptor::INTERFACE, number, alternate, _, class, subclass, protocol, _, ..] => {
                    configuration.close(open.take());
                    if configuration.class == 0 {
                        configuration.class = class;
                    }
                    let boot_keyboard = (class, subclass, protocol) == (CLASS_HID, 1, 1);
                    open = (alternate == 0).then_some(Open { number, class, boot_keyboard, ..Open::default() });
                }
                [9..=255, descriptor::HID, _, _, _, _, descriptor::REPORT, low, high, ..] => {
                    if let Some(open) = &mut open {
                        open.report_descriptor = u16::from_le_bytes([low, high]);
                    }
                }
                [7..=255, descriptor::ENDPOINT, address, attributes, low, high, interval, ..]
                    if attributes & 3 == 3 =>
                {
                    let endpoint = Endpoint::new(address, u16::from_le_bytes([low, high]), interval, speed);
                    if let (Some(open), Some(endpoint)) = (&mut open, endpoint) {
                        let side = if address & 0x80 == 0 { &mut open.output } else { &mut open.input };
                        *side = side.or(Some(endpoint));
                    }
                }
                // The configuration itself, or nothing for us.
                _ => {}
            }
        }
        configuration.close(open);
        Some(configuration)
    }

    /// Keeps an interface that is of use.
    fn close(&mut self, open: Option<Open>) {
        let Some(Open { number, class, boot_keyboard, report_descriptor, input: Some(input), output }) = open else {
            return;
        };
        match class {
            CLASS_HID => {
                // A fifth has no room, and is not looked at.
                let _ = self.hid.push(HidInterface { number, boot_keyboard, report_descriptor, input, output });
            }
            CLASS_HUB => self.hub = self.hub.or(Some(input)),
            _ => {}
        }
    }
}

impl Endpoint {
    fn new(address: u8, packet: u16, interval: u8, speed: Speed) -> Option<Self> {
        // Bits 11 and 12 are the number of packets in a microframe (§9.6.6).
        let packet = packet & 0x7FF;
        let packet = if speed == Speed::Low { packet.min(LOW_SPEED_PACKET_MAXIMUM) } else { packet };
        let number = address & 0x0F;
        (number != 0 && (1..=PACKET_MAXIMUM).contains(&packet)).then_some(Self { number, packet, interval })
    }

    /// Returns how often it wants to be asked, in milliseconds: 1…255. At high speed bInterval is an exponent
    /// of microframes, else milliseconds (§9.6.6).
    pub(crate) fn interval_ms(self, speed: Speed) -> u8 {
        match speed {
            Speed::High => (1_u32 << (self.interval.clamp(1, 16) - 1)).div_ceil(8).min(255) as u8,
            Speed::Low | Speed::Full => self.interval.max(1),
        }
    }
}

/// Goes through descriptors in a row; ends at one that is shorter than its head or longer than what is left.
struct Descriptors<'a>(&'a [u8]);

impl<'a> Iterator for Descriptors<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<&'a [u8]> {
        let length = usize::from(*self.0.first()?);
        let (descriptor, rest) = self.0.split_at_checked(length).filter(|_| length >= 2)?;
        self.0 = rest;
        Some(descriptor)
    }
}

#[cfg(test)]
#[path = "configuration_tests.rs"]
mod tests;
