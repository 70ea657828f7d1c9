//! Triangle setup for tests: in 64 bits and floating point, so that it needs no cleverness.

use fpga_regs::packet::{EdgeSteps, FlatTriangle, PixelMode, Span, TriangleShape};
use fpga_regs::screen::{HEIGHT, PacketDepth, Rgb332, SUBPIXEL, WIDTH};

/// A vertex: x and y in sixteenths of a pixel within the guard band, depth 0…65,535.
pub type Vertex = (i32, i32, f64);

/// Returns the packet of a triangle, or `None` if it has no area or its box is off the screen.
pub fn set_up(mut vertices: [Vertex; 3], colour: u8) -> Option<FlatTriangle> {
    let area = |v: &[Vertex; 3]| {
        i64::from(v[1].0 - v[0].0) * i64::from(v[2].1 - v[0].1)
            - i64::from(v[2].0 - v[0].0) * i64::from(v[1].1 - v[0].1)
    };
    if area(&vertices) < 0 {
        vertices.swap(1, 2);
    }
    let (area, v) = (area(&vertices), vertices);
    if area == 0 {
        return None;
    }
    let columns = span(v.map(|v| v.0), WIDTH)?;
    let rows = span(v.map(|v| v.1), HEIGHT)?;
    let centre = |first: u16| i32::from(first) * SUBPIXEL + SUBPIXEL / 2;
    let (x, y) = (centre(columns.first()), centre(rows.first()));

    let edge = |i: usize| {
        let (from, to) = (v[i], v[(i + 1) % 3]);
        let (step_x, step_y) = (from.1 - to.1, to.0 - from.0);
        let value = i64::from(step_x) * i64::from(x - from.0) + i64::from(step_y) * i64::from(y - from.1);
        let top_left = step_x > 0 || step_x == 0 && step_y > 0;
        ((value - i64::from(!top_left)).div_euclid(SUBPIXEL.into()) as i32, EdgeSteps::new(step_x, step_y))
    };
    let edges = [edge(0), edge(1), edge(2)];

    let slope = |p: f64, q: f64| p * f64::from(SUBPIXEL) / area as f64 * q;
    let (dz1, dz2) = (v[1].2 - v[0].2, v[2].2 - v[0].2);
    let step_x = slope(dz1, (v[2].1 - v[0].1).into()) - slope(dz2, (v[1].1 - v[0].1).into());
    let step_y = slope(dz2, (v[1].0 - v[0].0).into()) - slope(dz1, (v[2].0 - v[0].0).into());
    let depth = v[0].2 + (f64::from(x - v[0].0) * step_x + f64::from(y - v[0].1) * step_y) / f64::from(SUBPIXEL);
    let modular = |value: f64| PacketDepth::from_bits((value * 4096.0).round() as i64 as i32);
    Some(FlatTriangle {
        colour: Rgb332(colour),
        mode: PixelMode::USUAL,
        shape: TriangleShape {
            columns,
            rows,
            edges: edges.map(|edge| edge.0),
            steps: [edges[0].1, edges[1].1],
            depth: modular(depth),
            depth_step_x: modular(step_x),
            depth_step_y: modular(step_y),
        },
    })
}

fn span(ends: [i32; 3], size: u32) -> Option<Span> {
    let first = ends.iter().min()?.div_euclid(SUBPIXEL).max(0);
    let last = ends.iter().max()?.div_euclid(SUBPIXEL).min(size as i32 - 1);
    (first <= last).then(|| Span::new(first as u16, last as u16))
}
