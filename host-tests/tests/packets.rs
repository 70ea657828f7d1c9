//! Every kind of packet, encoded by `fpga-regs` and taken by the model: its effect shows, a stream
//! that is cut short says how much is missing, and no stream of words hangs the device.

use fpga_regs::packet::{
    Channels, Clear, EdgeSteps, Fence, FlatTriangle, GouraudTriangle, Header, Kind, PixelMode, Span, TriangleShape,
    swap,
};
use fpga_regs::registers::{Errors, Register};
use fpga_regs::screen::{PIXELS, PacketDepth, Rgb332, WIDTH};
use host_tests::lent::with_device;
use host_tests::rng::Rng;
use raster_model::Device;

/// A square of four pixels' width at (10, 20), at depth 500, that no edge cuts.
fn square(colour: u8) -> FlatTriangle {
    FlatTriangle {
        colour: Rgb332(colour),
        mode: PixelMode::USUAL,
        shape: TriangleShape {
            columns: Span::new(10, 13),
            rows: Span::new(20, 23),
            edges: [0; 3],
            steps: [EdgeSteps::new(0, 0); 2],
            depth: PacketDepth::from_num(500),
            depth_step_x: PacketDepth::ZERO,
            depth_step_y: PacketDepth::ZERO,
        },
    }
}

/// As [`square`], of a colour that changes.
fn shaded_square() -> GouraudTriangle {
    GouraudTriangle {
        colour: Channels([200 << 12, 100 << 12, 0]),
        colour_step_x: Channels([1 << 12; 3]),
        colour_step_y: Channels([0; 3]),
        mode: PixelMode::USUAL,
        shape: square(0).shape,
    }
}

fn one_of_each() -> [Vec<u32>; 5] {
    [
        Clear { colour: Rgb332(9), depth: 1_000 }.encode().to_vec(),
        square(0xe3).encode().to_vec(),
        shaded_square().encode().to_vec(),
        swap().to_vec(),
        Fence { tag: 77 }.encode().to_vec(),
    ]
}

fn all_registers(device: &Device<'_>) -> Vec<u32> {
    // Low water depends on how the words came; the rest does not.
    let of = |register: &&Register| **register != Register::Interrupts;
    Register::ALL.iter().filter(of).map(|register| device.read(*register)).collect()
}

#[test]
fn a_clear_fills_the_back_buffer_and_the_depth_and_no_more() {
    with_device(|device| {
        device.push(&Clear { colour: Rgb332(0x5a), depth: 0xbeef }.encode());
        assert!(device.back().iter().all(|pixel| *pixel == 0x5a) && device.front().iter().all(|pixel| *pixel == 0));
        assert!(device.depth().iter().all(|depth| *depth == 0xbeef));
        assert_eq!(device.read(Register::PixelsWritten), 0, "clears do not count");
    });
}

#[test]
fn a_triangle_changes_its_pixels_where_it_is_nearer() {
    with_device(|device| {
        device.push(&Clear { colour: Rgb332(1), depth: 1_000 }.encode());
        device.push(&square(0xe3).encode());
        for (index, (pixel, depth)) in device.back().iter().zip(device.depth()).enumerate() {
            let (x, y) = (index % WIDTH as usize, index / WIDTH as usize);
            let inside = (10..14).contains(&x) && (20..24).contains(&y);
            assert_eq!((*pixel, *depth), if inside { (0xe3, 500) } else { (1, 1_000) }, "({x}, {y})");
        }
        // Not nearer than itself.
        device.push(&square(0xff).encode());
        assert_eq!(device.back()[20 * WIDTH as usize + 10], 0xe3);
        let counters = device.counters();
        assert_eq!((counters.triangles, counters.pixels_tested, counters.pixels_written), (2, 32, 16));
    });
}

#[test]
fn an_edge_cuts_a_triangle_and_its_depth_runs_in_steps() {
    with_device(|device| {
        device.push(&Clear { colour: Rgb332(0), depth: 0xffff }.encode());
        // Inside where 1 − x + y ≥ 0; the third edge's steps are minus the others' sum.
        let steps = [EdgeSteps::new(-1, 1), EdgeSteps::new(1, -1)];
        let shape = TriangleShape {
            edges: [1, 100, 0],
            steps,
            depth_step_x: PacketDepth::from_num(2),
            depth_step_y: PacketDepth::from_num(-0.5),
            ..square(7).shape
        };
        let triangle = FlatTriangle { shape, ..square(7) };
        device.push(&triangle.encode());
        for y in 0..4usize {
            for x in 0..4usize {
                let index = (20 + y) * WIDTH as usize + 10 + x;
                let expected =
                    if x <= y + 1 { (500.0 + 2.0 * x as f64 - 0.5 * y as f64).floor() as u16 } else { 0xffff };
                assert_eq!(device.depth()[index], expected, "({x}, {y})");
            }
        }
    });
}

#[test]
fn a_swap_shows_the_back_buffer_and_a_fence_leaves_its_tag() {
    with_device(|device| {
        device.push(&Clear { colour: Rgb332(0x33), depth: 0 }.encode());
        device.push(&swap());
        assert_eq!(device.front(), vec![0x33; PIXELS]);
        device.push(&Fence { tag: 0xdead_beef }.encode());
        assert_eq!((device.read(Register::Fence), device.read(Register::FramesShown)), (0xdead_beef, 1));
        assert_eq!(device.read(Register::Errors), 0);
    });
}

#[test]
fn a_stream_that_is_cut_short_says_how_much_is_missing() {
    for packet in one_of_each() {
        for taken in 1..packet.len() {
            with_device(|device| {
                device.push(&packet[..taken]);
                let mid_packet = device.mid_packet().expect("the packet is not whole");
                assert_eq!((mid_packet.taken(), mid_packet.missing), (taken, packet.len() - taken));
                assert_eq!(mid_packet.header, Header(packet[0]));
                let counters = device.counters();
                assert_eq!((counters.triangles, counters.frames_shown, device.read(Register::Fence)), (0, 0, 0));
                device.push(&packet[taken..]);
                assert_eq!(device.mid_packet(), None);
            });
        }
    }
}

#[test]
fn the_sizes_of_the_pieces_do_not_matter() {
    let mut rng = Rng(71);
    for _ in 0..40 {
        let mut stream = Vec::new();
        for _ in 0..rng.within(1, 60) {
            stream.extend(&one_of_each()[rng.below(5) as usize]);
            if rng.once_in(10) {
                // A bad packet in between, skipped by its length.
                stream.extend([0x7703_0000, 1, 2, 3]);
            }
        }
        let whole = with_device(|device| {
            device.push(&stream);
            (all_registers(device), device.front().to_vec(), device.back().to_vec(), device.depth().to_vec())
        });
        with_device(|device| {
            let mut rest = &stream[..];
            while !rest.is_empty() {
                let (now, later) = rest.split_at(rest.len().min(rng.within(1, 14) as usize));
                device.push(now);
                rest = later;
            }
            assert_eq!(all_registers(device), whole.0);
            assert!(device.front() == whole.1 && device.back() == whole.2 && device.depth() == whole.3);
        });
    }
}

#[test]
fn each_bad_packet_is_counted_skipped_and_harmless() {
    let header = |kind: u32, length: u32, low: u32| kind << 24 | length << 16 | low;
    let mut bad: Vec<Vec<u32>> = vec![
        vec![0],
        vec![header(0x01, 0, 9)],
        vec![header(0x01, 2, 9), 0, 0],
        vec![header(0x01, 1, 9), 0x1_0000],
        vec![header(0x10, 0, 1)],
        vec![header(0x11, 1, 0x100), 5],
        vec![header(0x02, 9, 0); 10],
        [vec![header(0xff, 255, 0)], vec![header(0x10, 0, 0); 255]].concat(),
    ];
    for (columns, rows) in [((4, 3), (0, 0)), ((0, 320), (0, 0)), ((0, 0), (0, 240)), ((0, 0), (9, 8))] {
        let (columns, rows) = (Span::new(columns.0, columns.1), Span::new(rows.0, rows.1));
        bad.push(
            FlatTriangle { shape: TriangleShape { columns, rows, ..square(1).shape }, ..square(1) }.encode().to_vec(),
        );
    }
    with_device(|device| {
        for (number, packet) in bad.iter().enumerate() {
            device.push(packet);
            assert_eq!(device.mid_packet(), None, "{packet:x?}");
            assert_eq!(device.read(Register::BadPackets) as usize, number + 1, "{packet:x?}");
            assert_eq!(device.read(Register::Errors), Errors::default().with_bad_packet(true).0);
        }
        let counters = device.counters();
        assert_eq!((counters.triangles, counters.frames_shown, device.read(Register::Fence)), (0, 0, 0));
        assert!(device.back().iter().all(|pixel| *pixel == 0));
        device.push(&Fence { tag: 1 }.encode());
        assert_eq!(device.read(Register::Fence), 1, "the stream goes on");
    });
}

#[test]
fn no_stream_of_words_hangs_the_device() {
    with_device(|device| {
        let mut rng = Rng(72);
        for _ in 0..200_000 {
            // Many of them headers and boxes that are right or nearly so.
            let kind = rng.pick(Kind::ALL);
            let word = match rng.below(8) {
                0..=2 => Header::of(kind).0,
                3 => Header::of(kind).0 | 1 << rng.below(32),
                4..=6 => Span::new(rng.below(120) as u16, rng.within(100, 250) as u16).0,
                _ => rng.word(),
            };
            device.push(&[word]);
        }
        // At most 255 words are missing: then the stream is in step again.
        while device.mid_packet().is_some() {
            device.push(&[0]);
        }
        device.push(&Fence { tag: 4_321 }.encode());
        assert_eq!(device.read(Register::Fence), 4_321);
        let counters = device.counters();
        assert!(counters.bad_packets > 1_000 && counters.triangles > 30 && counters.frames_shown > 100, "{counters:?}");
    });
}
