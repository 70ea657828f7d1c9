//! Words in any pieces: good packets, bad ones, garbage, streams that end too early.

use fpga_regs::packet::{
    BadPacket, Channels, Clear, Fence, FlatTriangle, GouraudTriangle, Header, Kind, Packet, PixelMode, swap,
};
use fpga_regs::registers::{Control, Errors, Interrupts, Register, Status};
use fpga_regs::screen::Rgb332;
use raster_model::{Device, MidPacket};

use crate::lent::Lent;
use crate::reference::Reference;
use crate::rng::Rng;
use crate::setup::set_up;

fn triangle(colour: u8) -> FlatTriangle {
    set_up([(0, 0, 10.0), (320, 0, 10.0), (0, 320, 10.0)], colour).unwrap()
}

fn far(colour: u8) -> [u32; 2] {
    Clear { colour: Rgb332(colour), depth: u16::MAX }.encode()
}

#[test]
fn every_kind_of_packet_does_what_it_says() {
    for kind in Kind::ALL {
        let mut lent = Lent::new();
        let mut device = lent.enabled();
        device.push(&far(1));
        match kind {
            Kind::Clear => {
                device.push(&Clear { colour: Rgb332(0x5a), depth: 0x1234 }.encode());
                assert!(device.back().iter().all(|colour| *colour == 0x5a));
                assert!(device.depth().iter().all(|depth| *depth == 0x1234));
                assert!(device.front().iter().all(|colour| *colour == 0));
            }
            Kind::FlatTriangle => {
                device.push(&triangle(0x77).encode());
                // 20 + 19 + … + 1: half a square of 20 pixels whose diagonal is a right edge.
                assert_eq!(device.counters().pixels_written, 190);
                assert_eq!((device.back()[0], device.depth()[0]), (0x77, 10));
            }
            Kind::GouraudTriangle => {
                let level = |value: i32| Channels([value << 12; 3]);
                let packet = GouraudTriangle {
                    colour: level(255),
                    // Below zero in column 2.
                    colour_step_x: level(-130),
                    colour_step_y: level(0),
                    mode: PixelMode::USUAL,
                    shape: triangle(0).shape,
                };
                device.push(&packet.encode());
                assert_eq!(device.counters().pixels_written, 190);
                // 255 is full scale and less than 0 is 0 whatever the threshold; 125 is 110 of 224 and 94 of
                // 192: with threshold 8, (110 + 17) / 32 = 3 and (94 + 34) / 64 = 2.
                assert_eq!(device.back()[..3], [0xff, 3 << 5 | 3 << 2 | 2, 0]);
                assert_eq!(device.depth()[0], 10);
            }
            Kind::Swap => {
                device.push(&swap());
                assert_eq!((device.front()[0], device.back()[0]), (1, 0));
                assert_eq!(device.read(Register::FramesShown), 1);
                assert!(Interrupts(device.read(Register::Interrupts)).swap());
                assert!(Status(device.read(Register::Status)).front_buffer());
            }
            Kind::Fence => {
                device.push(&Fence { tag: 0xfeed_0001 }.encode());
                assert_eq!(device.read(Register::Fence), 0xfeed_0001);
                assert!(Interrupts(device.read(Register::Interrupts)).fence());
            }
            _ => panic!("no test for {kind:?}"),
        }
        assert_eq!((device.read(Register::Errors), device.read(Register::BadPackets)), (0, 0));
    }
}

/// A bad packet of every reason, its header's length filled with words that would draw if taken
/// for packets.
fn bad_packets() -> Vec<(BadPacket, Vec<u32>)> {
    let with_header = |header: u32| {
        let mut words = vec![header];
        words.extend(swap().iter().cycle().take((header >> 16 & 0xff) as usize));
        words
    };
    let with_word = |index: usize, word: u32| {
        let mut words = triangle(9).encode().to_vec();
        words[index] = word;
        words
    };
    let gouraud = |index: usize, word: u32| {
        let mut words = [&[0x0310_0000, 0, 0, 0, 0, 0, 0], &triangle(0).encode()[1..]].concat();
        words[index] = word;
        words
    };
    vec![
        (BadPacket::Kind, with_header(0)),
        (BadPacket::Kind, with_header(0xffff_ffff)),
        (BadPacket::Kind, with_header(0x0407_0000)),
        (BadPacket::Length, with_header(0x030a_0000)),
        (BadPacket::Reserved, with_header(0x0310_0001)),
        (BadPacket::Reserved, gouraud(2, 1 << 31)),
        (BadPacket::Reserved, gouraud(4, !0)),
        (BadPacket::Reserved, gouraud(6, 1 << 31)),
        (BadPacket::Box, gouraud(7, 320 << 16)),
        (BadPacket::Length, with_header(0x0100_0000)),
        (BadPacket::Length, with_header(0x0209_0000)),
        (BadPacket::Length, with_header(0x02ff_0000)),
        (BadPacket::Length, with_header(0x1001_0000)),
        (BadPacket::Reserved, with_header(0x0101_8000)),
        (BadPacket::Reserved, with_header(0x1000_0001)),
        (BadPacket::Reserved, with_header(0x1101_0080)),
        (BadPacket::Reserved, vec![0x0101_0033, 0x0001_0000]),
        (BadPacket::Box, with_word(1, 320 << 16)),
        (BadPacket::Box, with_word(1, 4 << 16 | 5)),
        (BadPacket::Box, with_word(2, 240 << 16)),
        (BadPacket::Box, with_word(2, 0xffff_ffff)),
    ]
}

#[test]
fn a_bad_packet_among_good_ones_is_counted_skipped_and_changes_nothing_else() {
    for (reason, bad) in bad_packets() {
        assert_eq!(Packet::decode(Header(bad[0]), &bad[1..]), Err(reason));
        let mut lent = Lent::new();
        let mut device = lent.enabled();
        let stream =
            [&far(1)[..], &triangle(2).encode(), &bad, &triangle(3).encode(), &bad, &Fence { tag: 4 }.encode()]
                .concat();
        device.push(&stream);
        let counters = device.counters();
        assert_eq!((counters.triangles, counters.bad_packets, counters.frames_shown), (2, 2, 0), "{bad:x?}");
        assert_eq!((counters.pixels_tested, counters.pixels_written), (380, 190), "{bad:x?}");
        assert_eq!(device.read(Register::Fence), 4);
        assert_eq!(device.back()[0], 2, "the second triangle is not nearer");
        assert_eq!(Errors(device.read(Register::Errors)), Errors::default().with_bad_packet(true));
        assert_eq!(device.mid_packet(), None);
    }
}

#[test]
fn a_fault_shows_with_the_header_or_else_with_the_last_word() {
    for (_, bad) in bad_packets() {
        let mut lent = Lent::new();
        let mut device = lent.enabled();
        let shows_at = if Header(bad[0]).check().is_err() { 0 } else { bad.len() - 1 };
        for (index, word) in bad.iter().enumerate() {
            device.push(&[*word]);
            let shows = u32::from(index >= shows_at);
            assert_eq!(device.read(Register::BadPackets), shows, "{bad:x?}, word {index}");
            assert_eq!(device.read(Register::Errors), shows);
            assert_eq!(Status(device.read(Register::Status)).mid_packet(), index + 1 < bad.len());
        }
    }
}

#[test]
fn a_stream_that_ends_inside_a_packet_tells_how_much_is_missing() {
    let mut lent = Lent::new();
    let mut device = lent.enabled();
    let words = triangle(5).encode();
    let header = Header(words[0]);
    assert_eq!(device.mid_packet(), None);
    for taken in 1..words.len() {
        device.push(&words[taken - 1..taken]);
        let stands = device.mid_packet().unwrap();
        assert_eq!(stands, MidPacket { header, missing: words.len() - taken });
        assert_eq!(stands.taken(), taken);
        assert!(Status(device.read(Register::Status)).busy());
        assert_eq!(device.counters().triangles, 0);
    }
    device.push(&words[words.len() - 1..]);
    assert_eq!((device.mid_packet(), device.counters().triangles), (None, 1));
    assert!(!Status(device.read(Register::Status)).busy());
    // A bad packet's words are missing just the same.
    device.push(&[0xff03_0000, 1]);
    assert_eq!(device.mid_packet(), Some(MidPacket { header: Header(0xff03_0000), missing: 2 }));
}

/// Any words; every few, a header that is right, so that all packets occur and are also cut off
/// and taken for payload.
fn garbage_stream(rng: &mut Rng, words: usize) -> Vec<u32> {
    let mut stream = Vec::with_capacity(words + Packet::MAX_WORDS);
    while stream.len() < words {
        let choice = rng.below(256);
        let kind = Kind::ALL[choice as usize % Kind::ALL.len()];
        match choice {
            0..96 => {
                let colour = if kind.has_colour() { rng.word() & 0xff } else { 0 };
                stream.push(Header::of(kind).0 | colour);
                stream.extend((0..kind.length()).map(|_| rng.word() & rng.word() & 0x007f_007f));
            }
            96..112 => stream.push(Header::of(kind).0),
            112..160 => stream.push(0),
            // Nearly all kinds are bad; a short length keeps the stream from being skipped whole.
            160..254 => stream.push(rng.word() & 0xff03_ffff),
            _ => stream.push(rng.word()),
        }
    }
    stream
}

/// Pushes a stream in pieces of any length.
fn push_in_pieces(rng: &mut Rng, device: &mut Device<'_>, mut stream: &[u32]) {
    while !stream.is_empty() {
        let (now, later) = stream.split_at(stream.len().min(rng.below(40) as usize));
        device.push(now);
        stream = later;
    }
}

#[test]
fn garbage_never_panics_and_does_what_the_reference_does() {
    let mut rng = Rng(4);
    let (mut lent, mut reference) = (Lent::new(), Reference::new());
    let mut device = lent.enabled();
    // One stream for the reference, which has no state between words.
    let stream = garbage_stream(&mut rng, 1_200_000);
    let missing = reference.take(&stream);
    push_in_pieces(&mut rng, &mut device, &stream);
    println!("{:?}", device.counters());
    assert_eq!(device.counters(), reference.counters);
    assert_eq!(device.read(Register::Fence), reference.fence);
    assert_eq!(device.mid_packet().map_or(0, |stands| stands.missing), missing);
    reference.assert_same_pictures(&device);
    let counters = device.counters();
    for (what, count) in
        [("triangles", counters.triangles), ("bad packets", counters.bad_packets), ("swaps", counters.frames_shown)]
    {
        assert!(count > 1_000, "only {count} {what}");
    }
}

#[test]
fn random_words_never_panic_and_zeros_or_a_reset_bring_the_stream_back() {
    let mut rng = Rng(5);
    let mut lent = Lent::new();
    let mut device = lent.enabled();
    for round in 0..1_000 {
        let words: Vec<u32> = (0..1_000 + rng.below(300)).map(|_| rng.word()).collect();
        device.push(&words);
        if round % 2 == 0 {
            // The longest packet ends within 255 words, and every further zero is a bad packet.
            device.push(&[0; 255]);
        } else {
            device.write(Register::Control, Control::default().with_reset(true).with_enable(true).0);
            assert_eq!(device.read(Register::BadPackets), 0);
        }
        assert_eq!(device.mid_packet(), None);
        let before = device.counters();
        device.push(&far(1));
        device.push(&triangle(2).encode());
        device.push(&Fence { tag: round }.encode());
        let after = device.counters();
        assert_eq!(after.pixels_written, before.pixels_written.wrapping_add(190));
        assert_eq!(after.bad_packets, before.bad_packets);
        assert_eq!(device.read(Register::Fence), round);
    }
}
