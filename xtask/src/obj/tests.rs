use std::fmt::Write as _;
use std::io::{self, BufReader, Read};
use std::path::Path;

use super::*;
use crate::test_random::Random;

fn parse(text: impl AsRef<[u8]>) -> Result<ObjModel, ObjError> {
    parse_obj(text.as_ref(), Path::new("m.obj"))
}

fn message(text: impl AsRef<[u8]>) -> String {
    parse(text).expect_err("the model is wrong").to_string()
}

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

#[test]
fn a_triangle_is_read() {
    let model = parse(TRIANGLE).expect("a good model");
    assert_eq!(model.positions, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    assert_eq!(model.colours, None);
    assert_eq!(model.corners, [0, 1, 2]);
    assert_eq!(model.face_offsets, [0, 3]);
}

#[test]
fn all_forms_of_a_corner_mean_the_vertex() {
    for face in ["1 2 3", "1/1 2/2 3/3", "1//1 2//2 3//3", "1/1/1 2/2/2 3/3/3", "-3 -2 -1", "-3/-1/-1 2// 3/", "+1 2 3"]
    {
        let model = parse(format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nf {face} # end\n")).expect(face);
        assert_eq!(model.corners, [0, 1, 2], "{face}");
    }
}

#[test]
fn polygons_stay_whole_and_fan_out() {
    let model = parse("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 2 0\nf 1 2 3 4 5\nf 3 4 5\n").expect("a good model");
    assert_eq!(model.faces().collect::<Vec<_>>(), [&[0, 1, 2, 3, 4][..], &[2, 3, 4]]);
    assert_eq!(model.triangles().collect::<Vec<_>>(), [[0, 1, 2], [0, 2, 3], [0, 3, 4], [2, 3, 4]]);
    assert_eq!((model.face_count(), model.triangle_count()), (2, 4));
}

#[test]
fn weights_are_dropped_and_colours_kept() {
    let text = "v 1 2 3 9\nv 1 2 3 .5 .25 0\nv 1 2 3 9 1 0 0\nv 4 5 6\nf 1 2 3\n";
    let model = parse(text).expect("a good model");
    assert_eq!(model.positions[3], [4.0, 5.0, 6.0]);
    assert_eq!(model.colours, Some(vec![[1.0; 3], [0.5, 0.25, 0.0], [1.0, 0.0, 0.0], [1.0; 3]]));
}

#[test]
fn the_rest_of_the_format_is_passed_over() {
    let others = "# C:\\models\\\nmtllib a.mtl\no b\ng c d\ns off\nusemtl e\nvt 0 0\nvn 0 0 1\nvp 1\nl 1 2\np 1\n\n  \t\ncstype bezier\n";
    let latin_1 = b"# mod\xe8le\no caf\xe9\n";
    let text = [others.as_bytes(), latin_1, TRIANGLE.as_bytes()].concat();
    assert_eq!(parse(text).expect("a good model"), parse(TRIANGLE).expect("a good model"));
}

#[test]
fn line_ends_marks_and_continuations() {
    let expected = parse(TRIANGLE).expect("a good model");
    for text in [
        TRIANGLE.replace('\n', "\r\n"),
        format!("\u{feff}{TRIANGLE}"),
        TRIANGLE.trim_end().to_string(),
        TRIANGLE.replace("f 1 2", "f 1 \\\n2\\\r\n"),
        format!("{TRIANGLE}\\"),
        TRIANGLE.replace("f 1 2 3\n", "f 1 2 3\\"),
        TRIANGLE.replace("f 1", "\tf\t1"),
        TRIANGLE.replace("f ", "f\\\n"),
    ] {
        assert_eq!(parse(&text).expect(&text), expected, "{text:?}");
    }
}

#[test]
fn a_line_after_a_continuation_keeps_its_number() {
    assert!(message("v 0 0 \\\n0\nv 1 x 0\n").starts_with("m.obj:3: `x` is no number"));
    assert!(message("v 0 \\\n x 0\n").starts_with("m.obj:1: `x`"));
}

#[test]
fn a_face_may_come_before_its_vertices() {
    let model = parse("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n").expect("a good model");
    assert_eq!(model.corners, [0, 1, 2]);
}

#[test]
fn every_error_names_its_line_value_and_remedy() {
    let cases: [(&str, &str); 19] = [
        ("v\n", "m.obj:1: vertex with 0 of 3 coordinates: write `v x y z`"),
        ("\nv 1 2\n", "m.obj:2: vertex with 2 of 3 coordinates: write `v x y z`"),
        ("v 1 2 3 4 5\n", "m.obj:1: vertex with 5 numbers: write `v x y z`, "),
        ("v 1 2 3 4 5 6 7 8\n", "m.obj:1: vertex with 8 numbers"),
        ("v 1,5 2 3\n", "m.obj:1: `1,5` is no number: write it like -1.5 or 2e-3, with a point, not a comma"),
        ("v 1 nan 3\n", "m.obj:1: `nan` is no finite number: export the model again"),
        ("v 1 -inf 3\n", "m.obj:1: `-inf` is no finite number"),
        ("v 1 1e999 3\n", "m.obj:1: `1e999` is no finite number"),
        ("v 0 0 0\nf 1 0 1\n", "m.obj:2: face index 0: vertices count from 1"),
        ("v 0 0 0\n\nf 1 2 1\nf 1 1 1\n", "m.obj:3: face index 2 is past the last of 1 vertices: add the vertex"),
        (
            "v 0 0 0\nf 1 -2 1\n",
            "m.obj:2: face index -2 reaches before the first of the 1 vertices so far: use -1 to -1",
        ),
        ("v 0 0 0\nf 1 99999999999 1\n", "m.obj:2: face index 99999999999 is past the last"),
        ("v 0 0 0\nf 1 99999999999999999999 1\n", "m.obj:2: `99999999999999999999` is no face corner"),
        ("v 0 0 0\nf 1 1\n", "m.obj:2: face with 2 corners: a face needs 3 or more"),
        ("v 0 0 0\nf\n", "m.obj:2: face with 0 corners"),
        ("v 0 0 0\nf 1 1 1/2/3/4\n", "m.obj:2: `1/2/3/4` is no face corner: write v, v/t, v//n or v/t/n"),
        ("v 0 0 0\nf 1 1 1/x\n", "m.obj:2: `1/x` is no face corner"),
        ("", "m.obj: no face (`f` line) among 0 vertices: export the model as polygons"),
        ("v 0 0 0\nl 1 1\n", "m.obj: no face (`f` line) among 1 vertices"),
    ];
    for (text, expected) in cases {
        let message = message(text);
        assert!(message.starts_with(expected), "{text:?} gave {message}");
    }
}

#[test]
fn a_hostile_value_cannot_disturb_the_terminal() {
    let long = format!("v \u{1b}[2J{} 0 0\n", "9z".repeat(500));
    let message = message(long);
    assert!(!message.contains('\u{1b}') && message.len() < 200, "{message}");
}

#[test]
fn binary_files_are_named_as_such() {
    for bytes in [
        &b"v 0 0 0\n\x00\n"[..],
        b"glTF\x02\x00\x00\x00",
        b"v 0 0 \xff\n",
        b"\x89PNG\r\n\x1a\n\x00",
        b"\xff\xfev\x00 \x00",
    ] {
        let error = parse(bytes).expect_err("binary");
        assert!(matches!(error.problem, ObjProblem::Binary), "{error}");
        assert!(error.to_string().contains("is not text"), "{error}");
    }
}

#[test]
fn a_line_without_end_is_refused_early() {
    let endless = BufReader::new(io::repeat(b'v'));
    let error = parse_obj(endless, Path::new("m.obj")).expect_err("endless");
    assert!(matches!(error.problem, ObjProblem::LineTooLong), "{error}");
    let endless = BufReader::new(b"v 0".chain(io::repeat(b'\\')));
    assert!(parse_obj(endless, Path::new("m.obj")).is_err());
}

#[test]
fn too_many_vertices_are_refused() {
    let vertices = BufReader::new(Repeat { pattern: b"v 0 0 0\n", at: 0 });
    let error = parse_obj(vertices, Path::new("m.obj")).expect_err("endless");
    assert!(matches!(error.problem, ObjProblem::TooManyVertices), "{error}");
    assert_eq!(error.line, Some(VERTICES_MAX as u64 + 1));
}

#[test]
fn an_unreadable_file_is_named() {
    let error = read_obj(Path::new("no/such.obj")).expect_err("missing");
    assert!(error.to_string().starts_with("no/such.obj: cannot be read (No such file"), "{error}");
    let error = read_obj(Path::new(".")).expect_err("a folder");
    assert!(matches!(error.problem, ObjProblem::Unreadable { .. }), "{error}");
}

#[test]
fn random_bytes_never_panic() {
    let mut random = Random::new(1);
    for _ in 0..10_000 {
        let alphabet = b"vf \n\r\\/#-+.e0123456789nait\t";
        let text: Vec<u8> = (0..random.below(200))
            .map(|_| if random.below(50) == 0 { random.next() as u8 } else { alphabet[random.below(alphabet.len())] })
            .collect();
        check_outcome(parse(&text));
    }
}

#[test]
fn mutated_models_never_panic() {
    let mut good = String::from("\u{feff}# sphere\r\nmtllib s.mtl\no s\n");
    for index in 0..30 {
        let angle = f64::from(index) / 5.0;
        let _ = writeln!(good, "v {} {} {index}e-1 1 0.5 0", angle.sin(), angle.cos());
    }
    for index in 1..28 {
        let _ = writeln!(good, "f {index}//1 {}/2/3 \\\n -1 {}", index + 1, index + 2);
    }
    assert!(parse(&good).is_ok());
    let mut random = Random::new(2);
    let mut accepted = 0;
    for _ in 0..20_000 {
        let mut text = good.clone().into_bytes();
        for _ in 0..=random.below(4) {
            let at = random.below(text.len());
            match random.below(4) {
                0 => text[at] = random.next() as u8,
                1 => text.truncate(at + 1),
                2 => drop(text.drain(at..(at + random.below(8)).min(text.len()))),
                _ => text.insert(at, b"vf \n\\/#-.0e"[random.below(11)]),
            }
            if text.is_empty() {
                break;
            }
        }
        accepted += usize::from(check_outcome(parse(&text)));
    }
    assert!((1_000..19_000).contains(&accepted), "mutations test both outcomes: {accepted} accepted");
}

/// Checks what [`ObjModel`] promises, or that the error can be shown; returns whether it was a model.
fn check_outcome(outcome: Result<ObjModel, ObjError>) -> bool {
    match outcome {
        Ok(model) => {
            assert!(model.corners.iter().all(|corner| (*corner as usize) < model.positions.len()));
            assert!(model.face_count() > 0 && model.faces().all(|face| face.len() >= 3));
            assert_eq!(model.triangles().count(), model.triangle_count());
            assert!(model.positions.iter().flatten().all(|coordinate| coordinate.is_finite()));
            assert!(model.colours.is_none_or(|colours| colours.len() == model.positions.len()));
            true
        }
        Err(error) => {
            let message = error.to_string();
            assert!(message.starts_with("m.obj") && message.contains(": "), "{message}");
            false
        }
    }
}

/// A file that repeats a pattern without end.
struct Repeat {
    pattern: &'static [u8],
    at: usize,
}

impl Read for Repeat {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        for byte in &mut *buffer {
            *byte = self.pattern[self.at];
            self.at = (self.at + 1) % self.pattern.len();
        }
        Ok(buffer.len())
    }
}

/// Measure: `cargo test --release --package xtask -- --ignored --nocapture ten_million`.
#[test]
#[ignore = "a measurement"]
fn ten_million_vertices_load() {
    let text = "v 1.234567 -2.345678 3.456789\n".repeat(10_000_000) + &"f 1 2 3\n".repeat(1_000_000);
    let started = std::time::Instant::now();
    let model = parse(&text).expect("a good model");
    eprintln!("{} vertices, {} faces in {:.2?}", model.positions.len(), model.face_count(), started.elapsed());
}
