//! A model becomes a file, and the file that model again.

use std::collections::BTreeMap;
use std::path::Path;

use mesh_format::{Block, FACES_MAX, MeshFile, VERTICES_MAX};
use models::compile::{CompileError, Compiled, Looks, Options, compile};
use models::{Model, mesh_file, obj};

fn model(text: &str) -> Model {
    obj::parse_obj(text.as_bytes(), Path::new("m.obj"), |_| Ok(None)).expect("a good model")
}

/// A grid of `side` × `side` squares on a wave.
fn grid(side: usize, size: f64, offset: f64) -> Model {
    let mut text = String::new();
    for row in 0..=side {
        for column in 0..=side {
            let [x, z] = [column, row].map(|part| part as f64 / side as f64 * size + offset);
            let y = ((x - offset) / size * 9.0).sin() * size / 4.0;
            text += &format!("v {x:e} {y:e} {z:e}\n");
        }
    }
    for row in 0..side {
        for column in 0..side {
            let at = |row: usize, column: usize| row * (side + 1) + column + 1;
            let [a, b, c, d] = [at(row, column), at(row + 1, column), at(row + 1, column + 1), at(row, column + 1)];
            text += &format!("f {a} {b} {c} {d}\n");
        }
    }
    model(&text)
}

fn compiled(model: &Model, options: &Options) -> Compiled {
    compile(model, options).expect("it compiles")
}

fn back(compiled: &Compiled) -> Model {
    mesh_file::parse(&compiled.bytes, Path::new("m.mesh")).expect("what was written is read")
}

/// A model's triangles by their corners' positions, in steps of four bounds, each beginning with the least.
fn triangles(model: &Model, grain: f64) -> Vec<[[i64; 3]; 3]> {
    let mut triangles: Vec<[[i64; 3]; 3]> = model
        .triangles()
        .map(|corners| {
            let mut corners =
                corners.map(|corner| model.positions[corner as usize].map(|part| (part / grain).round() as i64));
            let least = (0..3).min_by_key(|at| corners[*at]).expect("three corners");
            corners.rotate_left(least);
            corners
        })
        .collect();
    triangles.sort_unstable();
    triangles
}

#[test]
fn every_triangle_comes_back_within_the_bound() {
    for (size, offset) in [(2.0, -1.0), (1e-7, 3e-7), (4e6, 1e6), (1e-90, 0.0), (7.9, 0.0)] {
        let model = grid(40, size, offset);
        let compiled = compiled(&model, &Options::default());
        let again = back(&compiled);
        assert_eq!(again.triangle_count(), model.triangle_count());
        let bound = compiled.report.error_bound;
        // The longest side in 65,535 steps, rounded up; half a step each way.
        assert!(bound <= size / 65_535.0 / 2.0 * 1.01 + size * 1e-6, "{size} {bound}");
        // Each position of the model is near one of the file's, and the other way round.
        let nearest = |from: &Model, to: &Model| {
            let mut grid: BTreeMap<[i64; 3], Vec<[f64; 3]>> = BTreeMap::new();
            let cell = |position: [f64; 3]| position.map(|part| (part / (8.0 * bound)).floor() as i64);
            to.positions.iter().for_each(|position| grid.entry(cell(*position)).or_default().push(*position));
            from.positions.iter().all(|position| {
                let [x, y, z] = cell(*position);
                (-1..=1).any(|i| {
                    (-1..=1).any(|j| {
                        (-1..=1).any(|k| {
                            grid.get(&[x + i, y + j, z + k]).is_some_and(|near| {
                                near.iter().any(|near| {
                                    (0..3).all(|axis| (near[axis] - position[axis]).abs() <= bound * 1.000_001)
                                })
                            })
                        })
                    })
                })
            })
        };
        assert!(nearest(&model, &again) && nearest(&again, &model), "{size}");
    }
}

#[test]
fn a_file_that_becomes_a_file_again_keeps_its_triangles() {
    let first = back(&compiled(&grid(30, 2.0, -1.0), &Options::default()));
    let second = back(&compiled(&first, &Options::default()));
    // Quantised once, the numbers lie on a lattice that is kept.
    assert_eq!(triangles(&first, 1e-7), triangles(&second, 1e-7));
}

#[test]
fn blocks_keep_their_bounds_and_share_borders() {
    let compiled = compiled(&grid(100, 2.0, -1.0), &Options::default());
    let file = MeshFile::read(&compiled.bytes).expect("a good file");
    for block in file.blocks() {
        assert!(block.positions.len() <= VERTICES_MAX && block.corners.len() <= FACES_MAX);
    }
    let report = compiled.report;
    assert_eq!((report.positions, report.vertices, report.faces), (10_201, 10_201, 20_000));
    // Squares' sides, not their diagonals.
    assert_eq!(report.edges, 2 * 100 * 101);
    assert!(report.cache_misses[1] < 0.75, "{report:?}");
    assert!(report.stored_vertices < 12_000, "{report:?}");
    let distinct: std::collections::HashSet<_> =
        file.blocks().flat_map(|block| block.positions.iter().copied().map(Block::position)).collect();
    assert_eq!(distinct.len(), 10_201, "a border's vertices have the same numbers in both blocks");
}

#[test]
fn a_bad_order_is_mended() {
    let mut shuffled = grid(60, 2.0, -1.0);
    let mut faces: Vec<Vec<u32>> = shuffled.faces().map(<[u32]>::to_vec).collect();
    fastrand::Rng::with_seed(7).shuffle(&mut faces);
    shuffled.corners = faces.concat();
    let report = compiled(&shuffled, &Options::default()).report;
    assert!(report.cache_misses[0] > 1.9 && report.cache_misses[1] < 0.75, "{report:?}");
}

#[test]
fn sharp_edges_part_vertices_and_round_ones_do_not() {
    let cube = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
                f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 1 5 8 4\n";
    let report = |looks| compiled(&model(cube), &Options { looks, ..Options::default() }).report;
    assert_eq!((report(Looks::Both).vertices, report(Looks::Flat).vertices), (24, 8));
    assert_eq!((report(Looks::Smooth).faces, report(Looks::Smooth).edges), (12, 12));
    // On the wave all normals are shared.
    assert_eq!(compiled(&grid(40, 2.0, 0.0), &Options::default()).report.vertices, 41 * 41);
}

#[test]
fn normals_and_colours_survive_in_eight_bits() {
    let text = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nvn 0 0.6 0.8\nvn 0 0 1\nf 1//1 2//2 3//2\n";
    let again = back(&compiled(&model(text), &Options::default()));
    assert_eq!(again.colours, Some(vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]));
    let expected = [[0.0, 0.6, 0.8], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]];
    for (found, expected) in again.normals.iter().zip(expected) {
        let cosine: f32 = (0..3).map(|axis| found[axis] * expected[axis]).sum();
        assert!(cosine > 0.4f32.to_radians().cos(), "{found:?} for {expected:?}");
    }
}

#[test]
fn edges_are_there_once_however_often_a_file_becomes_one() {
    let cube = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
                f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 1 5 8 4\n";
    for (text, edges) in [(cube.to_string(), 12), (format!("{cube}l 1 7\n"), 13)] {
        let first = compiled(&model(&text), &Options::default());
        let second = compiled(&back(&first), &Options::default());
        for (compiled, name) in [(&first, "first"), (&second, "second")] {
            assert_eq!(compiled.report.edges, edges, "{name}");
            assert_eq!(back(compiled).lines.len(), edges, "{name}");
        }
        // Edges of faces need no vertices of their own: but for the line, the file does not grow.
        assert_eq!(second.report.stored_vertices, first.report.stored_vertices);
        assert_eq!(first.report.blocks, 1 + usize::from(edges == 13));
    }
}

#[test]
fn clockwise_faces_are_turned_round_and_their_outlines_stay() {
    let square = model("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 4 3 2 1\n");
    let compiled = compiled(&square, &Options { clockwise: true, ..Options::default() });
    let file = MeshFile::read(&compiled.bytes).expect("a good file");
    let block = file.blocks().next().expect("a block");
    assert!(block.face_normals.iter().all(|normal| *normal == [0, 0, 127]), "{:?}", block.face_normals);
    assert_eq!(block.edges.len(), 4);
    for ends in block.edges {
        let [a, b] = ends.map(|end| Block::position(block.positions[usize::from(end)]));
        let different = (0..3).filter(|axis| a[*axis] != b[*axis]).count();
        assert_eq!(different, 1, "a side of the square, not its diagonal");
    }
    let straight = triangles(&model("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"), 1e-3);
    let turned = triangles(&back(&compiled), 1e-3);
    let area = |triangles: &[[[i64; 3]; 3]]| -> i64 {
        triangles.iter().map(|[a, b, c]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).sum()
    };
    assert_eq!(area(&straight), area(&turned));
}

#[test]
fn scaling_to_fit_puts_the_middle_at_the_origin() {
    let fitted = back(&compiled(&grid(10, 700.0, 1e5), &Options { scale_to_fit: true, ..Options::default() }));
    let farthest =
        fitted.positions.iter().map(|p| p.iter().map(|part| part * part).sum::<f64>().sqrt()).fold(0.0, f64::max);
    assert!((farthest - 1.0).abs() < 1e-4, "{farthest}");
    for axis in 0..3 {
        let parts = || fitted.positions.iter().map(|position| position[axis]);
        let (low, high) = (parts().fold(f64::INFINITY, f64::min), parts().fold(f64::NEG_INFINITY, f64::max));
        assert!((low + high).abs() < 1e-4, "axis {axis} goes from {low} to {high}");
    }
}

#[test]
fn lines_alone_make_blocks_without_faces() {
    let mut text: String = (0..2000).map(|index| format!("v {index} {} 0\n", index % 7)).collect();
    text += &(1..2000).map(|index| format!("l {index} {}\n", index + 1)).collect::<String>();
    let compiled = compiled(&model(&text), &Options::default());
    let again = back(&compiled);
    assert_eq!((again.face_count(), again.lines.len(), compiled.report.edges), (0, 1999, 1999));
    // A file of lines has no normals and colours to store.
    assert!(compiled.bytes.len() < 64 + 2010 * 6 + 1999 * 2 + 12 * 12, "{}", compiled.bytes.len());
}

#[test]
fn what_cannot_be_a_file_is_named() {
    let huge = model("v 1e200 0 0\nv 0 1e200 0\nv 0 0 0\nf 1 2 3\n");
    let error = compile(&huge, &Options::default()).expect_err("huge");
    assert_eq!(error, CompileError::Size { largest: 1e200 });
    assert_eq!(
        error.to_string(),
        "the model's largest coordinate is 1e200: scale the model to a size between 1e-100 and 1e100"
    );
    let nothing = model("v 1 1 1\nv 2 1 1\nf 1 1 2\n");
    let error = compile(&nothing, &Options::default()).expect_err("no area").to_string();
    assert_eq!(error, "none of the 1 faces has an area, and no line a length: export the model again");
    let report = compiled(&model("v 1 1 1\nv 2 1 1\nv 2 2 1\nf 1 1 2\nf 1 2 3\n"), &Options::default()).report;
    assert_eq!((report.faces, report.left_out), (1, 1));
}
