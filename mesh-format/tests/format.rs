//! Files are read as they were written, and anything else is named.

use mesh_format::{Block, BlockData, Count, Flags, FormatError, HEADER_BYTES, Header, MeshFile, write};

/// A checksum bit by bit, as ISO-HDLC has it: not the crate that the reader uses.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| crc >> 1 ^ if crc & 1 == 1 { 0xedb8_8320 } else { 0 })
    })
}

/// Two triangles in two blocks, with all parts.
fn example() -> (Header, Vec<BlockData>) {
    let first = BlockData {
        positions: vec![[0, 1, 2], [65_535, 4, 5], [6, 7, 65_280]],
        normals: vec![[127, 0, 0], [0, -127, 0], [-128, 5, 6]],
        colours: vec![[1, 2, 3], [4, 5, 6], [255, 0, 128]],
        corners: vec![[0, 1, 2]],
        face_normals: vec![[0, 0, 127]],
        face_colours: vec![[10, 20, 30]],
        edges: vec![[0, 1], [1, 2]],
    };
    let second = BlockData {
        positions: vec![[9, 9, 9], [8, 8, 8]],
        normals: vec![[1, 1, 1], [2, 2, 2]],
        colours: vec![[7, 7, 7], [6, 6, 6]],
        edges: vec![[1, 0]],
        ..BlockData::default()
    };
    let header = Header {
        flags: Flags::KNOWN,
        offset: [-(1 << 28), 0, 1 << 27],
        step: [8193, 1, 0],
        scale_log2: -3,
        colour: [200, 100, 50],
        ..Header::default()
    };
    (header, vec![first, second])
}

fn good() -> Vec<u8> {
    let (header, blocks) = example();
    write(&header, &blocks).expect("a good file")
}

/// `bytes` with its checksum put right, so that what lies behind it is looked at.
fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
    if bytes.len() >= 8 {
        let checksum = crc32(&bytes[8..]);
        bytes[4..8].copy_from_slice(&checksum.to_le_bytes());
    }
    bytes
}

fn changed(at: usize, to: &[u8]) -> Vec<u8> {
    let mut bytes = good();
    bytes[at..at + to.len()].copy_from_slice(to);
    sealed(bytes)
}

#[test]
fn a_file_is_read_as_it_was_written() {
    let (expected, blocks) = example();
    let bytes = good();
    let file = MeshFile::read(&bytes).expect("a good file");
    let totals = Header { vertices: 5, faces: 1, edges: 3, blocks: 2, ..expected };
    assert_eq!(*file.header(), totals);
    assert_eq!(file.blocks().count(), 2);
    for (block, data) in file.blocks().zip(&blocks) {
        let signed = |part: &[[u8; 3]]| part.iter().map(|part| part.map(|part| part as i8)).collect::<Vec<_>>();
        let found = BlockData {
            positions: block.positions.iter().copied().map(Block::position).collect(),
            normals: signed(block.normals),
            colours: block.colours.to_vec(),
            corners: block.corners.to_vec(),
            face_normals: signed(block.face_normals),
            face_colours: block.face_colours.to_vec(),
            edges: block.edges.to_vec(),
        };
        assert_eq!(found, *data);
    }
}

#[test]
fn every_byte_is_where_the_page_says() {
    let bytes = good();
    let word = |at: usize| u32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]);
    assert_eq!(bytes[..4], [0x89, b'H', b'S', b'M']);
    assert_eq!((word(4), word(8)), (crc32(&bytes[8..]), bytes.len() as u32));
    assert_eq!(bytes[12..16], [1, 0, 0x1f, 0]);
    assert_eq!([16, 20, 24, 28].map(word), [5, 1, 3, 2]);
    assert_eq!([32, 36, 40].map(|at| word(at) as i32), [-(1 << 28), 0, 1 << 27]);
    assert_eq!([44, 48, 52].map(word), [8193, 1, 0]);
    assert_eq!(bytes[56..64], [0xfd, 0xff, 200, 100, 50, 0, 0, 0]);
    // The first block: its counts, 3 positions, normals, colours, a face in three parts, 2 edges, 1 byte to fill.
    assert_eq!(bytes[64..72], [3, 0, 1, 0, 2, 0, 0, 0]);
    assert_eq!(bytes[72..90], [0, 0, 1, 0, 2, 0, 255, 255, 4, 0, 5, 0, 6, 0, 7, 0, 0, 255]);
    assert_eq!(bytes[90..99], [127, 0, 0, 0, 129, 0, 128, 5, 6]);
    assert_eq!(bytes[99..108], [1, 2, 3, 4, 5, 6, 255, 0, 128]);
    assert_eq!(bytes[108..121], [0, 1, 2, 0, 0, 127, 10, 20, 30, 0, 1, 1, 2]);
    assert_eq!(bytes[121..124], [0; 3]);
    assert_eq!(bytes[124..132], [2, 0, 0, 0, 1, 0, 0, 0]);
    assert_eq!(bytes.len(), 132 + 12 + 6 + 6 + 2 + 2);
}

#[test]
fn parts_that_no_flag_names_take_no_room() {
    let (header, blocks) = example();
    let bytes = write(&Header { flags: Flags(0), ..header }, &blocks).expect("a good file");
    let file = MeshFile::read(&bytes).expect("a good file");
    let block = file.blocks().next().expect("a block");
    assert!(block.normals.is_empty() && block.colours.is_empty());
    assert!(block.face_normals.is_empty() && block.face_colours.is_empty());
    assert_eq!((block.corners, block.edges), (&[[0, 1, 2]][..], &[[0, 1], [1, 2]][..]));
    assert_eq!(bytes.len(), 64 + (8 + 18 + 3 + 4 + 3) + (8 + 12 + 2 + 2));
}

#[test]
fn a_coordinate_is_offset_and_steps() {
    let header = example().0;
    assert_eq!(header.coordinate(0, 65_535), -(1 << 28) + 65_535 * 8193);
    assert_eq!(header.coordinate(1, 7), 7);
    // 65,535 · 8,193 reaches twice as far as the offset does.
    assert_eq!(header.extent(), [65_535 * 8193 - (1 << 28), 65_535, 1 << 27]);
}

#[test]
fn what_follows_a_file_in_memory_is_left_alone() {
    let file = good();
    let memory = [file.as_slice(), &[0xaa; 40]].concat();
    assert_eq!(MeshFile::read_start(&memory).expect("a good file").header().blocks, 2);
    assert_eq!(
        MeshFile::read(&memory).err(),
        Some(FormatError::Length { stated: file.len() as u32, found: file.len() + 40 })
    );
    let cut = &file[..file.len() - 1];
    let error = FormatError::Length { stated: file.len() as u32, found: cut.len() };
    assert_eq!(MeshFile::read_start(cut).err(), Some(error));
    assert_eq!(MeshFile::read_start(&[0xff; 4096]).err(), Some(FormatError::NotAMesh { found: [0xff; 4] }));
}

#[test]
fn every_error_names_the_place_the_value_and_the_remedy() {
    let length = good().len();
    let remake = "make the file with `cargo xtask mesh`";
    let cases: &[(Vec<u8>, String)] = &[
        (vec![], "0 bytes are no mesh file, whose header alone has 64: load the whole file".into()),
        (good()[..63].to_vec(), "63 bytes are no mesh file, whose header alone has 64: load the whole file".into()),
        (b"solid x".to_vec(), "starts with [73, 6f, 6c, 69], no mesh file: make one with `cargo xtask mesh`".into()),
        (
            changed(12, &[2]),
            "mesh file of version 2, this program reads version 1: make it again with `cargo xtask mesh`".into(),
        ),
        (
            good()[..length - 1].to_vec(),
            format!("{} bytes of a mesh file of {length}: load the whole file, and no more than that", length - 1),
        ),
        (
            changed(14, &[0x1f, 0x80]),
            "flags 0x801f, of which 0x8000 mean nothing in version 1: make the file again with `cargo xtask mesh`"
                .into(),
        ),
        (changed(62, &[3]), format!("byte 62 is 0x03 and must be 0: {remake}")),
        (changed(71, &[1]), format!("byte 71 is 0x01 and must be 0: {remake}")),
        (changed(122, &[9]), format!("byte 122 is 0x09 and must be 0: {remake}")),
        (
            changed(52, &40_000u32.to_le_bytes()),
            format!("offset 134217728 and step 40000 of z lead out of -8...8: {remake}"),
        ),
        (changed(28, &[0]), format!("the file has no block: {remake}")),
        (changed(64, &[0]), format!("block 0 has no vertex: {remake}")),
        (changed(64, &[1, 1]), format!("block 0 has 257 vertices, at most 256 are allowed: {remake}")),
        (changed(66, &[1, 2]), format!("block 0 has 513 faces, at most 512 are allowed: {remake}")),
        (changed(68, &[1, 6]), format!("block 0 has 1537 edges, at most 1536 are allowed: {remake}")),
        (changed(126, &[9]), format!("block 1 at byte 124 wants 116 bytes where 36 are left: {remake}")),
        (changed(28, &[3]), format!("block 2 at byte {length} wants 8 bytes where 0 are left: {remake}")),
        (changed(109, &[3]), format!("face 0 of block 0 names vertex 3 of 3: {remake}")),
        (changed(119, &[200]), format!("edge 1 of block 0 names vertex 200 of 3: {remake}")),
        (changed(16, &[6]), format!("the header states 6 vertices, the blocks have 5: {remake}")),
        (changed(20, &[0]), format!("the header states 0 faces, the blocks have 1: {remake}")),
        (changed(24, &[9]), format!("the header states 9 edges, the blocks have 3: {remake}")),
        (changed(28, &[1]), format!("36 bytes behind the last block, from byte 124 on: {remake}")),
    ];
    for (bytes, expected) in cases {
        assert_eq!(MeshFile::read(bytes).expect_err(expected).to_string(), *expected);
    }
    let mut bytes = good();
    bytes[100] ^= 1;
    let error = MeshFile::read(&bytes).expect_err("one bit is wrong").to_string();
    let stated = u32::from_le_bytes([bytes[4], bytes[5], bytes[6], bytes[7]]);
    let found = crc32(&bytes[8..]);
    assert_eq!(error, format!("checksum {found:#010x} where the file states {stated:#010x}: copy the file again"));
}

#[test]
fn no_single_bit_is_beyond_the_checks() {
    let good = good();
    for bit in 0..8 * good.len() {
        let mut bytes = good.clone();
        bytes[bit / 8] ^= 1 << (bit % 8);
        assert!(MeshFile::read(&bytes).is_err(), "bit {bit}");
    }
}

#[test]
fn what_cannot_be_read_is_not_written() {
    let (header, blocks) = example();
    assert_eq!(write(&header, &[]), Err(FormatError::Empty));
    let too_many = BlockData { positions: vec![[0; 3]; 257], ..BlockData::default() };
    let error = FormatError::BlockCount { block: 0, of: Count::Vertices, found: 257 };
    assert_eq!(write(&header, &[too_many]), Err(error));
    let astray = BlockData { corners: vec![[0, 1, 3]], ..blocks[0].clone() };
    let error = FormatError::NoSuchVertex { block: 0, of: Count::Faces, index: 0, vertex: 3, vertices: 3 };
    assert_eq!(write(&header, &[astray]), Err(error));
    let far = Header { offset: [i32::MAX, 0, 0], ..header };
    assert_eq!(write(&far, &blocks), Err(FormatError::Range { axis: 0, offset: i32::MAX, step: 8193 }));
}

#[test]
fn a_hundred_thousand_broken_files_are_read_or_named() {
    let good = good();
    let mut random = fastrand::Rng::with_seed(1);
    let mut accepted = 0;
    for round in 0..100_000 {
        let mut bytes = if round % 4 == 0 {
            let mut bytes = vec![0; random.usize(..300)];
            random.fill(&mut bytes);
            // Half of them get as far as the blocks.
            if round % 8 == 0 && bytes.len() > HEADER_BYTES {
                bytes[..HEADER_BYTES].copy_from_slice(&good[..HEADER_BYTES]);
            }
            bytes
        } else {
            let mut bytes = good.clone();
            for _ in 0..=random.usize(..4) {
                let at = random.usize(..bytes.len());
                match random.u8(..4) {
                    0 => bytes.truncate(at.max(1)),
                    1 => bytes.insert(at, random.u8(..)),
                    _ => bytes[at] = if random.bool() { random.u8(..) } else { random.u8(..4) },
                }
            }
            bytes
        };
        if bytes.len() >= 12 && random.u8(..8) > 0 {
            let length = bytes.len() as u32;
            bytes[8..12].copy_from_slice(&length.to_le_bytes());
        }
        let bytes = sealed(bytes);
        match MeshFile::read(&bytes) {
            Ok(file) => {
                accepted += 1;
                check(&file);
            }
            Err(error) => assert!(error.to_string().contains(": "), "{error}"),
        }
    }
    assert!((500..90_000).contains(&accepted), "both outcomes: {accepted} accepted");
}

/// What a file that was read promises.
fn check(file: &MeshFile<'_>) {
    let header = file.header();
    let mut totals = [0; 3];
    for block in file.blocks() {
        let vertices = block.positions.len();
        assert!(block.corners.as_flattened().iter().all(|corner| usize::from(*corner) < vertices));
        assert!(block.edges.as_flattened().iter().all(|end| usize::from(*end) < vertices));
        for (flag, part, count) in [
            (Flags::VERTEX_NORMALS, block.normals, vertices),
            (Flags::VERTEX_COLOURS, block.colours, vertices),
            (Flags::FACE_NORMALS, block.face_normals, block.corners.len()),
            (Flags::FACE_COLOURS, block.face_colours, block.corners.len()),
        ] {
            assert_eq!(part.len(), if header.flags.contains(flag) { count } else { 0 });
        }
        totals = [totals[0] + vertices, totals[1] + block.corners.len(), totals[2] + block.edges.len()];
    }
    assert_eq!(totals.map(|total| total as u32), [header.vertices, header.faces, header.edges]);
    for axis in 0..3 {
        let highest = i64::from(header.offset[axis]) + 65_535 * i64::from(header.step[axis]);
        assert_eq!(i64::from(header.coordinate(axis, u16::MAX)), highest);
    }
}
