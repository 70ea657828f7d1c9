use std::path::Path;

use models::{Model, ReadError, View, rom};

fn parse(text: &str) -> Result<Model, ReadError> {
    rom::parse(text.as_bytes(), Path::new("m.rom"))
}

/// A line of the ROM: opcode and arguments, in units of 2⁻¹¹.
fn line(opcode: u128, arguments: [i16; 6]) -> u128 {
    arguments.iter().fold(opcode, |bits, argument| bits << 16 | u128::from(*argument as u16))
}

fn hexadecimal(bits: u128) -> String {
    format!("{bits:025x}")
}

const ONE: i16 = 1 << 11;

/// Eye, plane, window, two lines with a common end, and the end.
fn example() -> [u128; 6] {
    [
        line(0b000, [0, ONE, 3 * ONE, 9, 9, 9]),
        line(0b001, [-ONE, 9, 9, 9, 9, 9]),
        line(0b010, [-ONE, -ONE / 2, ONE, ONE / 2, 9, 9]),
        line(0b100, [0, ONE, -ONE, 1, -1, i16::MIN]),
        line(0b100, [1, -1, i16::MIN, 0, 0, 0]),
        line(0b111, [0; 6]),
    ]
}

#[test]
fn lines_in_every_writing_give_the_same_model() {
    let expected = Model {
        positions: vec![[0.0, 1.0, -1.0], [1.0 / 2048.0, -1.0 / 2048.0, -16.0], [0.0; 3]],
        lines: vec![[0, 1], [1, 2]],
        face_offsets: vec![0],
        view: Some(View { eye: [0.0, 1.0, 3.0], plane: -1.0, window: [[-1.0, -0.5], [1.0, 0.5]] }),
        ..Model::default()
    };
    let hex = example().map(hexadecimal);
    let binary = example().map(|bits| {
        let digits = format!("{bits:099b}");
        format!("{}_{}", &digits[..3], &digits[3..])
    });
    for text in [
        hex.join("\n"),
        hex.join("\r\n") + "\nanything after the end\n",
        format!("// a house\n\n{}  // end", hex.join(" // comment\n")),
        hex.join("\n").to_uppercase(),
        binary.join("\n"),
        format!("memory_initialization_radix=16;\nmemory_initialization_vector=\n{};\n", hex.join(",\n")),
        format!("memory_initialization_radix=2;\nmemory_initialization_vector={};", binary.join(", ")),
        format!("MEMORY_INITIALIZATION_RADIX = 2; memory_initialization_vector={};", binary.join(", ")),
        hex.join(" // the radix is 16: memory_initialization_radix\n"),
    ] {
        assert_eq!(parse(&text).expect(&text), expected, "{text}");
    }
    // The seed's own example of a point: (0, 1, −1).
    assert!(hex[3].starts_with("4000008"), "{}", hex[3]);
    assert_eq!(&hex[3][1..13], "00000800f800");
}

#[test]
fn every_error_names_its_line_value_and_remedy() {
    let with = |index: usize, bits: u128| {
        let mut lines = example();
        lines[index] = bits;
        lines.map(hexadecimal).join("\n")
    };
    let without = |index: usize| with(index, line(0b100, [0; 6]));
    let [first, ..] = example().map(hexadecimal);
    let cases = [
        (with(2, line(0b011, [0; 6])), "m.rom:3: opcode 011 means nothing: use 000, 001, 010, 100 or 111".to_string()),
        (
            format!("\n{first}0"),
            format!("m.rom:2: `{first}0` of 26 digits is no line: write 99 binary or 25 hexadecimal digits"),
        ),
        (
            format!("\n{}", &first[1..]),
            format!("m.rom:2: `{}` of 24 digits is no line: write 99 binary or 25 hexadecimal digits", &first[1..]),
        ),
        (
            first.replacen('0', "8", 1),
            format!("m.rom:1: `8{}` of 25 digits is no line: write 99 binary or 25 hexadecimal digits", &first[1..]),
        ),
        (
            first.replacen('0', "x", 1),
            format!("m.rom:1: `x{}` of 25 digits is no line: write 99 binary or 25 hexadecimal digits", &first[1..]),
        ),
        (first.clone(), "m.rom: no end: write a last line with opcode 111".into()),
        (without(0), "m.rom: no eye (opcode 000): write a line that gives it, before the end".into()),
        (without(1), "m.rom: no viewing plane (opcode 001): write a line that gives it, before the end".into()),
        (without(2), "m.rom: no window (opcode 010): write a line that gives it, before the end".into()),
        (
            with(0, line(0, [0, 0, -ONE / 2, 0, 0, 0])),
            "m.rom: the eye's z -0.5 is not above the viewing plane's -1 and at least 0: move the eye or the plane"
                .into(),
        ),
        (
            with(1, line(1, [3 * ONE, 0, 0, 0, 0, 0])),
            "m.rom: the eye's z 3 is not above the viewing plane's 3 and at least 0: move the eye or the plane".into(),
        ),
        (
            with(2, line(2, [0, ONE, 0, 2 * ONE, 0, 0])),
            "m.rom: the window from (0, 1) to (0, 2) has no area: give the lowest first".into(),
        ),
        (
            [0, 1, 2, 5].map(|index| hexadecimal(example()[index])).join("\n"),
            "m.rom: no face and no line among 0 vertices: export the model as polygons".into(),
        ),
        ("\0".into(), "m.rom: is not text: write each line as 99 binary or 25 hexadecimal digits".into()),
    ];
    for (text, expected) in cases {
        assert_eq!(parse(&text).expect_err(&text).to_string(), expected);
    }
}
