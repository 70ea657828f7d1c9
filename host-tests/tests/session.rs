//! The whole application, from the serial line's bytes to the picture's checksum, in this process.

use controls::serial::{FRAME_SIZE_MAXIMUM, encode, kind};
use controls::{Acceleration, Button, Buttons, DualShock3Report};
use firmware::link::{self, FrameReport, HostMessage};
use firmware::scene::Scene;
use firmware::style::Style;
use host_tests::rng::Rng;
use xtask::machine::{Link, Machine, with_host, with_host_and_mesh};

/// The host's end of the application's serial line.
type Line<'a> = Link<'a, dyn Machine + 'a>;
type Report = [u8; DualShock3Report::LENGTH];

/// A pad held at an angle to the left, in degrees, its sticks pushed a little.
fn leaning(degrees: f64, held: &[Button]) -> Report {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    let raw = [511.0 + 113.0 * sine, 511.0, 511.0 - 113.0 * cosine].map(|word| word.round() as u16);
    let held: Buttons = held.iter().copied().collect();
    DualShock3Report { held, acceleration: Acceleration::from_raw(raw), ..Default::default() }.to_bytes()
}

fn with_link<R>(work: impl FnOnce(&mut Line<'_>) -> R) -> R {
    with_host(|machine| Ok(work(&mut Link::new(machine)))).expect("the application starts")
}

/// What the console has said after these bytes and a frame.
fn console_after(typed: &[&[u8]]) -> String {
    let said = with_host(|machine| {
        let mut said = String::new();
        for bytes in typed {
            machine.send(bytes)?;
            // Nobody answers: what is left to read is the console.
            said = machine.receive("an answer").expect_err("keys are not answered").to_string();
        }
        Ok(said)
    });
    said.expect("the application starts")
}

fn frame(link: &mut Line<'_>, report: &Report) -> FrameReport {
    link.dualshock3(report).expect("the line takes it");
    link.step().expect("a frame comes")
}

fn checksum(report: FrameReport) -> u32 {
    report.checksum.expect("the host sees its framebuffer")
}

/// A report's bytes on the line.
fn on_the_line(report: &Report) -> Vec<u8> {
    let mut buffer = [0; FRAME_SIZE_MAXIMUM];
    encode(kind::DUALSHOCK3, report, &mut buffer).expect("a report fits a frame").to_vec()
}

/// Ten frames of every scene, the pad leaning farther and farther.
fn session(link: &mut Line<'_>) -> Vec<FrameReport> {
    let mut frames = Vec::new();
    for scene in Scene::ALL {
        link.begin(scene.index() as u8).expect("the scene begins");
        frames.extend((0..10).map(|step| frame(link, &leaning(f64::from(step) * 4.0, &[]))));
    }
    frames
}

#[test]
fn the_same_session_gives_the_same_frames() {
    let first = with_link(session);
    let (again, once_more) = with_link(|link| (session(link), session(link)));
    assert_eq!(first, again, "in another process's stead");
    assert_eq!(again, once_more, "after another session");
    let mut checksums: Vec<u32> = first.iter().map(|report| checksum(*report)).collect();
    checksums.sort_unstable();
    checksums.dedup();
    // A pad that leans does not move the wireframe, whose ten frames are one.
    assert!(checksums.len() >= first.len() - 11, "the frames hardly differ: {} of {}", checksums.len(), first.len());
}

#[test]
fn a_frames_report_adds_up() {
    let flat = Scene::ALL.iter().take_while(|scene| scene.style() == Style::Flat).count();
    assert_eq!(flat, 3);
    for report in with_link(session).into_iter().take(10 * flat) {
        // A triangle is 11 words; a clear 2, a swap 1, a fence 2.
        assert_eq!(report.words, 11 * report.triangles_drawn + 5, "{report:?}");
        assert_eq!(report.packets, report.triangles_drawn + 3, "{report:?}");
        assert!([120, 4_096].contains(&report.triangles_submitted), "{report:?}");
        assert!(report.triangles_drawn > 50 && report.index < 10, "{report:?}");
    }
}

#[test]
fn what_the_screen_shows_is_what_the_board_drew() {
    with_link(|link| {
        link.begin(0).expect("the scene begins");
        for step in 0..5 {
            let report = frame(link, &leaning(f64::from(step) * 9.0, &[]));
            let (screen, picture) = link.screen().expect("the host has a screen");
            assert_eq!(screen, checksum(report));
            assert!(picture.pixels().any(|pixel| pixel != [0; 3]), "the screen is black");
        }
    });
}

#[test]
fn cross_freezes_every_scene_and_letting_go_resumes() {
    for scene in Scene::ALL {
        with_link(|link| {
            link.begin(scene.index() as u8).expect("the scene begins");
            for _ in 0..5 {
                frame(link, &leaning(10.0, &[Button::Left]));
            }
            let still = checksum(frame(link, &leaning(10.0, &[Button::Left, Button::Cross])));
            for step in 0..8 {
                let held = [Button::Left, Button::Cross];
                let frozen = checksum(frame(link, &leaning(10.0 + f64::from(step) * 6.0, &held)));
                assert_eq!(frozen, still, "{scene:?} moved while frozen");
            }
            let resumed = checksum(frame(link, &leaning(58.0, &[Button::Left])));
            assert_ne!(resumed, still, "{scene:?} stays frozen");
        });
    }
}

/// A message chooses scene and style; numbers that there are not change nothing.
#[test]
fn a_message_shows_a_scene_and_a_style() {
    with_link(|link| {
        link.begin(0).expect("the scene begins");
        let plate = checksum(frame(link, &leaning(0.0, &[])));
        link.show(None, Some(Style::Wire)).expect("the line takes it");
        let lines = frame(link, &leaning(0.0, &[]));
        assert_eq!(lines.triangles_submitted, 180, "the plate's edges");
        assert_ne!(checksum(lines), plate);
        link.show(Some(Scene::Torus), None).expect("the line takes it");
        let torus = frame(link, &leaning(0.0, &[]));
        assert_eq!((torus.triangles_submitted, torus.words), (4_096, 11 * torus.triangles_drawn + 5), "flat again");
        link.send_raw(&show(Some(Scene::ALL.len() as u8), Some(0))).expect("the line takes it");
        link.send_raw(&show(Some(0), Some(Style::ALL.len() as u8))).expect("the line takes it");
        assert_eq!(frame(link, &leaning(0.0, &[])).triangles_submitted, 4_096);
    });
}

/// A cube, its outlines beside whatever `more` says.
fn cube_and(more: &str) -> Vec<u8> {
    let cube = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
                f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 1 5 8 4\n";
    let text = format!("{cube}{more}");
    let model = models::obj::parse_obj(text.as_bytes(), "cube.obj".as_ref(), |_| Ok(None)).expect("a good model");
    models::compile::compile(&model, &Default::default()).expect("it compiles").bytes
}

#[test]
fn a_line_beside_a_models_faces_shows_among_its_edges_alone() {
    let draw = |mesh: Vec<u8>, style: Style| {
        let drawn = with_host_and_mesh(mesh, |machine| {
            let link = &mut Link::new(machine);
            link.begin(Scene::Model.index() as u8).expect("the scene begins");
            link.show(None, Some(style)).expect("the line takes it");
            Ok(frame(link, &leaning(0.0, &[])))
        });
        drawn.expect("the application starts")
    };
    for style in Style::ALL {
        // From corner to corner through the cube.
        let (with, without) = (draw(cube_and("l 1 7\n"), *style), draw(cube_and(""), *style));
        let line = u32::from(matches!(style, Style::Wire | Style::HiddenLines));
        assert_eq!(with.triangles_drawn, without.triangles_drawn + line, "{style:?}");
        assert_eq!(with.checksum == without.checksum, *style != Style::Wire, "{style:?}");
    }
}

fn show(scene: Option<u8>, style: Option<u8>) -> Vec<u8> {
    let mut buffer = [0; FRAME_SIZE_MAXIMUM];
    let message = HostMessage::Show { scene, style };
    link::encode(link::HOST_MESSAGE, &message, &mut buffer).expect("a message fits a frame").to_vec()
}

#[test]
fn start_goes_to_the_next_scene_once_a_press() {
    with_link(|link| {
        let scenes = Scene::ALL.len();
        let firsts: Vec<u32> = (0..scenes as u8)
            .map(|scene| {
                link.begin(scene).expect("the scene begins");
                // The first frame of a scene that Start came to has not moved yet.
                frame(link, &leaning(0.0, &[])).triangles_submitted
            })
            .collect();
        assert_eq!(firsts[..3], [120, 4_096, 4_096]);
        link.begin(0).expect("the scene begins");
        let mut seen = vec![checksum(frame(link, &leaning(0.0, &[])))];
        for expected in (1..=scenes).map(|next| firsts[next % scenes]) {
            let pressed = frame(link, &leaning(0.0, &[Button::Start]));
            assert_eq!(pressed.triangles_submitted, expected);
            // Held on, it goes no further: the torus stays the torus, moving on.
            for _ in 0..3 {
                assert_eq!(frame(link, &leaning(0.0, &[Button::Start])).triangles_submitted, expected);
            }
            seen.push(checksum(pressed));
            frame(link, &leaning(0.0, &[]));
        }
        assert_eq!(seen[0], seen[scenes], "a press a scene comes back to the plate");
        seen.pop();
        seen.sort_unstable();
        seen.dedup();
        assert_eq!(seen.len(), scenes, "each scene shows something else");
        // Select goes back.
        let before = frame(link, &leaning(0.0, &[Button::Select])).triangles_submitted;
        assert_eq!(before, firsts[scenes - 1]);
    });
}

/// A byte inside a frame flipped, lost or doubled costs that report and no other: the frames are
/// those of a session in which it was never sent.
#[test]
fn a_damaged_report_is_as_if_it_had_not_been_sent() {
    let reports: Vec<Report> = (0..60).map(|step| leaning(30.0 * (f64::from(step) / 9.0).sin(), &[])).collect();
    let mut rng = Rng(81);
    let damaged: Vec<bool> = reports.iter().map(|_| rng.once_in(3)).collect();
    assert!(damaged.iter().filter(|it| **it).count() > 10);
    let expected: Vec<FrameReport> = with_link(|link| {
        link.begin(0).expect("the scene begins");
        let whole = reports.iter().zip(&damaged);
        whole
            .map(|(report, damaged)| {
                if !damaged {
                    link.dualshock3(report).expect("the line takes it");
                }
                link.step().expect("a frame comes")
            })
            .collect()
    });
    let found: Vec<FrameReport> = with_link(|link| {
        link.begin(0).expect("the scene begins");
        let all = reports.iter().zip(&damaged);
        all.map(|(report, damaged)| {
            let mut bytes = on_the_line(report);
            if *damaged {
                let at = rng.within(1, bytes.len() as i32 - 2) as usize;
                match rng.below(3) {
                    0 => bytes[at] ^= 1 << rng.below(8),
                    1 => drop(bytes.remove(at)),
                    _ => bytes.insert(at, bytes[at]),
                }
            }
            link.send_raw(&bytes).expect("the line takes it");
            link.step().expect("a frame comes")
        })
        .collect()
    });
    assert_eq!(found, expected);
}

/// Steps are damaged as well: those frames are not drawn, and nothing else happens.
#[test]
fn a_session_goes_on_over_a_bad_line() {
    with_link(|link| {
        let expected = session(link);
        let mut rng = Rng(82);
        link.begin(1).expect("the scene begins");
        let mut answered = 0;
        for step in 0..200 {
            let mut bytes = on_the_line(&leaning(f64::from(step % 40), &[]));
            let at = rng.below(bytes.len() as u32) as usize;
            match rng.below(4) {
                0 => bytes.truncate(at),
                1 => bytes[at] = rng.word() as u8,
                2 => drop(bytes.drain(..at)),
                _ => {}
            }
            link.send_raw(&bytes).expect("the line takes it");
            answered += usize::from(link.step().is_ok());
        }
        assert!(answered >= 190, "only {answered} of 200 steps were answered");
        assert_eq!(session(link), expected, "what comes later is right");
    });
}

#[test]
fn garbage_is_survived_and_forgotten() {
    with_link(|link| {
        let expected = session(link);
        let mut rng = Rng(83);
        for round in 0..10 {
            let garbage: Vec<u8> = (0..10_000)
                .map(|_| match round % 3 {
                    0 => rng.word() as u8,
                    // Short frames, many zeros.
                    1 => rng.below(6) as u8,
                    _ => rng.pick(&[0, 1, 2, 3, 0x40, 0x41, 0xff]),
                })
                .collect();
            link.send_raw(&garbage).expect("the line takes it");
            link.begin(0).expect("it answers after garbage");
        }
        assert_eq!(session(link), expected);
    });
}

/// Frames whose check is right and whose content is not: reports of wrong sizes, kinds that
/// nobody has, messages that are none.
#[test]
fn whole_frames_of_nonsense_change_nothing() {
    let mut rng = Rng(84);
    let frames = |link: &mut Line<'_>, nonsense: &mut dyn FnMut() -> Vec<u8>| -> Vec<FrameReport> {
        link.begin(0).expect("the scene begins");
        (0..20)
            .map(|step| {
                link.send_raw(&nonsense()).expect("the line takes it");
                frame(link, &leaning(f64::from(step), &[]))
            })
            .collect()
    };
    let expected = with_link(|link| frames(link, &mut Vec::new));
    let found = with_link(|link| {
        frames(link, &mut || {
            let mut bytes = Vec::new();
            for _ in 0..20 {
                let number = rng.pick(&[0, kind::DUALSHOCK3, kind::KEYBOARD, 0x04, 0x3f, 0x40, 0x41, 0x99, 0xff]);
                // A message's first byte is its number; 4 and above are none.
                let payload: Vec<u8> = (0..rng.below(48)).map(|_| 4 | rng.word() as u8).collect();
                let real = number == kind::KEYBOARD && payload.len() == 8;
                if !real {
                    let mut buffer = [0; FRAME_SIZE_MAXIMUM];
                    bytes.extend(encode(number, &payload, &mut buffer).expect("it fits"));
                }
            }
            bytes
        })
    });
    assert_eq!(found, expected);
}

#[test]
fn keys_typed_at_a_terminal_choose_scene_style_projection_and_mode() {
    let said = console_after(&[b"\t", b"v", b"c", b"\r\n", b"h"]);
    let expected =
        ["style: smooth", "projection: orthographic", "mode: matrices of 2014", "scene: torus", "this legend"];
    let mut rest = said.as_str();
    for line in expected {
        let Some(at) = rest.find(line) else { panic!("`{line}` is missing or too early in {said}") };
        rest = &rest[at..];
    }
}

#[test]
fn after_a_frame_of_a_program_letters_are_no_keys() {
    let begin = link::encode(link::HOST_MESSAGE, &HostMessage::Run, &mut [0; FRAME_SIZE_MAXIMUM]).map(<[u8]>::to_vec);
    let said = console_after(&[&begin.expect("it fits"), b"\t\t\t"]);
    assert!(!said.contains("style: "), "{said}");
}
