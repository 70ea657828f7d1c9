use std::path::Path;

use models::{Model, NO_NORMAL, PLAIN, ReadError, babylon};

fn parse(text: &str) -> Result<Model, ReadError> {
    babylon::parse(text.as_bytes(), Path::new("m.babylon"))
}

fn scene(meshes: &str) -> String {
    format!("{{\"autoClear\":true,\"meshes\":[{meshes}]}}")
}

/// A triangle with its normals, and texture coordinates as `uv_count` has them.
fn triangle(uv_count: usize) -> String {
    let texture = ", 0.5, 0.25".repeat(uv_count);
    format!(
        "\"uvCount\":{uv_count},\"vertices\":[0,0,1,0,0,-2{texture}, 1,0,1,0,0,-1{texture}, 0,1,1,0,3,-4{texture}],\"indices\":[0,2,1]"
    )
}

#[test]
fn all_three_layouts_give_the_same_model() {
    for uv_count in 0..3 {
        let model = parse(&scene(&format!("{{\"name\":\"a\",{}}}", triangle(uv_count)))).expect("a good scene");
        // z is turned over, and with it the face.
        assert_eq!(model.positions, [[0.0, 0.0, -1.0], [1.0, 0.0, -1.0], [0.0, 1.0, -1.0]], "{uv_count}");
        assert_eq!(model.normals, [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 0.6, 0.8]]);
        assert_eq!((model.corners, model.corner_normals), (vec![0, 2, 1], vec![0, 2, 1]));
    }
}

#[test]
fn meshes_lie_where_their_positions_say_and_count_on() {
    let first = format!("{{\"position\":[10,20,30],{}}}", triangle(1));
    let second = "{\"position\":[1,0,0],\"positions\":[0,0,0,1,0,0,0,1,0],\"colors\":[1,0,0,1,0,1,0,1,2,0,0.5,1],\"indices\":[0,1,2]}";
    let empty = "{\"name\":\"camera target\",\"vertices\":null,\"indices\":null}";
    let model = parse(&scene(&[first.as_str(), empty, second].join(","))).expect("a good scene");
    assert_eq!(model.positions[..2], [[10.0, 20.0, -31.0], [11.0, 20.0, -31.0]]);
    assert_eq!(model.positions[3..5], [[1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]);
    assert_eq!(model.corners, [0, 2, 1, 3, 4, 5]);
    assert_eq!(model.corner_normals, [0, 2, 1, NO_NORMAL, NO_NORMAL, NO_NORMAL]);
    let coloured = vec![PLAIN, PLAIN, PLAIN, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.5]];
    assert_eq!(model.colours, Some(coloured));
}

#[test]
fn scaling_comes_before_rotation_and_rotation_before_position() {
    let quarter = std::f64::consts::FRAC_PI_2;
    let half = (0.5f64).sqrt();
    let data = "\"positions\":[1,0,0,0,1,0,0,0,1],\"normals\":[1,0,0,0,1,0,0,0,1],\"indices\":[0,1,2]";
    for rotation in [format!("\"rotation\":[0,{quarter},0]"), format!("\"rotationQuaternion\":[0,{half},0,{half}]")] {
        let mesh = format!("{{\"scaling\":[2,3,-4],{rotation},\"position\":[10,0,0],{data}}}");
        let model = parse(&scene(&mesh)).expect("a good scene");
        let rounded =
            |vectors: &[[f64; 3]]| vectors.iter().map(|v| v.map(|part| (part * 1e6).round() / 1e6)).collect::<Vec<_>>();
        // A quarter turn about y brings x to −z and z to x; then z is turned over.
        assert_eq!(rounded(&model.positions), [[10.0, 0.0, 2.0], [10.0, 3.0, 0.0], [6.0, 0.0, 0.0]], "{rotation}");
        let normals: Vec<[f64; 3]> = model.normals.iter().map(|normal| normal.map(f64::from)).collect();
        assert_eq!(rounded(&normals), [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]]);
        assert_eq!(model.corners, [0, 2, 1], "a scaling that mirrors turns faces round");
    }
}

#[test]
fn a_material_colours_its_mesh() {
    let materials = "\"materials\":[{\"id\":\"b\",\"diffuse\":[1,0.5,-1]},{\"id\":\"none\"}]";
    let meshes = ["b", "none", "c"].map(|id| format!("{{\"materialId\":\"{id}\",{}}}", triangle(0))).join(",");
    let model = parse(&format!("{{{materials},\"meshes\":[{meshes}]}}")).expect("a good scene");
    assert_eq!(model.face_colours, Some(vec![[1.0, 0.5, 0.0], PLAIN, PLAIN]));
}

#[test]
fn colours_of_one_mesh_take_no_other_meshs_material_away() {
    let materials = "\"materials\":[{\"id\":\"b\",\"diffuse\":[1,0.5,0]}]";
    let plain = format!("{{\"materialId\":\"b\",{}}}", triangle(0));
    let coloured = "{\"positions\":[0,0,0,1,0,0,0,1,0],\"colors\":[0,0,1,1,0,0,1,1,0,0,1,1],\"indices\":[0,1,2]}";
    let meshes = [plain.as_str(), coloured, &plain].join(",");
    let model = parse(&format!("{{{materials},\"meshes\":[{meshes}]}}")).expect("a good scene");
    let [orange, blue] = [[1.0, 0.5, 0.0], [0.0, 0.0, 1.0]].map(|colour| [colour; 3]);
    assert_eq!(model.colours, Some([orange, blue, orange].concat()));
}

#[test]
fn a_parent_is_noted() {
    let model = parse(&scene(&format!("{{\"parentId\":\"x\",{}}}", triangle(0)))).expect("a good scene");
    assert_eq!(model.notes, ["meshes have parents, whose place does not count: apply it before exporting"]);
}

#[test]
fn a_parent_that_is_null_is_none() {
    let model = parse(&scene(&format!("{{\"parentId\":null,{}}}", triangle(0)))).expect("a good scene");
    assert!(model.notes.is_empty());
}

#[test]
fn every_error_names_its_place_value_and_remedy() {
    let again = "export the scene as .babylon again";
    let mesh = |content: &str| scene(&format!("{{\"name\":\"b\\u001b\",{content}}}"));
    let at = "m.babylon: mesh 0 `b\\u{1b}`: ";
    let cases = [
        ("{\n\"meshes\":[\n".to_string(), format!("m.babylon:3: EOF while parsing a list (column 0): {again}")),
        ("{}".into(), format!("m.babylon:1: missing field `meshes` (column 2): {again}")),
        (
            mesh("\"indices\":[-1]"),
            format!("m.babylon:1: invalid value: integer `-1`, expected u32 (column 59): {again}"),
        ),
        (mesh("\"vertices\":[1e999]"), format!("m.babylon:1: number out of range (column 63): {again}")),
        (
            mesh("\"uvCount\":3,\"vertices\":[]"),
            format!("{at}`uvCount` is 3, layouts are known for 0, 1 and 2: export with 2 texture maps or fewer"),
        ),
        (
            mesh("\"uvCount\":1,\"vertices\":[1,2,3,4,5,6,7]"),
            format!("{at}`vertices` has 7 numbers, no multiple of 8: export the scene again"),
        ),
        (
            mesh("\"positions\":[1,2]"),
            format!("{at}`positions` has 2 numbers, no multiple of 3: export the scene again"),
        ),
        (
            mesh("\"positions\":[1,2,3],\"normals\":[1,2,3,4,5,6]"),
            format!("{at}`normals` is for 2 vertices, there are 1: export the scene again"),
        ),
        (
            mesh("\"positions\":[1,2,3],\"colors\":[1,2,3]"),
            format!("{at}`colors` has 3 numbers, no multiple of 4: export the scene again"),
        ),
        (
            mesh("\"positions\":[1,2,3],\"colors\":[1,2,3,4,5,6,7,8]"),
            format!("{at}`colors` is for 2 vertices, there are 1: export the scene again"),
        ),
        (
            mesh("\"positions\":[1,2,3],\"indices\":[0,0]"),
            format!("{at}`indices` has 2 numbers, no multiple of 3: export the scene again"),
        ),
        (
            mesh("\"positions\":[1,2,3],\"indices\":[0,0,1]"),
            format!("{at}`indices`[2] is 1, past the last of 1 vertices: export the scene again"),
        ),
        (
            mesh("\"positions\":[1e308,0,0],\"scaling\":[10,1,1]"),
            format!("{at}`inf` is no finite number: export the model again or delete the vertex"),
        ),
        (
            scene(&"{},".repeat(65_537)),
            format!("m.babylon:1: more than 65536 meshes or materials, join some (column 196639): {again}"),
        ),
        (scene(""), "m.babylon: no face and no line among 0 vertices: export the model as polygons".into()),
    ];
    for (text, expected) in cases {
        assert_eq!(parse(&text).expect_err(&text).to_string(), expected, "{text}");
    }
}
