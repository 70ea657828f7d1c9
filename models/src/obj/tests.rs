use std::io::{self, BufReader, Read};
use std::path::Path;

use super::*;
use crate::{NO_NORMAL, PLAIN, Place, VERTICES_MAX};

fn parse(text: impl AsRef<[u8]>) -> Result<Model, ReadError> {
    from(text.as_ref())
}

/// Reads a model beside which there is one file of materials, `a.mtl`.
fn from(source: impl io::BufRead) -> Result<Model, ReadError> {
    const MATERIALS: &str =
        "# two\nnewmtl red one\nKa 1 1 1\nKd 1 0.25 0\nKd spectral x\nnewmtl plain\nnewmtl grey\nKd .5\n";
    parse_obj(source, Path::new("m.obj"), |name| match name {
        "a.mtl" => material::parse(MATERIALS.as_bytes(), Path::new(name)).map(Some),
        "bad.mtl" => material::parse("newmtl a\nKd 1 2\n".as_bytes(), Path::new(name)).map(Some),
        _ => Ok(None),
    })
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
        let model =
            parse(format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 0 1 0\nvn 1 0 0\nf {face} # end\n")).expect(face);
        assert_eq!(model.corners, [0, 1, 2], "{face}");
    }
}

#[test]
fn polygons_stay_whole_and_fan_out() {
    let model = parse("v 0 0 0\nv 2 0 0\nv 3 1 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 4 5\nf 3 4 5\n").expect("a good model");
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
    let others =
        "# C:\\models\\\nmtllib b.mtl\no b\ng c d\ns off\nusemtl e\nvt 0 0\nvp 1\np 1\n\n  \t\ncstype bezier\n";
    let latin_1 = b"# mod\xe8le\no caf\xe9\n";
    let text = [others.as_bytes(), latin_1, TRIANGLE.as_bytes()].concat();
    let expected = Model {
        notes: vec!["no file of materials `b.mtl` beside the model: faces are grey".into()],
        ..parse(TRIANGLE).expect("a good model")
    };
    assert_eq!(parse(text).expect("a good model"), expected);
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
    let cases: [(&str, &str); 27] = [
        ("v\n", "m.obj:1: vertex with 0 of 3 coordinates: write `v x y z`"),
        ("\nv 1 2\n", "m.obj:2: vertex with 2 of 3 coordinates: write `v x y z`"),
        ("v 1 2 3 4 5\n", "m.obj:1: vertex with 5 numbers: write `v x y z`, "),
        ("v 1 2 3 4 5 6 7 8\n", "m.obj:1: vertex with 8 numbers"),
        ("v 1,5 2 3\n", "m.obj:1: `1,5` is no number: write it like -1.5 or 2e-3, with a point, not a comma"),
        ("v 1 nan 3\n", "m.obj:1: `nan` is no finite number: export the model again"),
        ("v 1 -inf 3\n", "m.obj:1: `-inf` is no finite number"),
        ("v 1 1e999 3\n", "m.obj:1: `1e999` is no finite number"),
        ("v 0 0 0\nf 1 0 1\n", "m.obj:2: face index 0: vertices count from 1"),
        ("v 0 0 0\n\nf 1 2 1\nf 1 1 1\n", "m.obj:3: face index 2 is past the last of 1 vertices: add what is missing"),
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
        ("", "m.obj: no face and no line among 0 vertices: export the model as polygons"),
        ("v 0 0 0\nvn 1 2 3\n", "m.obj: no face and no line among 1 vertices"),
        ("v 0 0 0\nl 1\n", "m.obj:2: line with 1 ends: a line needs 2 or more; delete it"),
        ("v 0 0 0\nl 1 2\n", "m.obj:2: face index 2 is past the last of 1 vertices"),
        ("vn 1 2\n", "m.obj:1: normal with 2 of 3 parts: write `vn x y z`"),
        ("v 0 0 0\nf 1//1 1//1 1//2\nvn 1 1 1\n", "m.obj:2: face index 2 is past the last of 1 normals: add what"),
        ("v 0 0 0\nf 1//-1 1 1\n", "m.obj:2: face index -1 reaches before the first of the 0 normals so far"),
        (
            "v 0 0 0\nv 4 0 0\nv 1 1 0\nv 0 4 0\n\nf 1 2 3 4\n",
            "m.obj:6: face of 4 corners turns back at corner 3 and is not convex: export the model as triangles",
        ),
        (
            "v 0 0 0\nv 1 0 3\nv 1 1 0\nv 0 1 3\nf 1 2 3\nf 4 1 2 3\n",
            "m.obj:6: face of 4 corners is folded, corner 3 is far off its plane: export the model as triangles",
        ),
        ("mtllib bad.mtl\n", "bad.mtl:2: `Kd` with 2 of 3 numbers: write `Kd r g b`"),
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
        assert!(matches!(error.problem, Problem::Obj(ObjProblem::Binary)), "{error}");
        assert!(error.to_string().contains("is not text"), "{error}");
    }
}

#[test]
fn a_line_without_end_is_refused_early() {
    let endless = BufReader::new(io::repeat(b'v'));
    let error = from(endless).expect_err("endless");
    assert!(matches!(error.problem, Problem::Obj(ObjProblem::LineTooLong)), "{error}");
    let endless = BufReader::new(b"v 0".chain(io::repeat(b'\\')));
    assert!(from(endless).is_err());
}

#[test]
fn too_many_vertices_are_refused() {
    let vertices = BufReader::new(Repeat { pattern: b"v 0 0 0\n", at: 0 });
    let error = from(vertices).expect_err("endless");
    assert!(matches!(error.problem, Problem::TooManyVertices), "{error}");
    assert_eq!(error.place, Place::Line(VERTICES_MAX as u64 + 1));
}

#[test]
fn an_unreadable_file_is_named() {
    let error = read_obj(Path::new("no/such.obj")).expect_err("missing");
    assert!(error.to_string().starts_with("no/such.obj: cannot be read (No such file"), "{error}");
    let error = read_obj(Path::new(".")).expect_err("a folder");
    assert!(matches!(error.problem, Problem::Unreadable { .. }), "{error}");
}

#[test]
fn normals_belong_to_corners() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 5\nvn 0 3e200 4e200\nf 1 2 3\nf 1//2 2 3//1\nf 3 2 1\n";
    let model = parse(text).expect("a good model");
    assert_eq!(model.normals, [[0.0, 0.0, 1.0], [0.0, 0.6, 0.8]]);
    let none = NO_NORMAL;
    assert_eq!(model.corner_normals, [none, none, none, 1, none, 0, none, none, none]);
}

#[test]
fn lines_are_kept_and_faces_beside_them_show_their_outlines() {
    let model = parse("v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2 3\nl 3/1 1/2\n").expect("lines alone");
    assert_eq!((model.lines.as_slice(), model.face_count()), (&[[0, 1], [1, 2], [2, 0]][..], 0));
    let model = parse(format!("{TRIANGLE}v 5 5 5\nl 1 4\n")).expect("a face and a line");
    assert_eq!(model.lines, [[0, 3], [0, 1], [1, 2], [2, 0]]);
}

#[test]
fn materials_colour_the_faces_after_them() {
    let faces = "f 1 2 3\nusemtl red one\nf 1 2 3\nusemtl plain\nf 1 2 3\nusemtl grey\nf 1 2 3\nusemtl none\nf 1 2 3\n";
    let model = parse(format!("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n{faces}")).expect("a good model");
    assert_eq!(model.face_colours, Some(vec![PLAIN, [1.0, 0.25, 0.0], [0.8; 3], [0.5; 3], PLAIN]));
    assert_eq!(model.notes, ["material `none` is in no file of materials: its faces are grey"]);
    assert_eq!(model.face_colour(1, &[0, 1, 2]), [1.0, 0.25, 0.0]);
}

#[test]
fn one_statement_may_name_several_files_of_materials() {
    for (names, notes) in [
        ("a.mtl b.mtl", vec!["no file of materials `b.mtl` beside the model: faces are grey"]),
        ("b.mtl  a.mtl", vec!["no file of materials `b.mtl` beside the model: faces are grey"]),
        ("a.mtl", vec![]),
    ] {
        let text = format!("mtllib {names}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl grey\nf 1 2 3\n");
        let model = parse(text).expect("a good model");
        assert_eq!(
            (model.face_colours, model.notes),
            (Some(vec![[0.5; 3]]), notes.iter().map(|n| n.to_string()).collect())
        );
    }
    let model = parse(format!("mtllib my model.mtl\n{TRIANGLE}")).expect("a good model");
    assert_eq!(model.notes, ["no file of materials `my model.mtl` beside the model: faces are grey"]);
}

#[test]
fn a_file_of_materials_elsewhere_is_not_read() {
    for name in ["/dev/zero", "../a.mtl", "b/../../a.mtl", "..\\a.mtl", "C:\\a.mtl", "\\\\host\\a.mtl"] {
        let text = format!("mtllib {name}\n{TRIANGLE}");
        let model = parse_obj(text.as_bytes(), Path::new("m.obj"), |name| panic!("{name} is read"));
        let note = format!(
            "file of materials `{}` is not looked for, its name leads elsewhere: put it beside the model",
            crate::error::quoted(name)
        );
        assert_eq!(model.expect("a good model").notes, [note]);
    }
}

#[test]
fn a_vertex_without_a_colour_among_those_with_one_has_its_faces_materials() {
    let vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1 0 0 1\nv 9 9 9\n";
    let text = format!("mtllib a.mtl\n{vertices}usemtl red one\nf 1 2 3\nf 2 3 4\n");
    let red = [1.0, 0.25, 0.0];
    assert_eq!(parse(text).expect("a good model").colours, Some(vec![red, red, red, [0.0, 0.0, 1.0], [1.0; 3]]));
}

#[test]
fn a_colour_beyond_the_range_is_as_bright_as_can_be() {
    let model = parse("v 0 0 0 1e300 -4 0.5\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("a good model");
    assert_eq!(model.colours.map(|colours| colours[0]), Some([1.0, 0.0, 0.5]));
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
