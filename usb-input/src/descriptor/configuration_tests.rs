use super::{Configuration, Endpoint};
use embassy_usb_driver::Speed;
use std::vec::Vec;

/// A DualShock 3's, as captured.
const PAD: [u8; 41] = [
    0x09, 0x02, 0x29, 0x00, 0x01, 0x01, 0x00, 0x80, 0xFA, // configuration 1
    0x09, 0x04, 0x00, 0x00, 0x02, 0x03, 0x00, 0x00, 0x00, // HID
    0x09, 0x21, 0x11, 0x01, 0x00, 0x01, 0x22, 0x94, 0x00, // report descriptor of 148 bytes
    0x07, 0x05, 0x02, 0x03, 0x40, 0x00, 0x01, // out
    0x07, 0x05, 0x81, 0x03, 0x40, 0x00, 0x01, // in
];

fn changed(changes: &[(usize, u8)]) -> Vec<u8> {
    let mut bytes = PAD.to_vec();
    for &(at, byte) in changes {
        bytes[at] = byte;
    }
    bytes
}

#[test]
fn a_pad_is_read() {
    let pad = Configuration::parse(&PAD, Speed::Full).unwrap();
    assert_eq!((pad.value, pad.class, pad.hub), (1, 3, None));
    let [hid] = pad.hid[..] else { panic!("{pad:?}") };
    assert_eq!((hid.number, hid.boot_keyboard, hid.report_descriptor), (0, false, 148));
    assert_eq!(hid.input, Endpoint { number: 1, packet: 64, interval: 1 });
    assert_eq!(hid.output, Some(Endpoint { number: 2, packet: 64, interval: 1 }));
}

#[test]
fn packets_are_no_longer_than_low_speed_has() {
    let hid = Configuration::parse(&changed(&[(38, 13)]), Speed::Low).unwrap().hid;
    assert_eq!((hid[0].input.packet, hid[0].output.unwrap().packet), (8, 8));
}

#[test]
fn a_keyboard_with_a_mouse_is_two_interfaces() {
    let bytes = [
        &[9, 2, 59, 0, 2, 1, 0, 0xA0, 50][..],
        &[9, 4, 0, 0, 1, 3, 1, 1, 0, 9, 0x21, 0x10, 1, 0, 1, 0x22, 65, 0, 7, 5, 0x81, 3, 8, 0, 10],
        &[9, 4, 1, 0, 1, 3, 1, 2, 0, 9, 0x21, 0x10, 1, 0, 1, 0x22, 46, 0, 7, 5, 0x82, 3, 4, 0, 10],
    ]
    .concat();
    let both = Configuration::parse(&bytes, Speed::Full).unwrap();
    let found: Vec<_> = both.hid.iter().map(|hid| (hid.number, hid.boot_keyboard, hid.report_descriptor)).collect();
    assert_eq!(found, [(0, true, 65), (1, false, 46)]);
}

#[test]
fn a_hub_is_its_endpoint_whatever_its_protocol() {
    // The board's: one translator for all ports in setting 0, one for each in setting 1.
    let bytes = [
        &[9, 2, 41, 0, 1, 1, 0, 0xE0, 1][..],
        &[9, 4, 0, 0, 1, 9, 0, 1, 0, 7, 5, 0x81, 3, 1, 0, 12],
        &[9, 4, 0, 1, 1, 9, 0, 2, 0, 7, 5, 0x82, 3, 2, 0, 13],
    ]
    .concat();
    let hub = Configuration::parse(&bytes, Speed::Full).unwrap().hub.unwrap();
    assert_eq!(hub, Endpoint { number: 1, packet: 1, interval: 12 });
    assert_eq!(hub.interval_ms(Speed::High), 255);
    assert_eq!(hub.interval_ms(Speed::Full), 12);
}

#[test]
fn intervals_are_milliseconds_at_every_speed() {
    let ms = |interval, speed| Endpoint { number: 1, packet: 8, interval }.interval_ms(speed);
    assert_eq!([1, 4, 5, 7, 16].map(|interval| ms(interval, Speed::High)), [1, 1, 2, 8, 255]);
    assert_eq!([0, 1, 10, 255].map(|interval| ms(interval, Speed::Low)), [1, 1, 10, 255]);
    assert_eq!([0, 17, 255].map(|interval| ms(interval, Speed::High)), [1, 255, 255]);
}

#[test]
fn what_makes_no_sense_is_left_out() {
    let hids = |bytes: &[u8]| Configuration::parse(bytes, Speed::Full).map(|found| found.hid.len());
    assert_eq!(hids(&changed(&[(36, 0x80)])), Some(0), "endpoint 0");
    assert_eq!(hids(&changed(&[(38, 0)])), Some(0), "packets of no bytes");
    assert_eq!(hids(&changed(&[(38, 0), (39, 4)])), Some(0), "packets of 1024 bytes");
    assert_eq!(hids(&changed(&[(37, 2)])), Some(0), "a bulk endpoint");
    assert_eq!(hids(&changed(&[(12, 1)])), Some(0), "another setting");
    assert_eq!(hids(&changed(&[(34, 0)])), Some(0), "a descriptor of no bytes");
    assert_eq!(hids(&changed(&[(34, 1)])), Some(0), "a descriptor of one byte");
    assert_eq!(hids(&changed(&[(34, 8)])), Some(0), "a descriptor beyond the end");
    assert_eq!(hids(&changed(&[(9, 200)])), Some(0), "an interface beyond the end");
    assert_eq!(hids(&changed(&[(2, 200), (3, 200)])), Some(1), "a total beyond the end");
    assert_eq!(hids(&changed(&[(2, 40)])), Some(0), "a total within the last descriptor");
    for (at, byte, what) in
        [(0, 8, "a short head"), (1, 1, "another type"), (2, 8, "a short total"), (5, 0, "number 0")]
    {
        assert_eq!(hids(&changed(&[(at, byte)])), None, "{what}");
    }
    for length in 0..PAD.len() {
        assert_eq!(hids(&PAD[..length]), (length >= 9).then_some(0), "{length} bytes of it");
    }
}

#[test]
fn more_interfaces_than_there_is_room_for_do_no_harm() {
    let interfaces = PAD[9..].repeat(7);
    let bytes = [&changed(&[(2, 233)])[..9], &interfaces].concat();
    assert_eq!(Configuration::parse(&bytes, Speed::Full).unwrap().hid.len(), 4);
}
