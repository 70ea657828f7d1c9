//! "3D Graphics Accelerator": many objects, each with its model matrix; a light with a colour; a camera that moves.

use controls::{Button, DualShock3Report};
use firmware::scene::Scene;
use firmware::scene::stage::Stage;
use firmware::style::Style;
use firmware::viewer::Viewer;
use host_tests::float_matrix::FloatMatrix;

use crate::{Player, difference, float, holding};

fn player() -> Player {
    Player::new(Viewer::new(Scene::Solids))
}

/// A pad whose right stick is pushed, in raw bytes, with buttons held.
fn pushing(right_stick: [u8; 2], held: &[Button]) -> DualShock3Report {
    DualShock3Report { right_stick, ..holding(held) }
}

#[test]
fn every_object_has_its_own_matrix_and_one_is_unevenly_scaled_and_turns() {
    let mut player = player();
    let before = player.frame(&[holding(&[])]);
    let after = player.frame(&[]);
    assert!(before.objects.len() >= 6, "{} objects", before.objects.len());
    for (index, object) in before.objects.iter().enumerate() {
        assert!(before.objects[..index].iter().all(|other| other.model != object.model));
    }
    let turning = before.objects.iter().zip(&after.objects).filter(|(before, after)| {
        let rows = float(&before.model);
        let lengths = [0, 1, 2].map(|axis| rows[..3].iter().map(|row| row[axis] * row[axis]).sum::<f64>().sqrt());
        let uneven = (lengths[0] - lengths[1]).abs() > 0.3 && (lengths[1] - lengths[2]).abs() > 0.3;
        uneven && before.model != after.model
    });
    assert!(turning.count() >= 1);
    let [red, green, blue] = before.light.colour;
    assert!(red > green && green > blue, "the light has a colour");
}

fn view(stage: &Stage) -> [[f64; 4]; 4] {
    float(&stage.camera.view)
}

#[test]
fn the_camera_takes_off_from_its_orbit_and_flies_the_way_it_looks() {
    let mut player = player();
    for _ in 0..20 {
        player.frame(&[pushing([0xC0, 0x60], &[])]);
    }
    let orbit = view(&player.frame(&[pushing([0x80, 0x80], &[])]));
    let flight = view(&player.frame(&[pushing([0x80, 0x80], &[Button::Circle])]));
    assert!(difference(&orbit, &flight) < 1e-6, "{orbit:?} became {flight:?}");
    // Full speed ahead: in the eye's own space everything comes nearer and nothing else.
    let ahead = view(&player.frame(&[pushing([0x80, 0x00], &[])]));
    let way = FloatMatrix(ahead).times(&FloatMatrix(flight).inverse().expect("a view turns and moves"));
    assert!(difference(&way.0, &FloatMatrix::translation([0.0, 0.0, 0.05]).0) < 1e-3, "{way:?}");
    // Held to the right it turns about the eye, which stays.
    let turned = view(&player.frame(&[pushing([0xFF, 0x80], &[])]));
    let eye = |view: [[f64; 4]; 4]| FloatMatrix(view).inverse().expect("a view").0.map(|row| row[3]);
    let moved = eye(ahead).iter().zip(eye(turned)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(moved < 1e-6 && difference(&ahead, &turned) > 0.01);
    // And back in orbit it looks at the middle again.
    player.frame(&[pushing([0x80, 0x80], &[])]);
    let back = view(&player.frame(&[pushing([0x80, 0x80], &[Button::Circle])]));
    assert!(difference(&back, &orbit) < 1e-6);
}

#[test]
fn projection_and_style_change_live() {
    let mut player = player();
    let perspective = player.frame(&[holding(&[])]);
    assert_eq!((perspective.style, perspective.camera.projection.rows[3][2].to_num::<i32>()), (Style::Smooth, -1));
    let parallel = player.frame(&[holding(&[Button::Square])]);
    assert_eq!(parallel.camera.projection.rows[3].map(|part| part.to_num::<i32>()), [0, 0, 0, 1]);
    player.frame(&[holding(&[])]);
    let styled = player.frame(&[holding(&[Button::Triangle])]);
    assert_eq!(styled.style, Style::Wire);
}
