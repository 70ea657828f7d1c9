use super::*;

/// Feeds bytes and returns the report after them.
fn after(bytes: &[u8]) -> KeyboardReport {
    let mut decoder = Decoder::new();
    for byte in bytes {
        decoder.push(*byte);
    }
    decoder.report()
}

#[test]
fn a_key_is_held_from_make_to_break() {
    let mut decoder = Decoder::new();
    assert_eq!(decoder.push(0x1C), Some([0, 0, 0x04, 0, 0, 0, 0, 0]));
    assert_eq!(decoder.push(0x1C), None, "a typematic repeat changes nothing");
    assert_eq!(decoder.push(0xF0), None);
    assert_eq!(decoder.push(0x1C), Some([0; 8]));
}

#[test]
fn arrows_and_keypad_share_codes_but_for_the_prefix() {
    assert_eq!(after(&[0xE0, 0x75])[2], 0x52, "up");
    assert_eq!(after(&[0x75])[2], 0x60, "keypad 8");
    assert_eq!(after(&[0xE0, 0x75, 0x75, 0xE0, 0xF0, 0x75])[2..4], [0x60, 0]);
}

#[test]
fn modifiers_stand_in_byte_zero() {
    let modifiers: [&[u8]; 8] =
        [&[0x14], &[0x12], &[0x11], &[0xE0, 0x1F], &[0xE0, 0x14], &[0x59], &[0xE0, 0x11], &[0xE0, 0x27]];
    for (bit, bytes) in modifiers.iter().enumerate() {
        assert_eq!(after(bytes), [1 << bit, 0, 0, 0, 0, 0, 0, 0]);
    }
}

#[test]
fn faked_shifts_are_no_shifts() {
    assert_eq!(after(&[0xE0, 0x12, 0xE0, 0x7C]), [0, 0, 0x46, 0, 0, 0, 0, 0]);
    assert_eq!(after(&[0x12, 0xE0, 0xF0, 0x12, 0xE0, 0x6B]), [2, 0, 0x50, 0, 0, 0, 0, 0]);
}

#[test]
fn six_keys_fit_and_a_seventh_is_a_rollover() {
    let mut decoder = Decoder::new();
    for code in [0x1C, 0x32, 0x21, 0x23, 0x24, 0x2B, 0x14] {
        decoder.push(code);
    }
    assert_eq!(decoder.report(), [1, 0, 4, 5, 6, 7, 8, 9]);
    assert_eq!(decoder.push(0x34), Some([1, 0, 1, 1, 1, 1, 1, 1]));
    decoder.push(0xF0);
    assert_eq!(decoder.push(0x1C), Some([1, 0, 5, 6, 7, 8, 9, 0x0A]));
}

#[test]
fn pause_is_taken_in_and_leaves_the_next_key_alone() {
    const PAUSE: [u8; 8] = [0xE1, 0x14, 0x77, 0xE1, 0xF0, 0x14, 0xF0, 0x77];
    assert_eq!(after(&PAUSE), [0; 8]);
    let mut decoder = Decoder::new();
    for byte in PAUSE {
        assert_eq!(decoder.push(byte), None);
    }
    assert_eq!(decoder.push(0x29), Some([0, 0, 0x2C, 0, 0, 0, 0, 0]));
    assert_eq!(after(&[0xE1, 0x14, 0x29])[2], 0x2C, "a broken-off sequence swallows no key");
}

#[test]
fn an_overrun_releases_all_keys() {
    for overrun in [0x00, 0xFF, 0xAA] {
        assert_eq!(after(&[0x12, 0x1C, overrun]), [0; 8]);
        assert_eq!(after(&[0x1C, 0xE0, 0xF0, overrun, 0x32])[2], 0x05, "and no prefix is left over");
    }
}

#[test]
fn a_lost_release_lasts_until_the_key_is_used_again() {
    // 'a' pressed, its release lost; 'b' comes and goes; 'a' is pressed and released again.
    assert_eq!(after(&[0x1C, 0x32, 0xF0, 0x32])[2], 0x04);
    assert_eq!(after(&[0x1C, 0x32, 0xF0, 0x32, 0x1C, 0xF0, 0x1C]), [0; 8]);
    // A release without a press is harmless.
    assert_eq!(after(&[0xF0, 0x1C]), [0; 8]);
}

#[test]
fn answers_are_no_keys() {
    assert_eq!(after(&[0xFA, 0xEE, 0xFE, 0xFC, 0x85, 0x02, 0xE0, 0x02]), [0; 8]);
}

/// Any bytes give well-formed reports, reported exactly when they change, and an overrun byte
/// (two, when the first ends inside Pause) brings the decoder back to its start.
#[test]
fn random_bytes_keep_the_state_consistent() {
    let mut random = 0x2545_F491_4F6C_DD1D_u64;
    let mut decoder = Decoder::new();
    let mut last = decoder.report();
    for step in 0..200_000 {
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        // Every other byte from the likely ones, so that sequences come up.
        let likely = [0xE0, 0xF0, 0xE1, 0x14, 0x77, 0x12, 0x1C, 0x75];
        let byte = if random & 1 == 0 { (random >> 8) as u8 } else { likely[(random >> 8) as usize % 8] };
        let changed = decoder.push(byte);
        let report = decoder.report();
        assert_eq!(changed, (report != last).then_some(report), "step {step}");
        assert_eq!(report[1], 0);
        let keys = &report[2..];
        assert!(
            keys.iter().all(|key| *key == ROLLOVER) || keys.windows(2).all(|pair| pair[0] < pair[1] || pair[1] == 0),
            "step {step}: {report:02x?}"
        );
        last = report;
    }
    decoder.push(0x00);
    assert_eq!(decoder, Decoder::new());
}
