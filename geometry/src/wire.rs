//! A mesh as lines.

use core::ops::ControlFlow;

use fpga_regs::packet::FlatTriangle;

use crate::clip::clip_line;
use crate::line::{LineStyle, set_up_line};
use crate::mesh::Mesh;
use crate::pipeline::{DrawStatistics, Drawn, Sink, Transformed};
use crate::setup::ScreenVertex;

/// Writes a mesh's edges into `buffer`, each once however many faces share it, and returns them;
/// `None` if the buffer holds fewer than three times as many as there are faces.
pub fn edges<'a>(mesh: &Mesh<'_>, buffer: &'a mut [[u32; 2]]) -> Option<&'a [[u32; 2]]> {
    let all = buffer.get_mut(..3 * mesh.faces().len())?;
    for (edges, face) in all.chunks_exact_mut(3).zip(mesh.faces()) {
        let [a, b, c] = face.corners;
        edges.copy_from_slice(&[[a, b], [b, c], [c, a]].map(|[from, to]| [from.min(to), from.max(to)]));
    }
    sort(all);
    let mut kept = 0;
    for index in 0..all.len() {
        if index == 0 || all[index] != all[kept - 1] {
            all[kept] = all[index];
            kept += 1;
        }
    }
    Some(&all[..kept])
}

/// Sorts by Shell's method (CACM 2, 1959) with Knuth's gaps: a few lines, where the library's sort is 12 KiB.
fn sort(edges: &mut [[u32; 2]]) {
    let mut gap = 1;
    while gap < edges.len() / 3 {
        gap = 3 * gap + 1;
    }
    while gap > 0 {
        for next in gap..edges.len() {
            let edge = edges[next];
            let mut place = next;
            while place >= gap && edges[place - gap] > edge {
                edges[place] = edges[place - gap];
                place -= gap;
            }
            edges[place] = edge;
        }
        gap /= 3;
    }
}

/// Draws lines between vertices: see [`Transformed::draw_lines`].
pub(crate) fn draw(
    transformed: &Transformed<'_>,
    edges: &[[u32; 2]],
    style: &LineStyle,
    sink: &mut impl Sink,
) -> DrawStatistics {
    let mut statistics = DrawStatistics {
        vertices: transformed.cache().len() as u32,
        submitted: edges.len() as u32,
        ..DrawStatistics::default()
    };
    for &[from, to] in edges {
        let (Some(a), Some(b)) = (transformed.vertex(from), transformed.vertex(to)) else { continue };
        let drawn = match (a.outside | b.outside, a.outside & b.outside) {
            (0, _) => line(a, b, style, sink),
            // Both ends beyond one plane: nothing of the line is inside.
            (_, 1..) => continue,
            _ => {
                statistics.clipped += 1;
                let ends = [from, to].map(|end| transformed.homogeneous(end as usize));
                let Some([a, b]) = clip_line(ends) else { continue };
                line(&a.project(), &b.project(), style, sink)
            }
        };
        match drawn {
            ControlFlow::Continue(drawn) => statistics.drawn += u32::from(drawn),
            ControlFlow::Break(()) => break,
        }
    }
    statistics
}

fn line(a: &ScreenVertex, b: &ScreenVertex, style: &LineStyle, sink: &mut impl Sink) -> ControlFlow<(), bool> {
    let Some(words) = sink.room::<{ FlatTriangle::WORDS }>() else { return ControlFlow::Break(()) };
    let drawn = set_up_line(a, b, style, words);
    if drawn {
        sink.take::<{ FlatTriangle::WORDS }>(Drawn::Line { ends: [a, b], style: *style });
    }
    ControlFlow::Continue(drawn)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Face, Winding};
    use crate::shapes::torus;
    use fixed::types::I4F28;
    use std::collections::BTreeSet;
    use std::vec;

    #[test]
    fn every_edge_of_a_mesh_is_there_once() {
        let (mut positions, mut faces) = (vec![[I4F28::ZERO; 3]; 48], vec![Face::default(); 96]);
        let sizes = (I4F28::ONE, I4F28::from_num(0.25));
        let (positions, faces) = torus((8, 6), sizes, |_, _| [9; 3], &mut positions, &mut faces).expect("it fits");
        let mesh = Mesh::new(positions, faces, Winding::CounterClockwise).expect("a mesh");
        let mut buffer = vec![[0; 2]; 288];
        let found = edges(&mesh, &mut buffer).expect("it fits");
        // A closed surface has three edges for every two faces.
        assert_eq!(found.len(), 144);
        let mut expected = BTreeSet::new();
        for face in faces {
            for (from, to) in [(0, 1), (1, 2), (2, 0)] {
                let ends = [face.corners[from], face.corners[to]];
                expected.insert([ends[0].min(ends[1]), ends[0].max(ends[1])]);
            }
        }
        assert!(found.iter().eq(expected.iter()), "{found:?}");
        assert_eq!(edges(&mesh, &mut [[0; 2]; 287]), None);
    }
}
