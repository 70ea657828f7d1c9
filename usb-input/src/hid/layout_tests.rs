use super::{Form, Layout};
use controls::{Acceleration, Battery, Button, Buttons, DualShock3Report};
use std::vec::Vec;

/// A boot keyboard's, as HID 1.11 appendix B.1 has it, with its lamps.
const BOOT: &[u8] = &[
    0x05, 0x01, 0x09, 0x06, 0xA1, 0x01, // keyboard
    0x05, 0x07, 0x19, 0xE0, 0x29, 0xE7, 0x15, 0x00, 0x25, 0x01, 0x75, 0x01, 0x95, 0x08, 0x81, 0x02, // modifiers
    0x95, 0x01, 0x75, 0x08, 0x81, 0x01, // a byte of nothing
    0x95, 0x05, 0x75, 0x01, 0x05, 0x08, 0x19, 0x01, 0x29, 0x05, 0x91, 0x02, 0x95, 0x01, 0x75, 0x03, 0x91,
    0x01, // lamps
    0x95, 0x06, 0x75, 0x08, 0x15, 0x00, 0x25, 0x65, 0x05, 0x07, 0x19, 0x00, 0x29, 0x65, 0x81, 0x00, // six keys
    0xC0,
];

/// A keyboard with a bit for each key, behind media keys in a report of their own.
const BITMAP: &[u8] = &[
    0x05, 0x0C, 0x09, 0x01, 0xA1, 0x01, 0x85, 0x02, // media keys: report 2
    0x19, 0x00, 0x2A, 0x3C, 0x02, 0x15, 0x00, 0x26, 0x3C, 0x02, 0x95, 0x01, 0x75, 0x10, 0x81, 0x00, 0xC0, //
    0x05, 0x01, 0x09, 0x06, 0xA1, 0x01, 0x85, 0x04, // keys: report 4
    0x05, 0x07, 0x19, 0xE0, 0x29, 0xE7, 0x15, 0x00, 0x25, 0x01, 0x75, 0x01, 0x95, 0x08, 0x81, 0x02, //
    0x19, 0x00, 0x29, 0x77, 0x95, 0x78, 0x81, 0x02, // usages 0 to 0x77
    0xC0,
];

/// A pad of the plainest kind: two sticks, a hat, twelve buttons.
const PAD: &[u8] = &[
    0x05, 0x01, 0x09, 0x05, 0xA1, 0x01, 0x15, 0x00, 0x26, 0xFF, 0x00, 0x75, 0x08, 0x95, 0x04, //
    0x09, 0x30, 0x09, 0x31, 0x09, 0x32, 0x09, 0x35, 0x81, 0x02, // X, Y, Z, Rz
    0x75, 0x04, 0x95, 0x01, 0x25, 0x07, 0x46, 0x3B, 0x01, 0x65, 0x14, 0x09, 0x39, 0x81, 0x42, // hat
    0x65, 0x00, 0x05, 0x09, 0x19, 0x01, 0x29, 0x0C, 0x25, 0x01, 0x75, 0x01, 0x95, 0x0C, 0x81, 0x02, // buttons
    0xC0,
];

fn boot_report(descriptor: &[u8], report: &[u8]) -> [u8; 8] {
    match Layout::parse(descriptor).unwrap().form {
        Form::Keyboard(keyboard) => keyboard.boot_report(report),
        Form::Pad(_) => panic!("a pad"),
    }
}

fn pad_report(descriptor: &[u8], report: &[u8]) -> DualShock3Report {
    match Layout::parse(descriptor).unwrap().form {
        Form::Pad(pad) => pad.read(report),
        Form::Keyboard(_) => panic!("a keyboard"),
    }
}

#[test]
fn a_boot_keyboards_own_descriptor_changes_nothing() {
    let layout = Layout::parse(BOOT).unwrap();
    assert_eq!((layout.id, layout.length), (0, 8));
    for report in [[0; 8], [0x81, 0, 4, 5, 6, 7, 8, 0x65], [2, 0, 0x52, 0, 0, 0, 0, 0]] {
        assert_eq!(boot_report(BOOT, &report), report);
    }
    assert_eq!(boot_report(BOOT, &[1, 0, 1, 1, 1, 1, 1, 1]), [1, 0, 1, 1, 1, 1, 1, 1], "too many keys");
    assert_eq!(
        boot_report(BOOT, &[0, 0, 4, 0x66, 0xFF, 4, 0, 0]),
        [0, 0, 4, 0, 0, 0, 0, 0],
        "beyond the maximum, twice"
    );
    assert_eq!(boot_report(BOOT, &[2, 0, 4]), [2, 0, 4, 0, 0, 0, 0, 0], "cut off");
}

#[test]
fn a_bit_for_each_key_becomes_a_list() {
    let layout = Layout::parse(BITMAP).unwrap();
    assert_eq!((layout.id, layout.length), (4, 17));
    let mut report = [0; 16];
    report[0] = 0x21;
    for key in [0x04, 0x2C, 0x52, 0x77_usize] {
        report[1 + key / 8] |= 1 << (key % 8);
    }
    assert_eq!(boot_report(BITMAP, &report), [0x21, 0, 0x04, 0x2C, 0x52, 0x77, 0, 0]);
    report[1..].fill(0xF0);
    assert_eq!(boot_report(BITMAP, &report), [0x21, 0, 4, 5, 6, 7, 0x0C, 0x0D], "more than six");
}

#[test]
fn a_pad_is_read_by_its_descriptor() {
    assert_eq!(Layout::parse(PAD).unwrap().length, 6);
    let idle = pad_report(PAD, &[0x80, 0x80, 0x80, 0x80, 0x0F, 0]);
    assert_eq!(idle, DualShock3Report { battery: Battery::Unknown, ..DualShock3Report::default() });
    assert_eq!(idle.acceleration, Acceleration::LEVEL);
    let moved = pad_report(PAD, &[0, 255, 1, 2, 0x21, 0x02]);
    assert_eq!((moved.left_stick, moved.right_stick), ([0, 255], [1, 2]));
    let held = [Button::Up, Button::Right, Button::Cross, Button::R1];
    assert_eq!(moved.held, Buttons::from_iter(held));
}

#[test]
fn the_hat_turns_clockwise() {
    let held = |hat: u8| pad_report(PAD, &[0x80, 0x80, 0x80, 0x80, hat, 0]).held;
    let (up, right, down, left) = (Button::Up, Button::Right, Button::Down, Button::Left);
    let turn = [vec(&[up]), vec(&[up, right]), vec(&[right]), vec(&[right, down])];
    let rest = [vec(&[down]), vec(&[down, left]), vec(&[left]), vec(&[left, up])];
    for (hat, buttons) in turn.iter().chain(&rest).enumerate() {
        assert_eq!(held(hat as u8), buttons.iter().copied().collect(), "{hat}");
    }
    assert!((8..16).all(|hat| held(hat).is_empty()));
}

fn vec(buttons: &[Button]) -> Vec<Button> {
    buttons.to_vec()
}

#[test]
fn signed_sticks_in_a_report_with_an_id_are_read() {
    let descriptor = [
        0x05, 0x01, 0x09, 0x04, 0xA1, 0x01, 0x85, 0x07, 0x09, 0x01, 0xA1, 0x00, // joystick, report 7
        0x16, 0x00, 0x80, 0x26, 0xFF, 0x7F, 0x75, 0x10, 0x95, 0x02, 0x09, 0x30, 0x09, 0x31, 0x81, 0x02, //
        0x09, 0x33, 0x09, 0x34, 0x81, 0x02, 0xC0, 0xC0, // Rx, Ry
    ];
    let layout = Layout::parse(&descriptor).unwrap();
    assert_eq!((layout.id, layout.length), (7, 9));
    let report = pad_report(&descriptor, &[0, 0x80, 0xFF, 0x7F, 0, 0, 1, 0]);
    assert_eq!((report.left_stick, report.right_stick), ([0, 255], [128, 128]));
}

#[test]
fn a_hat_of_four_directions_is_one_too() {
    let mut descriptor = PAD.to_vec();
    let maximum = PAD.windows(2).position(|pair| pair == [0x25, 0x07]).unwrap() + 1;
    descriptor[maximum] = 3;
    assert_eq!(pad_report(&descriptor, &[0, 0, 0, 0, 3, 0]).held, Button::Left.into());
    assert!(pad_report(&descriptor, &[0, 0, 0, 0, 4, 0]).held.is_empty());
}

#[test]
fn what_is_no_keyboard_and_no_pad_is_none() {
    let mouse = [
        0x05, 0x01, 0x09, 0x02, 0xA1, 0x01, 0x09, 0x01, 0xA1, 0x00, 0x05, 0x09, 0x19, 0x01, 0x29, 0x03, 0x15,
        0x00, //
        0x25, 0x01, 0x95, 0x03, 0x75, 0x01, 0x81, 0x02, 0x95, 0x01, 0x75, 0x05, 0x81, 0x01, 0x05, 0x01, 0x09,
        0x30, //
        0x09, 0x31, 0x15, 0x81, 0x25, 0x7F, 0x75, 0x08, 0x95, 0x02, 0x81, 0x06, 0xC0, 0xC0,
    ];
    assert_eq!(Layout::parse(&mouse), None);
    assert_eq!(Layout::parse(&[]), None);
    assert_eq!(Layout::parse(&PAD[..20]), None);
    assert_eq!(Layout::parse(&BOOT[..22]), None, "modifiers alone");
}

/// Random bytes, and real descriptors with random changes: no panic, here and in reading.
#[test]
fn nothing_upsets_it() {
    let mut state = 1_u64;
    let mut random = move || {
        state = state.wrapping_mul(0x5851_F42D_4C95_7F2D).wrapping_add(0x1405_7B7E_F767_814F);
        (state >> 40) as usize
    };
    let mut found = 0;
    for round in 0..100_000 {
        let mut bytes = match round % 4 {
            0 => (0..random() % 80).map(|_| random() as u8).collect(),
            1 => BOOT.to_vec(),
            2 => BITMAP.to_vec(),
            _ => PAD.to_vec(),
        };
        for _ in 0..random() % 6 {
            if !bytes.is_empty() {
                let at = random() % bytes.len();
                bytes[at] = random() as u8;
            }
        }
        let report: Vec<u8> = (0..random() % 65).map(|_| random() as u8).collect();
        if let Some(layout) = Layout::parse(&bytes) {
            found += 1;
            match layout.form {
                Form::Keyboard(keyboard) => drop(keyboard.boot_report(&report)),
                Form::Pad(pad) => drop(pad.read(&report).to_bytes()),
            }
        }
    }
    assert!(found > 30_000, "{found} were read");
}
