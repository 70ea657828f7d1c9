//! Of each kind a hundred thousand broken files: each is read or named, none panics, none takes more memory than
//! its length calls for. One test, so that nothing else allocates meanwhile.

use std::fmt::Write as _;
use std::path::Path;

use fastrand::Rng;
use models::compile::{Options, compile};
use models::{Model, NO_NORMAL, ReadError, babylon, gltf, mesh_file, obj, rom, stl};
use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Files of each kind.
const FILES: usize = 100_000;
/// What a reader may take whatever the file's length, and for each of its bytes.
const MEMORY_BASE: usize = 1 << 20;
const MEMORY_PER_BYTE: usize = 200;

type Parse = fn(&[u8], &Path) -> Result<Model, ReadError>;

struct Kind {
    name: &'static str,
    parse: Parse,
    good: Vec<u8>,
    /// What mutations insert, beside random bytes.
    alphabet: &'static [u8],
    /// Puts a file's own lengths and checksum right, so that what lies behind them is looked at.
    mend: fn(&mut Vec<u8>),
}

#[test]
fn broken_files_are_read_or_named_within_bounded_memory() {
    for kind in
        [obj_kind(), materials_kind(), stl_text(), stl_binary(), babylon_kind(), gltf_kind(), rom_kind(), mesh_kind()]
    {
        let Kind { name, parse, good, alphabet, mend } = &kind;
        assert!(parse(good, Path::new(name)).is_ok(), "{name}: {:?}", parse(good, Path::new(name)).err());
        let mut random = Rng::with_seed(1);
        let mut accepted = 0;
        for round in 0..FILES {
            let mut bytes = match round % 8 {
                0 => (0..random.usize(..300)).map(|_| random.u8(..)).collect(),
                1 => (0..random.usize(..300)).map(|_| alphabet[random.usize(..alphabet.len())]).collect(),
                _ => mutated(good, alphabet, &mut random),
            };
            if random.u8(..8) > 0 {
                mend(&mut bytes);
            }
            let before = MEMORY.current_usage();
            MEMORY.reset_peak_usage();
            let outcome = parse(&bytes, Path::new(name));
            let taken = MEMORY.peak_usage().saturating_sub(before);
            assert!(taken <= MEMORY_BASE + MEMORY_PER_BYTE * bytes.len(), "{name}: {taken} for {}", bytes.len());
            match outcome {
                Ok(model) => {
                    accepted += 1;
                    check(&model);
                    // Compiling is slower, and what it gets is always a model.
                    if accepted % 16 == 0 {
                        check_compiled(&model);
                    }
                }
                Err(error) => {
                    let message = error.to_string();
                    assert!(message.starts_with(name) && message.len() < 400, "{message}");
                    assert!(!message.contains(char::is_control), "{message:?}");
                }
            }
        }
        assert!((FILES / 100..FILES * 9 / 10).contains(&accepted), "{name}: both outcomes, {accepted} accepted");
    }
    for (name, parse, bytes) in many_empty_parts() {
        let before = MEMORY.current_usage();
        MEMORY.reset_peak_usage();
        let outcome = parse(&bytes, Path::new(name));
        let taken = MEMORY.peak_usage().saturating_sub(before);
        println!("{name} of {} bytes: {taken} bytes, {:?}", bytes.len(), outcome.is_ok());
        assert!(taken <= MEMORY_BASE + MEMORY_PER_BYTE * bytes.len(), "{name}: {taken} for {}", bytes.len());
    }
}

/// Files of as many parts without anything in them as there may be, and of one more.
fn many_empty_parts() -> Vec<(&'static str, Parse, Vec<u8>)> {
    let list = |count: usize| vec!["{}"; count].join(",");
    let scene = |count| format!("{{\"meshes\":[{}]}}", list(count)).into_bytes();
    let nodes = |count| {
        let mut bytes = b"glTF\x02\0\0\0\0\0\0\0\0\0\0\0JSON".to_vec();
        bytes.extend(format!("{{\"asset\":{{\"version\":\"2.0\"}},\"nodes\":[{}]}}", list(count)).bytes());
        mend_gltf(&mut bytes);
        bytes
    };
    vec![
        ("m.babylon", babylon::parse, scene(babylon::ITEMS_MAX)),
        ("m.babylon", babylon::parse, scene(babylon::ITEMS_MAX + 1)),
        ("m.glb", gltf::parse, nodes(gltf::PARTS_MAX - 2)),
        ("m.glb", gltf::parse, nodes(gltf::PARTS_MAX)),
    ]
}

fn mutated(good: &[u8], alphabet: &[u8], random: &mut Rng) -> Vec<u8> {
    let mut bytes = good.to_vec();
    for _ in 0..=random.usize(..4) {
        if bytes.is_empty() {
            break;
        }
        let at = random.usize(..bytes.len());
        match random.u8(..6) {
            0 => bytes[at] = random.u8(..),
            1 => bytes.truncate(at + 1),
            2 => drop(bytes.drain(at..(at + random.usize(..8)).min(bytes.len()))),
            3 => bytes.insert(at, alphabet[random.usize(..alphabet.len())]),
            4 => bytes[at] = alphabet[random.usize(..alphabet.len())],
            // A part of the file again, somewhere else.
            _ => {
                let from = random.usize(..bytes.len());
                let part = bytes[from..(from + random.usize(..40)).min(bytes.len())].to_vec();
                drop(bytes.splice(at..at, part));
            }
        }
    }
    bytes
}

/// What a [`Model`] promises.
fn check(model: &Model) {
    let vertices = model.positions.len();
    assert!(model.corners.iter().all(|corner| (*corner as usize) < vertices));
    assert!(model.lines.as_flattened().iter().all(|end| (*end as usize) < vertices));
    assert!(!model.corners.is_empty() || !model.lines.is_empty());
    assert!(model.faces().all(|face| face.len() >= 3));
    assert_eq!(model.faces().map(<[u32]>::len).sum::<usize>(), model.corners.len());
    assert_eq!(model.triangles().count(), model.triangle_count());
    assert!(model.positions.as_flattened().iter().all(|part| part.is_finite()));
    assert!(model.normals.as_flattened().iter().all(|part| part.is_finite()));
    let is_unit = |colours: &Vec<[f32; 3]>| colours.as_flattened().iter().all(|part| (0.0..=1.0).contains(part));
    assert!(model.colours.as_ref().is_none_or(|colours| colours.len() == vertices && is_unit(colours)));
    let faces = model.face_count();
    assert!(model.face_colours.as_ref().is_none_or(|colours| colours.len() == faces && is_unit(colours)));
    assert!([0, model.corners.len()].contains(&model.corner_normals.len()));
    let names_a_normal = |normal: &u32| *normal == NO_NORMAL || (*normal as usize) < model.normals.len();
    assert!(model.corner_normals.iter().all(names_a_normal));
}

/// Whatever was read becomes a file that can be read, or an error says why not.
fn check_compiled(model: &Model) {
    match compile(model, &Options::default()) {
        Ok(compiled) => {
            let again = mesh_file::parse(&compiled.bytes, Path::new("again")).expect("what is written is read");
            assert_eq!(again.triangle_count() + compiled.report.left_out, model.triangle_count());
        }
        Err(error) => assert!(error.to_string().contains(": "), "{error}"),
    }
}

fn obj_kind() -> Kind {
    let mut good = String::from("\u{feff}# sphere\r\nmtllib a.mtl\no s\n");
    for index in 0..20 {
        let angle = f64::from(index) / 5.0;
        let _ = writeln!(good, "v {} {} {index}e-1 1 0.5 0\nvn 0 {index} 1", angle.sin(), angle.cos());
    }
    for index in 1..18 {
        let _ = writeln!(good, "f {index}//1 {}/2/3 \\\n -1", index + 1);
    }
    good += "usemtl m\nf 1 2 3\nv 9 0 0\nv 9 1 0\nv 9 1 1\nv 9 0 1\nf -4 -3 -2 -1\nl 1 2 3\n";
    Kind {
        name: "m.obj",
        parse: |bytes, file| {
            obj::parse_obj(bytes, file, |_| Ok(Some(obj::Materials::from([("m".into(), [1.0, 0.0, 0.0])]))))
        },
        good: good.into_bytes(),
        alphabet: b"vf \n\r\\/#-+.e0123456789naitlmtu\t",
        mend: |_| {},
    }
}

fn materials_kind() -> Kind {
    let good = "# two\nnewmtl m\r\nKa 1 1 1\nKd 1 0.5 -3e-1\nillum 2\nmap_Kd a b.png\nnewmtl grey one\nKd .5\n\
                Kd spectral a.rfl\nnewmtl n\nKd 0 \\\n 1 1 # end\n";
    Kind {
        name: "a.mtl",
        parse: |bytes, file| {
            let materials = obj::parse_materials(bytes, file)?;
            let model = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\nusemtl n\nf 3 2 1\n";
            obj::parse_obj(model.as_bytes(), file, |_| Ok(Some(materials.clone())))
        },
        good: good.into(),
        alphabet: b"newmtlKd# \n\r\\0123456789.-e\t",
        mend: |_| {},
    }
}

fn stl_text() -> Kind {
    let corner = |x: u32| format!("vertex {x} 1e-3 -{x}.5\n");
    let facet = |at: u32| {
        let corners = [at, at + 1, at * 3].map(corner).concat();
        format!("facet normal 0 0 1\nouter loop\n{corners}endloop\nendfacet\n")
    };
    Kind {
        name: "m.stl",
        parse: stl::parse,
        good: format!("solid x y\n{}endsolid x\n", (0..6).map(facet).collect::<String>()).into_bytes(),
        alphabet: b"solidfacetvertexloopend \n0123456789.-e",
        mend: |_| {},
    }
}

fn stl_binary() -> Kind {
    let mut good = vec![b' '; 80];
    good.extend(6u32.to_le_bytes());
    for triangle in 0..6u16 {
        good.extend([0; 12]);
        (0..9u16).for_each(|number| good.extend(f32::from(triangle * 5 + number * number).to_le_bytes()));
        good.extend([0; 2]);
    }
    Kind {
        name: "b.stl",
        parse: stl::parse,
        good,
        alphabet: &[0, 1, 0x3f, 0x7f, 0x80, 0xff],
        mend: |bytes| {
            if let Some(triangles) = bytes.len().checked_sub(84).map(|rest| rest / 50) {
                bytes.truncate(84 + 50 * triangles);
                bytes[80..84].copy_from_slice(&(triangles as u32).to_le_bytes());
            }
        },
    }
}

fn babylon_kind() -> Kind {
    let good = r#"{"meshes":[{"name":"a","uvCount":1,"position":[1,2,3],"vertices":[0,0,1,0,0,-2,0,0,1,0,1,0,0,-1,0,1,0,1,1,0,
        3,-4,1,0],"indices":[0,2,1]},{"name":"b","scaling":[1,-2,1],"rotation":[0,0.5,1],"positions":[0,0,0,1,0,0,0,1,0,
        1,1,1],"normals":[0,0,1,0,0,1,0,0,1,0,1,0],"colors":[1,0,0,1,0,1,0,1,0,0,1,1,1,1,1,1],"indices":[0,1,2,2,1,3]}]}"#;
    Kind {
        name: "m.babylon",
        parse: babylon::parse,
        good: good.into(),
        alphabet: b"{}[],:\"0123456789-.e nul",
        mend: |_| {},
    }
}

fn gltf_kind() -> Kind {
    let json = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
        "nodes":[{"children":[1],"rotation":[0,0.6,0,0.8]},{"mesh":0,"scale":[2,3,-1]}],
        "materials":[{"pbrMetallicRoughness":{"baseColorFactor":[1,0.5,0,1]}}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1},"indices":3,"material":0},
        {"attributes":{"POSITION":0,"COLOR_0":2},"mode":5},{"attributes":{"POSITION":0},"mode":3}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,1]},
        {"bufferView":1,"componentType":5126,"count":4,"type":"VEC3"},
        {"bufferView":2,"componentType":5121,"count":4,"type":"VEC4","normalized":true},
        {"bufferView":3,"byteOffset":0,"componentType":5123,"count":6,"type":"SCALAR"}],
        "bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":48,"byteStride":12},
        {"buffer":0,"byteOffset":96,"byteLength":16},{"buffer":0,"byteOffset":112,"byteLength":12}],
        "buffers":[{"byteLength":124}]}"#;
    let mut good = b"glTF\x02\0\0\0\0\0\0\0\0\0\0\0JSON".to_vec();
    good.extend(json.bytes());
    good.resize(good.len().next_multiple_of(4), b' ');
    good.extend(124u32.to_le_bytes());
    good.extend(b"BIN\0");
    (0..24u8).for_each(|number| good.extend(f32::from(number % 5).to_le_bytes()));
    good.extend([255, 0, 0, 9, 0, 255, 0, 9, 0, 0, 255, 9, 255, 255, 255, 9]);
    [0u16, 1, 2, 0, 2, 3].iter().for_each(|index| good.extend(index.to_le_bytes()));
    mend_gltf(&mut good);
    Kind { name: "m.glb", parse: gltf::parse, good, alphabet: b"{}[],:\"0123456789-.e nul\0\xff", mend: mend_gltf }
}

/// States the file's length, and the JSON's: all up to the last `BIN`'s length.
fn mend_gltf(bytes: &mut Vec<u8>) {
    if bytes.len() < 20 {
        return;
    }
    let binary = bytes.windows(4).rposition(|name| name == b"BIN\0").filter(|at| *at >= 24);
    let end = binary.map_or(bytes.len(), |at| at - 4);
    // Chunks are multiples of four bytes.
    let padding = (4 - end % 4) % 4;
    drop(bytes.splice(end..end, std::iter::repeat_n(b' ', padding)));
    let end = end + padding;
    let put = |bytes: &mut Vec<u8>, at: usize, number: usize| {
        bytes[at..at + 4].copy_from_slice(&(number as u32).to_le_bytes());
    };
    put(bytes, 12, end - 20);
    if binary.is_some() {
        let rest = bytes.len() - end - 8;
        put(bytes, end, rest);
    }
    let length = bytes.len();
    put(bytes, 8, length);
}

fn rom_kind() -> Kind {
    let line = |opcode: u128, arguments: [i16; 6]| {
        arguments.iter().fold(opcode, |bits, argument| bits << 16 | u128::from(*argument as u16))
    };
    let lines = [
        line(0, [0, 0, 4096, 0, 0, 0]),
        line(1, [0; 6]),
        line(2, [-2048, -2048, 2048, 2048, 0, 0]),
        line(4, [0, 1, 2, 3, 4, 5]),
        line(4, [3, 4, 5, -6, -7, -8]),
        line(4, [300, 400, 500, -6, -7, -8]),
        line(7, [0; 6]),
    ];
    let text: String = lines.iter().map(|bits| format!("{bits:025x} // a line\n")).collect();
    Kind {
        name: "m.rom",
        parse: rom::parse,
        good: text.into_bytes(),
        alphabet: b"0123456789abcdef_ \n,;/=x",
        mend: |_| {},
    }
}

fn mesh_kind() -> Kind {
    let mut text = String::new();
    for index in 0..12 {
        let _ = writeln!(text, "v {} {} {} 1 0.{index} 0", index % 3, index / 3, index % 3);
    }
    text += "f 1 2 5 4\nf 2 3 6 5\nf 4 5 8 7\nf 5 6 9 8\nf 7 8 11\nf 8 9 12\n";
    let model = obj::parse_obj(text.as_bytes(), Path::new("m.obj"), |_| Ok(None)).expect("a good model");
    Kind {
        name: "m.mesh",
        parse: mesh_file::parse,
        good: compile(&model, &Options::default()).expect("it compiles").bytes,
        alphabet: &[0, 1, 2, 3, 0x7f, 0x80, 0xff],
        mend: |bytes| {
            if bytes.len() >= 64 {
                let length = bytes.len() as u32;
                bytes[8..12].copy_from_slice(&length.to_le_bytes());
                // CRC-32, bit by bit.
                let crc = !bytes[8..].iter().fold(u32::MAX, |crc, byte| {
                    (0..8).fold(crc ^ u32::from(*byte), |crc, _| crc >> 1 ^ if crc & 1 == 1 { 0xedb8_8320 } else { 0 })
                });
                bytes[4..8].copy_from_slice(&crc.to_le_bytes());
            }
        },
    }
}
