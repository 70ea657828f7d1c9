//! What a hub says of itself: like the USB2512B, but with four ports.

use crate::wire::Speed;

/// Device descriptor; at high speed with one transaction translator (protocol 1).
pub(super) fn device(speed: Speed) -> Vec<u8> {
    let protocol = u8::from(speed == Speed::High);
    vec![18, 1, 0x00, 0x02, 9, 0, protocol, 64, 0x24, 0x04, 0x12, 0x25, 0xb3, 0x0b, 0, 0, 0, 1]
}

/// Configuration, interface and endpoint: interrupt IN, one byte.
pub(super) fn configuration(speed: Speed) -> Vec<u8> {
    // At high speed 2^(12 - 1) microframes, else milliseconds.
    let interval = if speed == Speed::High { 12 } else { 255 };
    let mut bytes = vec![9, 2, 25, 0, 1, 1, 0, 0xe0, 1];
    bytes.extend([9, 4, 0, 0, 1, 9, 0, 0, 0]);
    bytes.extend([7, 5, 0x81, 3, 1, 0, interval]);
    bytes
}

/// Hub descriptor: `ports` ports, individual over-current, ganged power, 100 ms to power good.
pub(super) fn hub(ports: usize) -> Vec<u8> {
    vec![9, 0x29, ports as u8, 0x09, 0, 50, 1, 0, 0xff]
}
