use std::path::Path;

use models::{Model, NO_NORMAL, ReadError, gltf};

fn parse(bytes: &[u8]) -> Result<Model, ReadError> {
    gltf::parse(bytes, Path::new("m.glb"))
}

/// A binary file of JSON and bytes.
fn glb(json: &str, binary: &[u8]) -> Vec<u8> {
    let padded = |bytes: &[u8], with: u8| {
        let mut bytes = bytes.to_vec();
        bytes.resize(bytes.len().next_multiple_of(4), with);
        bytes
    };
    let (json, binary) = (padded(json.as_bytes(), b' '), padded(binary, 0));
    let mut bytes = b"glTF".to_vec();
    bytes.extend(2u32.to_le_bytes());
    bytes.extend((12 + 8 + json.len() as u32 + 8 + binary.len() as u32).to_le_bytes());
    for (chunk, name) in [(&json, b"JSON"), (&binary, b"BIN\0")] {
        bytes.extend((chunk.len() as u32).to_le_bytes());
        bytes.extend(name);
        bytes.extend(chunk);
    }
    bytes
}

/// Four corners, as many normals, as many colours of four bytes, six indices of 16 bits: 124 bytes.
fn buffer() -> Vec<u8> {
    let positions: [f32; 12] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0];
    let normals: [f32; 12] = [0.0, 0.0, 2.0, 0.0, 0.0, 1.0, 0.0, 3.0, 4.0, 0.0, 0.0, 1.0];
    let mut bytes: Vec<u8> = positions.iter().chain(&normals).flat_map(|number| number.to_le_bytes()).collect();
    bytes.extend([255, 0, 0, 9, 0, 255, 0, 9, 0, 0, 255, 9, 255, 255, 255, 9]);
    bytes.extend([0u16, 1, 2, 0, 2, 3].iter().flat_map(|index| index.to_le_bytes()));
    bytes
}

/// The JSON of a scene with `nodes`, of which node 0 is the root, and one mesh with `primitive`.
fn json(nodes: &str, primitive: &str) -> String {
    let accessor = |view: usize, kind: usize, count: usize, of: &str, more: &str| {
        format!("{{\"bufferView\":{view},\"componentType\":{kind},\"count\":{count},\"type\":\"{of}\"{more}}}")
    };
    let bounds = ",\"min\":[0,0,0],\"max\":[1,1,0]";
    let accessors = [
        accessor(0, 5126, 4, "VEC3", bounds),
        accessor(1, 5126, 4, "VEC3", ""),
        accessor(2, 5121, 4, "VEC4", ",\"normalized\":true"),
        accessor(3, 5123, 6, "SCALAR", ""),
    ]
    .join(",");
    let view = |from: usize, length: usize| format!("{{\"buffer\":0,\"byteOffset\":{from},\"byteLength\":{length}}}");
    let views = [view(0, 48), view(48, 48), view(96, 16), view(112, 12)].join(",");
    format!(
        "{{\"asset\":{{\"version\":\"2.0\"}},\"scene\":0,\"scenes\":[{{\"nodes\":[0]}}],\"nodes\":[{nodes}],\
         \"materials\":[{{\"pbrMetallicRoughness\":{{\"baseColorFactor\":[1,0.5,0,1]}}}}],\
         \"meshes\":[{{\"name\":\"q\",\"primitives\":[{primitive}]}}],\"accessors\":[{accessors}],\
         \"bufferViews\":[{views}],\"buffers\":[{{\"byteLength\":124}}]}}"
    )
}

const NODE: &str = "{\"mesh\":0}";
const QUAD: &str = "{\"attributes\":{\"POSITION\":0,\"NORMAL\":1},\"indices\":3,\"material\":0}";

fn model(nodes: &str, primitive: &str) -> Model {
    parse(&glb(&json(nodes, primitive), &buffer())).expect("a good file")
}

#[test]
fn positions_normals_indices_and_base_colour_are_read() {
    let model = model(NODE, QUAD);
    assert_eq!(model.positions, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]);
    assert_eq!(model.normals[2], [0.0, 0.6, 0.8]);
    assert_eq!((model.corners, model.corner_normals), (vec![0, 1, 2, 0, 2, 3], vec![0, 1, 2, 0, 2, 3]));
    // Half of the light is 188 of 255 in sRGB.
    let colour = model.face_colours.expect("colours")[1].map(|part| (part * 255.0).round());
    assert_eq!((colour, model.colours), ([255.0, 188.0, 0.0], None));
}

#[test]
fn colours_are_multiplied_by_the_material_and_go_with_vertices() {
    let coloured = "{\"attributes\":{\"POSITION\":0,\"COLOR_0\":2},\"indices\":3,\"material\":0}";
    let found = model(NODE, &format!("{QUAD},{coloured}"));
    let bytes: Vec<[f32; 3]> =
        found.colours.expect("colours").iter().map(|colour| colour.map(|part| (part * 255.0).round())).collect();
    assert_eq!(bytes[0], [255.0, 188.0, 0.0], "the first primitive's vertices have their faces' colour");
    assert_eq!(bytes[4..], [[255.0, 0.0, 0.0], [0.0, 188.0, 0.0], [0.0; 3], [255.0, 188.0, 0.0]]);
    assert_eq!(found.corner_normals[6..], [NO_NORMAL; 6]);
    assert_eq!(found.corners[6..], [4, 5, 6, 4, 6, 7]);
}

#[test]
fn nodes_move_turn_and_scale_what_hangs_on_them() {
    let half = 0.5f64.sqrt();
    // The child is scaled, its parent turned a quarter about z, and then moved.
    let nodes = format!(
        "{{\"children\":[1],\"translation\":[10,0,0],\"rotation\":[0,0,{half},{half}]}},{{\"mesh\":0,\"scale\":[2,3,-1]}}"
    );
    let found = model(&nodes, QUAD);
    let rounded: Vec<[f64; 3]> =
        found.positions.iter().map(|position| position.map(|part| (part * 1e5).round() / 1e5)).collect();
    assert_eq!(rounded, [[10.0, 0.0, 0.0], [10.0, 2.0, 0.0], [7.0, 2.0, 0.0], [7.0, 0.0, 0.0]]);
    assert_eq!(found.corners, [0, 2, 1, 0, 3, 2], "a mirrored face goes the other way round");
    let normal = found.normals[2].map(|part| (part * 1e4).round() / 1e4);
    // (0, 0.6, 0.8) over the scale is (0, 0.2, −0.8), of length 0.8246; then turned.
    assert_eq!(normal, [-0.2425, 0.0, -0.9701]);
    let matrix = "{\"mesh\":0,\"matrix\":[0,2,0,0, -3,0,0,0, 0,0,-1,0, 10,0,0,1]}";
    let by_matrix = model(matrix, QUAD);
    assert_eq!((by_matrix.positions, by_matrix.corners), (rounded, found.corners));
}

#[test]
fn strips_fans_and_lines_are_taken_apart() {
    let of_mode = |mode: u32| model(NODE, &format!("{{\"attributes\":{{\"POSITION\":0}},\"mode\":{mode}}}"));
    assert_eq!(of_mode(5).corners, [0, 1, 2, 2, 1, 3]);
    assert_eq!(of_mode(6).corners, [0, 1, 2, 0, 2, 3]);
    assert_eq!(of_mode(1).lines, [[0, 1], [2, 3]]);
    assert_eq!(of_mode(2).lines, [[0, 1], [1, 2], [2, 3], [3, 0]]);
    assert_eq!(of_mode(3).lines, [[0, 1], [1, 2], [2, 3]]);
    let points = model(NODE, &format!("{QUAD},{{\"attributes\":{{\"POSITION\":0}},\"mode\":0}}"));
    assert_eq!((points.positions.len(), points.notes), (4, vec!["points are left out".to_string()]));
}

#[test]
fn nodes_hang_as_deep_as_any_scene_s_and_no_deeper() {
    let chain = |length: usize| {
        let inner = (1..length).map(|child| format!("{{\"children\":[{child}]}}")).collect::<Vec<_>>();
        glb(&json(&format!("{},{NODE}", inner.join(",")), QUAD), &buffer())
    };
    assert_eq!(parse(&chain(256)).expect("deep").corners.len(), 6);
    let error = parse(&chain(257)).expect_err("too deep").to_string();
    assert_eq!(error, "m.glb: node 256 ``: nodes hang more than 256 deep: export the scene again");
}

#[test]
fn more_parts_than_any_scene_has_are_named() {
    let nodes = vec!["{}"; gltf::PARTS_MAX].join(",");
    let file = glb(&format!("{{\"asset\":{{\"version\":\"2.0\"}},\"nodes\":[{nodes}]}}"), &[]);
    let expected = "m.glb: 1048578 nodes, meshes and other parts, at most 1048576 are read: join some";
    assert_eq!(parse(&file).expect_err("too many").to_string(), expected);
}

#[test]
fn every_error_names_its_place_value_and_remedy() {
    let good = json(NODE, QUAD);
    let at = "m.glb: mesh 0 `q`, primitive 0: ";
    let changed = |from: &str, to: &str| {
        assert!(good.contains(from), "{from}");
        glb(&good.replacen(from, to, 1), &buffer())
    };
    let file = glb(&good, &buffer());
    let mut version = file.clone();
    version[4] = 3;
    let mut chunk = file.clone();
    chunk[16] = b'X';
    let mut long = file.clone();
    long[12] = 0xff;
    let cases: [(Vec<u8>, String); 19] = [
        (file[..9].to_vec(), "m.glb: 9 bytes, fewer than the header's 12: copy or export the file again".into()),
        (
            long,
            format!(
                "m.glb: the part at byte 12 states {} bytes, {} are left: copy or export the file again",
                u32::from_le_bytes([0xff, file[13], file[14], file[15]]),
                file.len() - 20
            ),
        ),
        (
            changed("\"POSITION\":0", "\"POSITION\":4"),
            "m.glb: meshes[0].primitives[0].attributes: Index out of bounds: export the scene as .glb again".into(),
        ),
        (good.clone().into_bytes(), "m.glb: is not binary glTF: export the scene as one .glb file".into()),
        (version, "m.glb: binary glTF of version 3, 2 is read: copy or export the file again".into()),
        (
            file[..15].to_vec(),
            format!("m.glb: 15 bytes of {} that the header states: copy or export the file again", file.len()),
        ),
        (chunk, "m.glb: no JSON behind the header: copy or export the file again".into()),
        (glb("{", &[]), "m.glb: EOF while parsing an object at line 1 column 4: export the scene as .glb again".into()),
        (
            changed("\"mesh\":0", "\"mesh\":7"),
            "m.glb: nodes[0].mesh: Index out of bounds: export the scene as .glb again".into(),
        ),
        (
            changed("\"byteLength\":124", "\"byteLength\":124,\"uri\":\"x.bin\""),
            format!("{at}buffer 0 lies in another file: export the scene as one .glb file"),
        ),
        (
            changed("\"count\":4", "\"count\":5"),
            format!("{at}accessor 0 reads up to byte 60 of 48: copy or export the file again"),
        ),
        (
            changed("\"byteOffset\":112", "\"byteOffset\":116"),
            format!("{at}accessor 3 reads up to byte 128 of 124: copy or export the file again"),
        ),
        (
            changed("\"count\":4,\"type\":\"VEC3\"}", "\"count\":3,\"type\":\"VEC3\"}"),
            format!("{at}NORMAL for 3 vertices, there are 4 positions: export the scene again"),
        ),
        (
            changed("5126,\"count\":4,\"type\":\"VEC3\"}", "5123,\"count\":4,\"type\":\"VEC3\"}"),
            format!("{at}accessor 1 is not three 32-bit floats: export the scene as .glb again"),
        ),
        (
            changed("5123,\"count\":6,\"type\":\"SCALAR\"", "5126,\"count\":3,\"type\":\"SCALAR\""),
            format!("{at}accessor 3 is not whole numbers without sign: export the scene as .glb again"),
        ),
        (
            changed(
                "\"count\":6,\"type\":\"SCALAR\"",
                "\"count\":6,\"type\":\"SCALAR\",\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":3,\"componentType\":5123},\"values\":{\"bufferView\":3}}",
            ),
            format!("{at}accessor 3 is sparse, which is not read: export without sparse accessors"),
        ),
        (
            changed("\"nodes\":[{\"mesh\":0}]", "\"nodes\":[{\"mesh\":0,\"children\":[0]}]"),
            "m.glb: node 0 ``: hangs on two nodes or in a circle: export the scene again".into(),
        ),
        (
            changed("\"nodes\":[0]", "\"nodes\":[]"),
            "m.glb: no face and no line among 0 vertices: export the model as polygons".into(),
        ),
        (
            glb(&good, &{
                let mut bytes = buffer();
                bytes[120] = 4;
                bytes
            }),
            format!("{at}index 4 is 4, past the last of 4 vertices: export the scene again"),
        ),
    ];
    for (bytes, expected) in cases {
        assert_eq!(parse(&bytes).expect_err(&expected).to_string(), expected);
    }
}
