//! A serial line that loses, doubles, inserts and flips bytes.

mod random;

use controls::serial::{Decoder, FRAME_SIZE_MAXIMUM, encode};
use random::Random;
use std::collections::BTreeSet;

/// Damages a frame in one to four places and tells whether that made a difference.
fn damage(random: &mut Random, frame: &mut Vec<u8>) -> bool {
    let before = frame.clone();
    for _ in 0..=random.below(4) {
        if frame.is_empty() {
            break;
        }
        let at = random.below(frame.len());
        match random.below(6) {
            0 => drop(frame.remove(at)),
            1 => frame.insert(at, frame[at]),
            2 => frame.insert(at, random.next() as u8),
            3 => frame[at] ^= 1 << random.below(8),
            4 => frame[at] = random.next() as u8,
            _ => frame.truncate(at),
        }
    }
    *frame != before
}

/// A frame numbered so that it can be told from all others.
fn numbered(random: &mut Random, number: u32) -> (u8, Vec<u8>) {
    let mut payload = vec![0; random.below(247)];
    random.fill(&mut payload);
    if random.below(3) == 0 {
        payload.fill([0x00, 0xFF, 0x01][random.below(3)]);
    }
    payload.extend_from_slice(&number.to_le_bytes());
    (random.next() as u8, payload)
}

#[test]
fn each_undamaged_frame_comes_through_once_and_nothing_else_does() {
    let mut random = Random::new(0x5E81_A150);
    let mut decoder = Decoder::new();
    let (mut sent, mut undamaged, mut received) = (BTreeSet::new(), BTreeSet::new(), Vec::new());
    let (mut errors, mut damaged) = (0, 0);
    let mut put = |bytes: &[u8], received: &mut Vec<(u8, Vec<u8>)>| {
        for &byte in bytes {
            match decoder.feed(byte) {
                Some(Ok(frame)) => received.push((frame.kind, frame.payload.to_vec())),
                Some(Err(_)) => errors += 1,
                None => {}
            }
        }
    };
    for number in 0..20_000 {
        let (kind, payload) = numbered(&mut random, number);
        let mut frame = encode(kind, &payload, &mut [0; FRAME_SIZE_MAXIMUM]).unwrap().to_vec();
        sent.insert((kind, payload.clone()));
        if random.below(2) == 0 && damage(&mut random, &mut frame) {
            damaged += 1;
        } else {
            undamaged.insert((kind, payload));
        }
        put(&frame, &mut received);
        if random.below(20) == 0 {
            let mut noise = vec![0; random.below(900)];
            random.fill(&mut noise);
            put(&noise, &mut received);
        }
    }
    let unique: BTreeSet<_> = received.iter().cloned().collect();
    assert_eq!(unique.len(), received.len(), "a frame came twice");
    assert!(undamaged.is_subset(&unique), "{} lost", undamaged.difference(&unique).count());
    assert!(unique.is_subset(&sent), "{} made up", unique.difference(&sent).count());
    assert!(damaged > 9_000 && errors > 8_000, "{damaged} {errors}");
}

#[test]
fn noise_alone_makes_no_panic() {
    let mut random = Random::new(77);
    let mut decoder = Decoder::new();
    let mut found = 0;
    for _ in 0..1_000_000 {
        let byte = if random.below(40) == 0 { 0 } else { random.next() as u8 };
        found += usize::from(decoder.feed(byte).is_some_and(|frame| frame.is_ok()));
    }
    // One in 65,536 of some 30,000 runs passes the check by chance.
    assert!(found <= 4, "{found} frames out of noise");
}
