//! "Wireframe Simulator": its steps, its order of requests, its viewing plane.

use controls::Button;
use firmware::act::wireframe::{PAN, TURN, Window, ZOOM};
use firmware::scene::Scene;
use firmware::style::Projection;
use firmware::viewer::Viewer;
use fixed::types::I4F28;
use fpga_regs::packet::{Packet, PixelMode};
use fpga_regs::screen::{HEIGHT, Rgb332, WIDTH};
use geometry::mesh::Position;
use geometry::{Drawn, LineStyle, Matrix, Mesh, ScreenTransform, ScreenVertex, Sink, Transformed, Winding};
use host_tests::rng::Rng;

use crate::{Player, difference, float, holding};

fn player() -> Player {
    Player::new(Viewer::new(Scene::Wireframe))
}

/// The pose after a frame in which these buttons are down.
fn pose(player: &mut Player, held: &[Button]) -> [[f64; 4]; 4] {
    float(&player.frame(&[holding(held)]).objects[0].model)
}

/// A step's rotation in Q4.11: cos ε = 2,047/2,048.
#[test]
fn a_step_turns_moves_and_zooms_by_the_printed_amounts() {
    let cosine = 0.999_511_718_75;
    assert!((TURN.sin_cos().1.to_num::<f64>() - cosine).abs() < 2.0f64.powi(-29));
    assert_eq!((PAN.to_num::<f64>(), ZOOM.to_num::<f64>()), (0.0625, 0.125));
    let sine = f64::sqrt(1.0 - cosine * cosine);
    let turned = |rows: [[f64; 3]; 3]| {
        let [a, b, c] = rows.map(|[x, y, z]| [x, y, z, 0.0]);
        [a, b, c, [0.0, 0.0, 0.0, 1.0]]
    };
    // The near side goes the way of the arrow.
    for (button, expected) in [
        (Button::Left, turned([[cosine, 0.0, -sine], [0.0, 1.0, 0.0], [sine, 0.0, cosine]])),
        (Button::Right, turned([[cosine, 0.0, sine], [0.0, 1.0, 0.0], [-sine, 0.0, cosine]])),
        (Button::Up, turned([[1.0, 0.0, 0.0], [0.0, cosine, sine], [0.0, -sine, cosine]])),
        (Button::Down, turned([[1.0, 0.0, 0.0], [0.0, cosine, -sine], [0.0, sine, cosine]])),
    ] {
        let found = pose(&mut player(), &[button]);
        assert!(difference(&found, &expected) < 1e-8, "{button:?}: {found:?}");
    }
    for (button, panning, expected) in [
        (Button::R2, false, [0.0, 0.0, 0.125]),
        (Button::L2, false, [0.0, 0.0, -0.125]),
        (Button::Left, true, [-0.0625, 0.0, 0.0]),
        (Button::Right, true, [0.0625, 0.0, 0.0]),
        (Button::Up, true, [0.0, 0.0625, 0.0]),
        (Button::Down, true, [0.0, -0.0625, 0.0]),
        (Button::R2, true, [0.0, 0.0, 0.125]),
    ] {
        let mut player = player();
        if panning {
            pose(&mut player, &[Button::Circle]);
        }
        let found = pose(&mut player, &[button]);
        assert_eq!([found[0][3], found[1][3], found[2][3]], expected, "{button:?}");
    }
}

#[test]
fn requests_wait_for_their_frame_and_one_is_done_a_frame() {
    let mut player = player();
    // Nearer, then left, then farther, all tapped before the first frame.
    let taps = [Button::R2, Button::Left, Button::L2];
    let reports: Vec<_> = taps.iter().flat_map(|tap| [holding(&[*tap]), holding(&[])]).collect();
    let first = float(&player.frame(&reports).objects[0].model);
    assert_eq!((first[2][3], first[0][0]), (0.125, 1.0), "nearer alone");
    let second = pose(&mut player, &[]);
    assert!((second[2][3] - 0.125 * 0.999_511_718_75).abs() < 1e-8 && second[0][0] < 1.0, "then it turns");
    let third = pose(&mut player, &[]);
    assert!((third[2][3] - second[2][3] + 0.125).abs() < 1e-8, "then farther");
    assert_eq!(pose(&mut player, &[]), third, "and then it stays");
}

#[test]
fn ten_thousand_steps_leave_it_rigid() {
    let mut player = player();
    let mut rng = Rng(61);
    let mut last = pose(&mut player, &[]);
    for _ in 0..10_000 {
        let button = rng.pick(&[Button::Left, Button::Right, Button::Up, Button::Down, Button::R2, Button::L2]);
        last = pose(&mut player, &[button]);
    }
    for (index, row) in last[..3].iter().enumerate() {
        for (other_index, other) in last[..3].iter().enumerate() {
            let dot: f64 = (0..3).map(|axis| row[axis] * other[axis]).sum();
            let expected = f64::from(u8::from(index == other_index));
            assert!((dot - expected).abs() < 1e-8, "rows {index} and {other_index}: {dot}");
        }
        assert!(row[3].abs() <= 10.0);
    }
}

/// Ends of drawn lines in pixels.
struct Ends {
    room: [u32; Packet::MAX_WORDS],
    seen: Vec<[[f64; 2]; 2]>,
}

impl Sink for Ends {
    fn room<const N: usize>(&mut self) -> Option<&mut [u32; N]> {
        self.room.first_chunk_mut()
    }

    fn take<const N: usize>(&mut self, drawn: Drawn<'_>) {
        let Drawn::Line { ends, .. } = drawn else { panic!("{drawn:?} is no line") };
        self.seen.push(ends.map(|end| [end.x, end.y].map(|part| f64::from(part) / 16.0)));
    }
}

/// x_p = x_e − (z_e − a)/(z_e − z)·(x_e − x), the same for y, and the window to the screen with y turned over.
fn projected(window: &Window, [x, y, z]: [f64; 3]) -> [f64; 2] {
    let [eye_x, eye_y, eye_z] = window.eye.map(|part| part.to_num::<f64>());
    let plane = window.plane.to_num::<f64>();
    let on_plane = |eye: f64, at: f64| eye - (eye_z - plane) / (eye_z - z) * (eye - at);
    let ends = |(low, high): (fixed::types::I32F32, fixed::types::I32F32)| (low.to_num::<f64>(), high.to_num::<f64>());
    let ((left, right), (low, high)) = (ends(window.x), ends(window.y));
    let (x, y) = (on_plane(eye_x, x), on_plane(eye_y, y));
    [(x - left) / (right - left) * f64::from(WIDTH), (high - y) / (high - low) * f64::from(HEIGHT)]
}

#[test]
fn lines_are_projected_dropped_and_cut_at_the_viewing_plane() {
    let window = Window::OWN;
    let camera = window.camera(Projection::Perspective);
    let plane = window.plane.to_num::<f64>();
    let mut rng = Rng(62);
    let [mut dropped, mut cut, mut whole] = [0; 3];
    for _ in 0..2_000 {
        // Near the axis, so that the guard band cuts nothing.
        let ends = [0, 1].map(|_| [rng.between(-0.3, 0.3), rng.between(-0.3, 0.3), rng.between(-3.0, 3.5)]);
        let positions: Vec<Position> = ends.iter().map(|end| end.map(I4F28::from_num)).collect();
        let mesh = Mesh::new(&positions, &[], Winding::CounterClockwise).expect("no face, no fault");
        let transform = ScreenTransform::new(&camera.projection.times(&camera.view).times(&Matrix::IDENTITY), &mesh);
        let mut cache = [ScreenVertex::default(); 2];
        let transformed = Transformed::new(&mesh, &transform, &mut cache).expect("room for two");
        let mut sink = Ends { room: [0; Packet::MAX_WORDS], seen: Vec::new() };
        let style = LineStyle { colour: Rgb332(0x1c), mode: PixelMode::USUAL };
        transformed.draw_lines(&[[0, 1]], &style, &mut sink);
        let in_front = ends.map(|[_, _, z]| z > plane);
        let mut expected = ends;
        match in_front {
            [true, true] => {
                assert!(sink.seen.is_empty(), "{ends:?} is in front of the plane");
                dropped += 1;
                continue;
            }
            [false, false] => whole += 1,
            _ => {
                let behind = usize::from(in_front[0]);
                let ([a, b], share) = (ends, (plane - ends[0][2]) / (ends[1][2] - ends[0][2]));
                expected[1 - behind] = [0, 1, 2].map(|axis| a[axis] + (b[axis] - a[axis]) * share);
                cut += 1;
            }
        }
        let expected = expected.map(|end| projected(&window, end));
        let [found] = sink.seen[..] else { panic!("{ends:?}: {} lines", sink.seen.len()) };
        for (found, expected) in found.iter().zip(expected) {
            let apart = (found[0] - expected[0]).abs().max((found[1] - expected[1]).abs());
            assert!(apart < 0.0626, "{ends:?}: {found:?} instead of {expected:?}");
        }
    }
    assert!(dropped > 20 && cut > 300 && whole > 300, "{dropped} dropped, {cut} cut, {whole} whole");
}
