use std::path::Path;

use models::{Model, ReadError, stl};

fn parse(bytes: impl AsRef<[u8]>) -> Result<Model, ReadError> {
    stl::parse(bytes.as_ref(), Path::new("m.stl"))
}

fn message(bytes: impl AsRef<[u8]>) -> String {
    parse(bytes).expect_err("the model is wrong").to_string()
}

/// A triangle's lines.
fn facet(corners: [[f32; 3]; 3]) -> String {
    let vertex = |[x, y, z]: [f32; 3]| format!("vertex {x} {y} {z}\n");
    format!("facet normal nan 0 0\n outer loop\n {}endloop\nendfacet\n", corners.map(vertex).concat())
}

/// A binary file whose header starts as a text does.
fn binary(triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
    let mut bytes = b"solid made by some program".to_vec();
    bytes.resize(80, b' ');
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        bytes.extend([0; 12]);
        triangle.as_flattened().iter().for_each(|number| bytes.extend(number.to_le_bytes()));
        bytes.extend([0xff; 2]);
    }
    bytes
}

const TWO: [[[f32; 3]; 3]; 2] =
    [[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.5, 0.0]], [[1.0, -0.0, 0.0], [0.0, 0.0, -2.0], [0.0, 1.5, 0.0]]];

#[test]
fn text_and_binary_give_the_same_model_with_shared_corners() {
    let text = format!("SOLID a b c\n{}{}endsolid a\nsolid\nendsolid\n", facet(TWO[0]), facet(TWO[1]).to_uppercase());
    let text = parse(text).expect("a good text");
    assert_eq!(text.positions, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.5, 0.0], [0.0, 0.0, -2.0]]);
    assert_eq!(text.corners, [0, 1, 2, 1, 3, 2]);
    assert_eq!(parse(binary(&TWO)).expect("a good binary file"), text);
}

#[test]
fn every_error_names_its_place_value_and_remedy() {
    let solid = |facet: &str| format!("solid x\n{facet}endsolid x\n");
    let good = facet(TWO[0]);
    let cases = [
        (
            solid(&good.replace("1.5", "1,5")),
            "m.stl:6: `1,5` is no number: write it like -1.5 or 2e-3, with a point, not a comma",
        ),
        (
            solid(&good.replace("1.5", "1e999")),
            "m.stl:6: `1e999` is no finite number: export the model again or delete the vertex",
        ),
        (solid(&good.replace("outer", "inner")), "m.stl:3: `inner` where `outer` must follow: export the model again"),
        (
            solid(&good.replace("endloop", "vertex 0 0 0\nendloop")),
            "m.stl:7: `vertex` where `endloop` must follow: export the model again",
        ),
        (solid("x"), "m.stl:2: `xendsolid` where `facet` must follow: export the model again"),
        (format!("solid\n{good}"), "m.stl:9: the file ends where `facet` must follow: copy or export it again"),
        (
            "solid\nfacet normal 0 0 1 outer loop vertex 1".into(),
            "m.stl:2: the file ends where `a number` must follow: copy or export it again",
        ),
        ("solid\nendsolid x\nfacet".into(), "m.stl:3: `facet` where `solid` must follow: export the model again"),
        ("solid x\nendsolid\n".into(), "m.stl: no face and no line among 0 vertices: export the model as polygons"),
        ("solid \0".into(), "m.stl: is not text, and its length is not that of a binary STL file: export it again"),
        ("stl".into(), "m.stl: 3 bytes are no STL file: it starts with `solid` or has 84 bytes or more"),
    ];
    for (text, expected) in cases {
        assert_eq!(message(&text), expected, "{text}");
    }
    let mut cut = binary(&TWO);
    cut[..5].copy_from_slice(b"STLB ");
    cut.truncate(183);
    assert_eq!(message(&cut), "m.stl: 183 bytes where 2 triangles want 184: copy or export the file again");
    let mut infinite = TWO;
    infinite[1][2][1] = f32::INFINITY;
    let expected = "m.stl: byte 174: `inf` is no finite number: export the model again or delete the vertex";
    assert_eq!(message(binary(&infinite)), expected);
    assert_eq!(message(binary(&[])), "m.stl: no face and no line among 0 vertices: export the model as polygons");
}
