//! How many clocks work takes, and what it may take: `cargo xtask bench` prints it, a test holds it to the bars.
//!
//! Clocks of a simulation repeat exactly.

use fpga_regs::Port;
use fpga_regs::packet::{Channels, Clear, FlatTriangle, GouraudTriangle};
use fpga_regs::registers::{Control, Register};
use fpga_regs::screen::{COLOUR_FRACTION_BITS, DEPTH_FAR, HEIGHT, PIXELS, Rgb332, WIDTH};
use serde::Serialize;

use crate::rtl::Rtl;
use crate::stimulus::random::Random;
use crate::stimulus::shapes::triangle;

/// Longest that anything here may take, in clocks.
const PATIENCE: u64 = 20_000_000;
/// Random triangles of each size.
const TRIANGLES: usize = 2000;
/// Full screens, each nearer than the last.
const LAYERS: i32 = 10;

/// Which way a figure is better.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Better {
    /// More is better: the bar is a least value.
    Higher,
    /// Less is better: the bar is a largest value.
    Lower,
}

/// One figure.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Figure {
    /// What was measured, like `rtl.n8.clear_clocks`.
    pub name: String,
    /// How much it is.
    pub value: f64,
    /// Of what.
    pub unit: &'static str,
    /// What it may not be worse than, if there is such a bar.
    pub bar: Option<f64>,
    /// Which way it is better.
    pub better: Better,
}

impl Figure {
    /// Returns whether it reaches its bar; without one it does.
    pub fn holds(&self) -> bool {
        self.bar.is_none_or(|bar| match self.better {
            Better::Higher => self.value >= bar,
            Better::Lower => self.value <= bar,
        })
    }
}

/// What a number of pixel units may not be worse than.
struct Bars {
    full_screen_pixels_per_clock: f64,
    clocks_per_50px_triangle: f64,
    clocks_per_10px_triangle: f64,
    clocks_per_50px_gouraud_triangle: f64,
    clocks_per_10px_gouraud_triangle: f64,
    clear_clocks: f64,
}

/// Returns the bars. Those of 4 and 8 units for flat triangles, full screens and clears are the project's, set before
/// the design was; all others are what the design reaches, with 5 % of room at most.
fn bars(units: u32) -> Bars {
    let (full_screen_pixels_per_clock, flat, gouraud, clear_clocks) = match units {
        1 => (0.97, [56.5, 13.3], [56.5, 17.8], 77_000.0),
        2 => (1.9, [35.5, 11.5], [35.5, 17.8], 38_500.0),
        4 => (3.6, [30.0, 16.0], [21.0, 17.8], 19_300.0),
        _ => (7.0, [22.0, 14.0], [17.8, 17.8], 9_700.0),
    };
    Bars {
        full_screen_pixels_per_clock,
        clocks_per_50px_triangle: flat[0],
        clocks_per_10px_triangle: flat[1],
        clocks_per_50px_gouraud_triangle: gouraud[0],
        clocks_per_10px_gouraud_triangle: gouraud[1],
        clear_clocks,
    }
}

/// Measures the device with `units` pixel units, one of [`UNITS`](crate::UNITS).
///
/// # Panics
/// For any other number, and when the device does not come to rest.
pub fn measure(units: u32) -> Vec<Figure> {
    let bars = bars(units);
    let mut rtl = Rtl::new(units);
    rtl.write(Register::Control, Control::default().with_enable(true).0);
    let clear = clocks_for(&mut rtl, &Clear { colour: Rgb332::BLACK, depth: DEPTH_FAR }.encode());
    let full_screen = full_screen_pixels_per_clock(&mut rtl, flat);
    let full_screen_gouraud = full_screen_pixels_per_clock(&mut rtl, gouraud);
    let [clocks_50, tiles_50] = per_triangle(&mut rtl, 50, flat);
    let [clocks_10, tiles_10] = per_triangle(&mut rtl, 10, flat);
    let [clocks_50_gouraud, _] = per_triangle(&mut rtl, 50, gouraud);
    let [clocks_10_gouraud, _] = per_triangle(&mut rtl, 10, gouraud);
    let figure = |name, value: f64, unit, better, bar| {
        // Thousandths tell enough.
        let value = (value * 1000.0).round() / 1000.0;
        Figure { name: format!("rtl.n{units}.{name}"), value, unit, bar, better }
    };
    let lower = |name, value, unit, bar| figure(name, value, unit, Better::Lower, bar);
    vec![
        figure(
            "full_screen_pixels_per_clock",
            full_screen,
            "pixels/clock",
            Better::Higher,
            Some(bars.full_screen_pixels_per_clock),
        ),
        figure(
            "full_screen_gouraud_pixels_per_clock",
            full_screen_gouraud,
            "pixels/clock",
            Better::Higher,
            Some(bars.full_screen_pixels_per_clock),
        ),
        lower("clocks_per_50px_triangle", clocks_50, "clocks", Some(bars.clocks_per_50px_triangle)),
        lower("tiles_per_50px_triangle", tiles_50, "tiles", None),
        lower("clocks_per_10px_triangle", clocks_10, "clocks", Some(bars.clocks_per_10px_triangle)),
        lower("tiles_per_10px_triangle", tiles_10, "tiles", None),
        lower(
            "clocks_per_50px_gouraud_triangle",
            clocks_50_gouraud,
            "clocks",
            Some(bars.clocks_per_50px_gouraud_triangle),
        ),
        lower(
            "clocks_per_10px_gouraud_triangle",
            clocks_10_gouraud,
            "clocks",
            Some(bars.clocks_per_10px_gouraud_triangle),
        ),
        lower("clear_clocks", clear as f64, "clocks", Some(bars.clear_clocks)),
    ]
}

/// Returns how many clocks pass from the first word until the device is at rest.
fn clocks_for(rtl: &mut Rtl, words: &[u32]) -> u64 {
    let start = rtl.clocks();
    rtl.push(words);
    rtl.rest(PATIENCE);
    rtl.clocks() - start
}

/// Draws layers of two triangles that share the screen's diagonal, each nearer than the last.
fn full_screen_pixels_per_clock(rtl: &mut Rtl, packet: fn(FlatTriangle) -> Vec<u32>) -> f64 {
    rtl.push(&Clear { colour: Rgb332::BLACK, depth: DEPTH_FAR }.encode());
    rtl.rest(PATIENCE);
    let (right, bottom) = (WIDTH as i32 * 16, HEIGHT as i32 * 16);
    let mut words = Vec::new();
    for layer in 0..LAYERS {
        let depth = 60_000 - layer * 1000;
        let corners = [[0, 0, depth], [right, 0, depth], [right, bottom, depth], [0, bottom, depth]];
        for vertices in [[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]] {
            words.extend(packet(triangle(vertices, layer as u8, false).expect("on the screen")));
        }
    }
    let before = rtl.read(Register::PixelsWritten);
    let clocks = clocks_for(rtl, &words);
    let written = rtl.read(Register::PixelsWritten).wrapping_sub(before);
    assert_eq!(written as usize, LAYERS as usize * PIXELS, "every pixel of every layer is nearer");
    f64::from(written) / clocks as f64
}

/// Returns clocks and visited tiles for a triangle of `pixels` pixels of area.
fn per_triangle(rtl: &mut Rtl, pixels: i32, packet: fn(FlatTriangle) -> Vec<u32>) -> [f64; 2] {
    let words: Vec<u32> = sized_triangles(pixels, TRIANGLES).into_iter().flat_map(packet).collect();
    let tiles = rtl.tiles();
    let clocks = clocks_for(rtl, &words);
    [clocks, rtl.tiles() - tiles].map(|sum| sum as f64 / TRIANGLES as f64)
}

fn flat(triangle: FlatTriangle) -> Vec<u32> {
    triangle.encode().to_vec()
}

/// A triangle of the same shape whose colour changes.
fn gouraud(FlatTriangle { mode, shape, .. }: FlatTriangle) -> Vec<u32> {
    let channels = |step: i32| Channels([step; 3]);
    let triangle = GouraudTriangle {
        colour: channels(128 << COLOUR_FRACTION_BITS),
        colour_step_x: channels(700),
        colour_step_y: channels(-500),
        mode,
        shape,
    };
    triangle.encode().to_vec()
}

/// Returns `count` triangles of `pixels` pixels of area, of random orientation.
fn sized_triangles(pixels: i32, count: usize) -> Vec<FlatTriangle> {
    let mut random = Random::new(pixels as u64);
    let mut triangles = Vec::new();
    // Twice the area in square sixteenths, within 2 %.
    let goal = 2 * pixels * 256;
    let reach = 16 * 3 * (f64::from(pixels)).sqrt() as i32 / 2;
    while triangles.len() < count {
        let (x, y) = (random.within(800, 4300), random.within(800, 3000));
        let mut vertex =
            || [x + random.within(-reach, reach), y + random.within(-reach, reach), random.within(0, 65535)];
        let v = [vertex(), vertex(), vertex()];
        let area = (v[1][0] - v[0][0]) * (v[2][1] - v[0][1]) - (v[2][0] - v[0][0]) * (v[1][1] - v[0][1]);
        if (area.abs() - goal).abs() > goal / 50 {
            continue;
        }
        triangles.extend(triangle(v, 0xe0, false));
    }
    triangles
}
