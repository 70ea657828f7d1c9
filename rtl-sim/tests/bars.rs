//! How many clocks work takes, held against the bars that the project has set.
//!
//! Clocks of a simulation repeat. `--nocapture` prints them by the names of `cargo xtask bench`.

mod common;

use common::random::Random;
use common::shapes::triangle;
use fpga_regs::Port;
use fpga_regs::packet::Clear;
use fpga_regs::registers::{Control, Register};
use fpga_regs::screen::Rgb332;
use rtl_sim::{Rtl, UNITS};

fn clocks_for(rtl: &mut Rtl, words: &[u32]) -> u64 {
    let start = rtl.clocks();
    rtl.push(words);
    rtl.rest(20_000_000);
    rtl.clocks() - start
}

/// Returns the packets of `count` triangles of `pixels` pixels of area, of random orientation.
fn sized_triangles(pixels: i32, count: usize) -> Vec<u32> {
    let mut random = Random::new(pixels as u64);
    let mut words = Vec::new();
    // Twice the area in square sixteenths, within 2 %.
    let goal = 2 * pixels * 256;
    let reach = 16 * 3 * (f64::from(pixels)).sqrt() as i32 / 2;
    while words.len() < count * 11 {
        let (x, y) = (random.within(800, 4300), random.within(800, 3000));
        let mut vertex =
            || [x + random.within(-reach, reach), y + random.within(-reach, reach), random.within(0, 65535)];
        let v = [vertex(), vertex(), vertex()];
        let area = (v[1][0] - v[0][0]) * (v[2][1] - v[0][1]) - (v[2][0] - v[0][0]) * (v[1][1] - v[0][1]);
        if (area.abs() - goal).abs() > goal / 50 {
            continue;
        }
        words.extend(triangle(v, 0xe0, false).into_iter().flat_map(|triangle| triangle.encode()));
    }
    words
}

#[test]
fn the_bars_are_reached() {
    // Units; pixels a clock; clocks of a 50-pixel and of a 10-pixel triangle, of a clear. The issue
    // sets no bars for 1 and 2 units: these are what the design reached, with a little room.
    let bars = [
        (1, 0.97, 80.0, 22.0, 77_000),
        (2, 1.9, 50.0, 16.0, 38_500),
        (4, 3.6, 30.0, 16.0, 19_300),
        (8, 7.0, 22.0, 14.0, 9_700),
    ];
    for (units, bar_fill, bar_50, bar_10, bar_clear) in bars {
        assert!(UNITS.contains(&units));
        let mut rtl = Rtl::new(units);
        rtl.write(Register::Control, Control::default().with_enable(true).0);
        let clear = Clear { colour: Rgb332(0), depth: 0xffff }.encode();
        let clear_clocks = clocks_for(&mut rtl, &clear);

        // Ten layers of two triangles that share the screen's diagonal, each nearer than the last.
        let (right, bottom) = (320 * 16, 240 * 16);
        let mut words = Vec::new();
        for layer in 0..10 {
            let depth = 60_000 - layer * 1000;
            let corners = [[0, 0, depth], [right, 0, depth], [right, bottom, depth], [0, bottom, depth]];
            for vertices in [[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]] {
                words.extend(triangle(vertices, layer as u8, false).expect("on the screen").encode());
            }
        }
        let written = rtl.read(Register::PixelsWritten);
        let clocks = clocks_for(&mut rtl, &words);
        let written = rtl.read(Register::PixelsWritten).wrapping_sub(written);
        assert_eq!(written, 10 * 320 * 240);
        let fill = f64::from(written) / clocks as f64;

        let mut per_triangle = |pixels| {
            let words = sized_triangles(pixels, 2000);
            let (tiles, tested) = (rtl.tiles(), rtl.read(Register::PixelsTested));
            let clocks = clocks_for(&mut rtl, &words) as f64 / 2000.0;
            let tested = f64::from(rtl.read(Register::PixelsTested) - tested) / 2000.0;
            (clocks, (rtl.tiles() - tiles) as f64 / 2000.0, tested)
        };
        let (clocks_50, tiles_50, tested_50) = per_triangle(50);
        let (clocks_10, tiles_10, tested_10) = per_triangle(10);
        println!("rtl.n{units}.full_screen_pixels_per_clock {fill:.3}");
        println!("rtl.n{units}.clocks_per_50px_triangle {clocks_50:.2}   ({tiles_50:.2} tiles, {tested_50:.1} pixels)");
        println!("rtl.n{units}.clocks_per_10px_triangle {clocks_10:.2}   ({tiles_10:.2} tiles, {tested_10:.1} pixels)");
        println!("rtl.n{units}.clear_clocks {clear_clocks}");
        assert!(fill >= bar_fill, "{units} units fill {fill} pixels a clock, the bar is {bar_fill}");
        assert!(clocks_50 <= bar_50, "{units} units: {clocks_50} clocks for 50 pixels, the bar is {bar_50}");
        assert!(clocks_10 <= bar_10, "{units} units: {clocks_10} clocks for 10 pixels, the bar is {bar_10}");
        assert!(clear_clocks <= bar_clear, "{units} units: {clear_clocks} clocks for a clear, the bar is {bar_clear}");
    }
}
