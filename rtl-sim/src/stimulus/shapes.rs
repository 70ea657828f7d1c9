//! Triangle packets from vertices, and words that no setup makes.

use fpga_regs::packet::{
    Channels, EdgeSteps, FlatTriangle, GouraudTriangle, Header, Kind, PixelMode, Span, TriangleShape,
};
use fpga_regs::screen::{GUARD_BAND, HEIGHT, PacketDepth, Rgb332, WIDTH};

use super::random::Random;

/// A vertex: x and y in sixteenths of a pixel, depth 0…65,535.
pub type Vertex = [i32; 3];

/// Returns the packet of a triangle, or `None` when it faces nowhere or misses the screen.
///
/// A plain setup with 64-bit divisions; either winding. `loose` takes the whole screen for its box.
pub fn triangle(mut vertices: [Vertex; 3], colour: u8, loose: bool) -> Option<FlatTriangle> {
    let area = |v: &[Vertex; 3]| {
        i64::from(v[1][0] - v[0][0]) * i64::from(v[2][1] - v[0][1])
            - i64::from(v[2][0] - v[0][0]) * i64::from(v[1][1] - v[0][1])
    };
    if area(&vertices) < 0 {
        vertices.swap(1, 2);
    }
    let twice_area = area(&vertices);
    if twice_area == 0 {
        return None;
    }
    let bounds = |axis: usize, size: u32| {
        let coordinates = vertices.map(|vertex| vertex[axis]);
        let lowest = coordinates.into_iter().min()?;
        let highest = coordinates.into_iter().max()?;
        // Pixels whose centre, at sixteenths 16 n + 8, lies within.
        let first = (lowest - 8 + 15).div_euclid(16).max(0);
        let last = (highest - 8).div_euclid(16).min(size as i32 - 1);
        if loose { Some((0, size as i32 - 1)) } else { (first <= last).then_some((first, last)) }
    };
    let (left, right) = bounds(0, WIDTH)?;
    let (top, bottom) = bounds(1, HEIGHT)?;
    let (x, y) = (i64::from(left * 16 + 8), i64::from(top * 16 + 8));
    let mut edges = [0; 3];
    let mut steps = [EdgeSteps::new(0, 0); 3];
    for index in 0..3 {
        let (from, to) = (vertices[index], vertices[(index + 1) % 3]);
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        // Clockwise on a screen with y down: inside is where this is positive.
        let value = i64::from(dx) * (y - i64::from(from[1])) - i64::from(dy) * (x - i64::from(from[0]));
        let top_left = dy < 0 || dy == 0 && dx > 0;
        // In steps of an edge; the largest multiple of a step that is not above keeps the sign right.
        edges[index] = ((value - i64::from(!top_left)).div_euclid(16)) as i32;
        steps[index] = EdgeSteps::new(-dy, dx);
    }
    let plane = |axis: usize| {
        let [a, b, c] = vertices.map(i64_of);
        let numerator = if axis == 0 {
            (b[2] - a[2]) * (c[1] - a[1]) - (c[2] - a[2]) * (b[1] - a[1])
        } else {
            (c[2] - a[2]) * (b[0] - a[0]) - (b[2] - a[2]) * (c[0] - a[0])
        };
        ((numerator * 16) << 12).div_euclid(twice_area)
    };
    let (step_x, step_y) = (plane(0), plane(1));
    let [a, ..] = vertices.map(i64_of);
    let depth = (a[2] << 12) + (step_x * (x - a[0]) + step_y * (y - a[1])).div_euclid(16);
    let q = |value: i64| PacketDepth::from_bits(value as i32);
    Some(FlatTriangle {
        colour: Rgb332(colour),
        mode: PixelMode::USUAL,
        shape: TriangleShape {
            columns: Span::new(left as u16, right as u16),
            rows: Span::new(top as u16, bottom as u16),
            edges,
            steps: [steps[0], steps[1]],
            depth: q(depth),
            depth_step_x: q(step_x),
            depth_step_y: q(step_y),
        },
    })
}

fn i64_of(vertex: Vertex) -> [i64; 3] {
    vertex.map(i64::from)
}

/// Returns a random triangle that setup could make: of any size and orientation.
pub fn any_triangle(random: &mut Random) -> FlatTriangle {
    loop {
        let (centre_x, centre_y) = (random.within(-160, 5280), random.within(-160, 4000));
        let depth = random.within(0, 65535);
        // In sixteenths: how far vertices lie from the centre.
        let reach = match random.within(0, 99) {
            0..40 => 48,
            40..70 => 160,
            70..88 => 640,
            88..98 => 2400,
            _ => GUARD_BAND,
        };
        let mut vertex = |reach: i32| {
            let clamp = |value: i32| value.clamp(-GUARD_BAND, GUARD_BAND);
            let x = clamp(centre_x + random.within(-reach, reach));
            let y = clamp(centre_y + random.within(-reach, reach));
            [x, y, (depth + random.within(-3000, 3000)).clamp(0, 65535)]
        };
        let mut vertices = [vertex(reach), vertex(reach), vertex(reach)];
        match random.within(0, 19) {
            // Slivers: two vertices close together, at any slope.
            0..3 => {
                let [x, y, _] = vertices[0];
                vertices[1] = [x + random.within(-20, 20), y + random.within(-20, 20), vertices[1][2]];
            }
            // Edges along the axes.
            3 => vertices[1][1] = vertices[0][1],
            4 => vertices[2][0] = vertices[0][0],
            // Vertices on pixel centres, where the fill rule decides.
            5..8 => vertices.iter_mut().flatten().for_each(|value| *value = (*value & !15) + 8),
            _ => {}
        }
        vertices.iter_mut().for_each(|vertex| {
            vertex[0] = vertex[0].clamp(-GUARD_BAND, GUARD_BAND);
            vertex[1] = vertex[1].clamp(-GUARD_BAND, GUARD_BAND);
            vertex[2] = vertex[2].clamp(0, 65535);
        });
        let loose = random.one_in(200);
        if let Some(triangle) = triangle(vertices, random.word() as u8, loose) {
            return FlatTriangle { mode: any_mode(random), ..triangle };
        }
    }
}

/// Returns mostly the usual mode.
fn any_mode(random: &mut Random) -> PixelMode {
    PixelMode { keep_depth: random.one_in(12), keep_colour: random.one_in(12), depth_grey: random.one_in(12) }
}

/// Returns a triangle as [`any_triangle`]'s whose colour changes: by little from pixel to pixel, so
/// that it stays in range or leaves it here and there, or by anything.
pub fn any_gouraud_triangle(random: &mut Random) -> GouraudTriangle {
    let shape = any_triangle(random).shape;
    let slope_bits = random.within(0, 21);
    let mut channels = |reach: i32| Channels([0; 3].map(|_| random.within(-reach, reach) & 0x1f_ffff));
    GouraudTriangle {
        colour: channels(1 << 20),
        colour_step_x: channels(1 << slope_bits >> 1),
        colour_step_y: channels(1 << slope_bits >> 1),
        mode: any_mode(random),
        shape,
    }
}

/// Returns a triangle of random words in a box on the screen: its edges wrap and mean nothing.
pub fn garbage_triangle(random: &mut Random) -> [u32; FlatTriangle::WORDS] {
    let mut span = |size: u32| {
        let reach = if random.one_in(20) { size as i32 } else { 24 };
        let first = random.within(0, size as i32 - 1);
        let last = random.within(first, (first + reach).min(size as i32 - 1));
        Span::new(first as u16, last as u16)
    };
    let (columns, rows) = (span(WIDTH), span(HEIGHT));
    let mut words = [0; FlatTriangle::WORDS];
    words.iter_mut().for_each(|word| *word = random.word());
    // Values near zero, near the limits of what may wrap, and anything.
    for edge in &mut words[3..6] {
        match random.within(0, 3) {
            0 => *edge = (*edge as i32 >> 12) as u32,
            1 => *edge = (1u32 << 30).wrapping_add((*edge as i32 >> 8) as u32),
            2 => *edge = (*edge as i32 >> 2) as u32,
            _ => {}
        }
    }
    // Setup's slopes are modulo 2^32 as well; and slow ones, so that depths stay in range.
    for step in &mut words[9..11] {
        if random.one_in(2) {
            *step = (*step as i32 >> 14) as u32;
        }
    }
    words[0] = Header::of(Kind::FlatTriangle).0 | words[0] & 0x7ff;
    words[1] = columns.0;
    words[2] = rows.0;
    words
}

/// Returns words that are mostly not packets: random headers with their words, short lengths.
pub fn garbage_words(random: &mut Random) -> Vec<u32> {
    let mut words = Vec::new();
    for _ in 0..random.within(1, 12) {
        let kind = match random.within(0, 3) {
            0 => random.within(0, 255) as u32,
            // No swap: it would cost a frame each.
            _ => [Kind::Clear, Kind::FlatTriangle, Kind::GouraudTriangle, Kind::Fence][random.within(0, 3) as usize]
                as u32,
        };
        let kind = if kind == Kind::Swap as u32 { 0 } else { kind };
        let length = if random.one_in(3) { random.within(0, 20) as u32 } else { [1, 1, 10, 16][(kind & 3) as usize] };
        let low = if random.one_in(3) { random.word() & 0xffff } else { 0 };
        words.push(kind << 24 | length << 16 | low);
        for _ in 0..length {
            words.push(if random.one_in(2) { random.word() & 0x003f_003f } else { random.word() });
        }
    }
    words
}
