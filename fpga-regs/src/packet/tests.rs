use super::*;
use crate::screen::{PacketDepth, Rgb332};

fn triangle() -> FlatTriangle {
    FlatTriangle { colour: Rgb332(0xe3), mode: PixelMode::USUAL, shape: shape() }
}

fn shape() -> TriangleShape {
    TriangleShape {
        columns: Span::new(3, 319),
        rows: Span::new(0, 239),
        edges: [-1, 1 << 26, -(1 << 26)],
        steps: [EdgeSteps::new(-32_766, 32_766), EdgeSteps::new(5, -7)],
        depth: PacketDepth::from_bits(i32::MIN),
        depth_step_x: PacketDepth::from_bits(-1),
        depth_step_y: PacketDepth::from_num(2.5),
    }
}

fn gouraud() -> GouraudTriangle {
    GouraudTriangle {
        colour: Channels([0x1f_ffff, 0x00_0001, 0x10_0000]),
        colour_step_x: Channels([1, 0x1f_f7ff, 2]),
        colour_step_y: Channels([0, 0x00_0800, 0x1f_ffff]),
        mode: PixelMode::USUAL,
        shape: shape(),
    }
}

fn round_trip(words: &[u32]) -> Result<Packet, BadPacket> {
    Packet::decode(Header(words[0]), &words[1..])
}

#[test]
fn every_kind_comes_back_as_it_was_encoded() {
    let clear = Clear { colour: Rgb332(0x1c), depth: 0xfffe };
    assert_eq!(round_trip(&clear.encode()), Ok(Packet::Clear(clear)));
    assert_eq!(round_trip(&triangle().encode()), Ok(Packet::FlatTriangle(triangle())));
    assert_eq!(round_trip(&gouraud().encode()), Ok(Packet::GouraudTriangle(gouraud())));
    assert_eq!(round_trip(&swap()), Ok(Packet::Swap));
    let fence = Fence { tag: 0xdead_beef };
    assert_eq!(round_trip(&fence.encode()), Ok(Packet::Fence(fence)));
}

#[test]
fn a_mode_is_three_bits_of_the_header() {
    for bits in 0..8 {
        let mode = PixelMode { keep_depth: bits & 1 != 0, keep_colour: bits & 2 != 0, depth_grey: bits & 4 != 0 };
        let flat = FlatTriangle { mode, ..triangle() };
        assert_eq!(flat.encode()[0], 0x020a_00e3 | bits << 8);
        assert_eq!(round_trip(&flat.encode()), Ok(Packet::FlatTriangle(flat)));
        let gouraud = GouraudTriangle { mode, ..gouraud() };
        assert_eq!(gouraud.encode()[0], 0x0310_0000 | bits << 8);
        assert_eq!(round_trip(&gouraud.encode()), Ok(Packet::GouraudTriangle(gouraud)));
    }
}

#[test]
fn the_words_of_a_triangle_stand_where_the_table_says() {
    // Written out by hand from the table in the reference page.
    let words = triangle().encode();
    assert_eq!(words[0], 0x020a_00e3);
    assert_eq!(words[1], 319 << 16 | 3);
    assert_eq!(words[6], 0x7ffe_8002);
    assert_eq!(words[7], 0xfff9_0005);
    assert_eq!(words[10], 0x2800);
    assert_eq!(shape().all_steps()[2], (32_761, -32_759));
    let words = gouraud().encode();
    assert_eq!(words[..7], [0x0310_0000, 0x003f_ffff, 0x4000_0000, 0xffe0_0001, 0x0bfe, 0, 0x7fff_fc01]);
    assert_eq!(words[7..], triangle().encode()[1..]);
    // Only the low 21 bits count.
    assert_eq!(Channels([-1, -1, -1]).encode(), [!0, 0x7fff_ffff]);
}

#[test]
fn the_table_has_a_word_for_every_word() {
    for kind in Kind::ALL {
        assert_eq!(kind.info().words.len(), kind.length(), "{kind:?}");
        assert_eq!(Kind::from_number(*kind as u8), Some(*kind));
        assert!(kind.length() < Packet::MAX_WORDS);
        let mut names: Vec<_> = kind.info().words.iter().map(|word| word.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), kind.length(), "{kind:?}");
    }
    assert_eq!((0..=255).filter(|number| Kind::from_number(*number).is_some()).count(), Kind::ALL.len());
}

#[test]
fn each_rule_makes_its_own_bad_packet() {
    let good = triangle().encode();
    let with = |index: usize, word: u32| {
        let mut words = good;
        words[index] = word;
        round_trip(&words)
    };
    assert_eq!(with(0, 0), Err(BadPacket::Kind));
    assert_eq!(with(0, 0x0209_0000), Err(BadPacket::Length));
    assert_eq!(with(0, 0x020a_0800), Err(BadPacket::Reserved));
    assert_eq!(with(0, 0x020a_8000), Err(BadPacket::Reserved));
    for header in [0x0101_0100, 0x0101_0200, 0x0101_0400, 0x1000_0100, 0x1101_0400] {
        assert_eq!(round_trip(&[header, 0]), Err(BadPacket::Reserved), "{header:#x} has a mode");
    }
    assert_eq!(with(1, Span::new(4, 3).0), Err(BadPacket::Box));
    assert_eq!(with(1, Span::new(0, 320).0), Err(BadPacket::Box));
    assert_eq!(with(2, Span::new(0, 240).0), Err(BadPacket::Box));
    assert_eq!(round_trip(&[0x1000_0001]), Err(BadPacket::Reserved));
    for high in [2, 4, 6] {
        let mut words = gouraud().encode();
        words[high] |= 1 << 31;
        assert_eq!(round_trip(&words), Err(BadPacket::Reserved));
    }
    assert_eq!(round_trip(&[0x0310_0001; 17]), Err(BadPacket::Reserved));
    assert_eq!(round_trip(&[0x0101_0000, 0x1_0000]), Err(BadPacket::Reserved));
    assert_eq!(Packet::decode(Header::of(Kind::Fence), &[]), Err(BadPacket::Length));
}
