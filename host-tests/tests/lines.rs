//! Lines, pixel by pixel, against the rule worked out in another way: in fractions, column by
//! column, the nearest of all pixels.

use fpga_regs::packet::{FlatTriangle, Header, Packet, PixelMode};
use fpga_regs::screen::{GUARD_BAND, HEIGHT, Rgb332, WIDTH};
use geometry::ScreenVertex;
use geometry::line::{LineStyle, set_up_line};
use host_tests::collect::vertex;
use host_tests::packet_pixels;
use host_tests::rng::Rng;

type Pixel = (i32, i32);

const STYLE: LineStyle = LineStyle { colour: Rgb332(0x1c), mode: PixelMode::USUAL };

fn packet(from: &ScreenVertex, to: &ScreenVertex) -> Option<FlatTriangle> {
    let mut words = [0; FlatTriangle::WORDS];
    if !set_up_line(from, to, &STYLE, &mut words) {
        return None;
    }
    match Packet::decode(Header(words[0]), &words[1..]) {
        Ok(Packet::FlatTriangle(triangle)) => Some(triangle),
        other => panic!("{from:?} to {to:?} is {other:?}"),
    }
}

fn pixels(line: Option<&FlatTriangle>) -> Vec<Pixel> {
    let mut pixels = Vec::new();
    if let Some(line) = line {
        packet_pixels::for_each(&line.shape, |x, y| pixels.push((x, y)));
    }
    pixels
}

/// The rule. `a` and `b` in sixteenths of a pixel.
fn expected(a: Pixel, b: Pixel) -> Vec<Pixel> {
    let steep = (b.1 - a.1).abs() > (b.0 - a.0).abs();
    let turned = |(x, y): Pixel| if steep { (y, x) } else { (x, y) };
    let (a, b) = (turned(a), turned(b));
    let (major_size, minor_size) = if steep { (HEIGHT, WIDTH) } else { (WIDTH, HEIGHT) };
    let mut pixels = Vec::new();
    for major in a.0.min(b.0).div_euclid(16)..=a.0.max(b.0).div_euclid(16) {
        if !(0..major_size as i32).contains(&major) {
            continue;
        }
        // Distance of a pixel's centre to the line, times the line's length: minor·length = numerator.
        let length = i64::from((b.0 - a.0).abs().max(1));
        let numerator = i64::from(a.1) * length
            + i64::from(b.1 - a.1) * i64::from(major * 16 + 8 - a.0) * i64::from((b.0 - a.0).signum());
        let distance = |minor: i32| (i64::from(minor * 16 + 8) * length - numerator).abs();
        // A point has the pixel that contains it.
        let nearest = if a == b {
            a.1.div_euclid(16)
        } else {
            let about = (numerator.div_euclid(16 * length)) as i32;
            (about - 2..=about + 2).min_by_key(|minor| (distance(*minor), *minor)).expect("five to choose from")
        };
        if (0..minor_size as i32).contains(&nearest) {
            pixels.push(turned((major, nearest)));
        }
    }
    pixels.sort_by_key(|(x, y)| (*y, *x));
    pixels
}

fn any_end(rng: &mut Rng) -> ScreenVertex {
    let mut part = |size: u32| match rng.below(6) {
        0 => rng.pick(&[-GUARD_BAND, GUARD_BAND]),
        1 => rng.within(-GUARD_BAND, GUARD_BAND),
        // Whole and half pixels, where ties are.
        2 => rng.within(-4, 2 * size as i32) * 8,
        _ => rng.within(-40, 16 * size as i32 + 40),
    };
    let place = (part(WIDTH), part(HEIGHT));
    vertex(place, rng.within(0, 65_535))
}

fn another_end(rng: &mut Rng, end: &ScreenVertex) -> ScreenVertex {
    let reach = rng.pick(&[0, 4, 16, 64, 400, 20_000]);
    let mut near = |part: i32| (part + rng.within(-reach, reach)).clamp(-GUARD_BAND, GUARD_BAND);
    let place = match (near(end.x), near(end.y)) {
        (x, _) if reach == 64 => (x, end.y),
        (_, y) if reach == 16 => (end.x, y),
        (x, _) if reach == 400 => (x, (end.y + x - end.x).clamp(-GUARD_BAND, GUARD_BAND)),
        place => place,
    };
    vertex(place, rng.within(0, 65_535))
}

#[test]
fn a_line_is_the_nearest_pixels_from_either_end() {
    let mut rng = Rng(61);
    let (mut drawn, mut worst) = (0, 0);
    for _ in 0..40_000 {
        let from = any_end(&mut rng);
        let to = another_end(&mut rng, &from);
        let line = packet(&from, &to);
        let (a, b) = ((from.x, from.y), (to.x, to.y));
        let found = pixels(line.as_ref());
        assert_eq!(found, expected(a, b), "{from:?} to {to:?}: {line:?}");
        assert_eq!(line, packet(&to, &from), "{from:?} to {to:?}");
        drawn += found.len();
        if let Some(line) = line {
            let (columns, rows) = (line.shape.columns, line.shape.rows);
            for x in [columns.first(), columns.last()] {
                for y in [rows.first(), rows.last()] {
                    worst = packet_pixels::edges_at(&line.shape, x.into(), y.into())
                        .map(i64::abs)
                        .into_iter()
                        .fold(worst, i64::max);
                }
            }
        }
    }
    println!("{drawn} pixels, largest edge value {worst}");
    assert!(drawn > 400_000 && worst <= 1 << 24, "{drawn} pixels, edges up to {worst}");
}

#[test]
fn outlines_have_no_gap() {
    let mut rng = Rng(62);
    for _ in 0..20_000 {
        let mut end = || vertex((rng.within(16, 5_000), rng.within(16, 3_700)), 0);
        let (a, b) = (end(), end());
        let near = |rng: &mut Rng, part: i32, size: u32| (part + rng.within(-80, 80)).clamp(16, 16 * size as i32 - 17);
        let c = vertex((near(&mut rng, b.x, WIDTH), near(&mut rng, b.y, HEIGHT)), 0);
        let (first, second) = (pixels(packet(&a, &b).as_ref()), pixels(packet(&b, &c).as_ref()));
        let touch = |p: &Pixel, q: &Pixel| (p.0 - q.0).abs() <= 1 && (p.1 - q.1).abs() <= 1;
        let at_end = |pixel: &&Pixel| touch(pixel, &(b.x.div_euclid(16), b.y.div_euclid(16)));
        let meets = first.iter().filter(at_end).any(|p| second.iter().filter(at_end).any(|q| touch(p, q)));
        assert!(meets, "{a:?}, {b:?}, {c:?}");
        for line in [first, second] {
            let mut along = line.clone();
            let wide = along.iter().map(|p| p.0).max().zip(along.iter().map(|p| p.0).min()).map(|(a, b)| a - b);
            let high = along.iter().map(|p| p.1).max().zip(along.iter().map(|p| p.1).min()).map(|(a, b)| a - b);
            along.sort_by_key(|(x, y)| if wide >= high { (*x, *y) } else { (*y, *x) });
            assert!(along.windows(2).all(|pair| touch(&pair[0], &pair[1])), "{along:?}");
            assert_eq!(along.len() as i32, wide.max(high).expect("on the screen") + 1, "one pixel thick");
        }
    }
}

#[test]
fn depth_runs_from_end_to_end() {
    let mut rng = Rng(63);
    let mut worst = 0.0f64;
    for _ in 0..20_000 {
        let from = any_end(&mut rng);
        let to = another_end(&mut rng, &from);
        let Some(line) = packet(&from, &to) else { continue };
        let steep = (to.y - from.y).abs() > (to.x - from.x).abs();
        let major = |x: i32, y: i32| if steep { y } else { x };
        let (start, length) = (major(from.x, from.y), major(to.x, to.y) - major(from.x, from.y));
        for (x, y) in pixels(Some(&line)) {
            let found = packet_pixels::depth_at(&line.shape, x, y) >> 12;
            let exact = if length.abs() < 16 {
                f64::from(from.depth.min(to.depth))
            } else {
                let part = f64::from(major(x, y) * 16 + 8 - start) / f64::from(length);
                f64::from(from.depth) + part * f64::from(to.depth - from.depth)
            };
            let error = (f64::from(found) - exact).abs();
            worst = worst.max(error);
            assert!(error <= 1.0, "{from:?} to {to:?} at ({x}, {y}): {found}, exactly {exact}");
        }
    }
    println!("depth is off by {worst} at most");
}
