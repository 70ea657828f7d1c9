//! How long a frame would take on the board, and what bounds it: a model, from counted work.
//!
//! | part | counted | speed |
//! | --- | --- | --- |
//! | processor | instructions for each triangle drawn, the hidden ones' share among them | 800 MHz, [`INSTRUCTIONS_PER_CLOCK`] |
//! | bridge | packet words | 40 million a second, measured by others on this board (UviDTE-FPSoC/CycloneVSoC-time-measurements) |
//! | rasterizer | clocks for a triangle and for the clear, 8 pixel units, in Verilator | 50 MHz |
//! | vertical blank | a swap waits for it, and the next frame starts after it | 25.175 MHz, 800 × 525 clocks |
//!
//! One core computes and stores, so the times of processor and bridge add up: writes that the bridge
//! holds back hold the core back, and no overlap is counted on. The rasterizer works meanwhile. What
//! the application does once a frame (controls, matrices) is left out.

use anyhow::Context;
use fpga_regs::packet::{Clear, Fence, FlatTriangle, swap};

use crate::measure::Measurement;

/// Sizes of frame that are modelled, in triangles drawn, and the rasterizer's figure for them: 1,000 triangles
/// of 50 pixels fill two thirds of the screen, 5,000 of 10 as much, and 20,000 of 10 fill it 2.6 times.
pub const FRAMES: [(u32, &str); 3] = [
    (1_000, "rtl.n8.clocks_per_50px_triangle"),
    (5_000, "rtl.n8.clocks_per_10px_triangle"),
    (20_000, "rtl.n8.clocks_per_10px_triangle"),
];

/// What is assumed of the Cortex-A9, which nobody has measured with this program. It can begin two
/// instructions in a clock and does about one in code that stays in its caches; a long multiplication
/// takes its multiplier for two clocks, and 20,000 triangles' mesh is larger than the 512 KiB of the L2
/// cache, so that a part of its loads waits for the SDRAM. Half of one is the cautious guess.
pub const INSTRUCTIONS_PER_CLOCK: f64 = 0.5;
const PROCESSOR_HERTZ: f64 = 800e6;
const BRIDGE_WORDS_PER_SECOND: f64 = 40e6;
const RASTERIZER_HERTZ: f64 = 50e6;
/// Time from one vertical blank to the next, in milliseconds.
const VERTICAL_BLANK_MS: f64 = 800.0 * 525.0 / 25_175.0;

/// What was counted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Counts {
    /// Instructions for a triangle that is drawn.
    pub instructions: f64,
    /// Words of its packet.
    pub words: f64,
    /// Words of a frame besides.
    pub frame_words: f64,
    /// Rasterizer clocks for a triangle.
    pub clocks: f64,
    /// Rasterizer clocks for the clear.
    pub clear_clocks: f64,
}

/// What a frame waits for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Bound {
    /// The processor's instructions.
    Processor,
    /// The words' way to the FPGA.
    Bridge,
    /// The rasterizer.
    Rasterizer,
    /// The screen: all else is done before.
    VerticalBlank,
}

impl Bound {
    /// Returns its name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Processor => "CPU",
            Self::Bridge => "bridge",
            Self::Rasterizer => "raster",
            Self::VerticalBlank => "vertical blank",
        }
    }
}

/// A frame's times, in milliseconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrameTime {
    /// The processor's.
    pub processor: f64,
    /// The bridge's.
    pub bridge: f64,
    /// The rasterizer's.
    pub rasterizer: f64,
    /// From one swap to the next.
    pub frame: f64,
    /// What would have to be quicker for a shorter frame.
    pub bound: Bound,
}

impl FrameTime {
    /// Models a frame of `triangles` drawn.
    pub fn new(triangles: u32, counts: &Counts) -> Self {
        let triangles = f64::from(triangles);
        let processor = triangles * counts.instructions / INSTRUCTIONS_PER_CLOCK / PROCESSOR_HERTZ * 1e3;
        let bridge = (triangles * counts.words + counts.frame_words) / BRIDGE_WORDS_PER_SECOND * 1e3;
        let rasterizer = (triangles * counts.clocks + counts.clear_clocks) / RASTERIZER_HERTZ * 1e3;
        let producer = processor + bridge;
        let work = producer.max(rasterizer);
        let blanks = (work / VERTICAL_BLANK_MS).ceil().max(1.0);
        let bound = if blanks == 1.0 {
            Bound::VerticalBlank
        } else if rasterizer > producer {
            Bound::Rasterizer
        } else if bridge > processor {
            Bound::Bridge
        } else {
            Bound::Processor
        };
        Self { processor, bridge, rasterizer, frame: blanks * VERTICAL_BLANK_MS, bound }
    }
}

/// Models the frames of [`FRAMES`] with what `measured` says.
///
/// # Errors
/// When a figure is missing there.
pub fn frames(measured: &[Measurement]) -> anyhow::Result<Vec<Measurement>> {
    let value = |name: &str| {
        let found = measured.iter().find(|it| it.name == name);
        found.map(|it| it.value).with_context(|| format!("the frames' model wants {name}, which was not measured"))
    };
    let mut frames = Vec::new();
    for (triangles, clocks) in FRAMES {
        let counts = Counts {
            instructions: value("geometry.instructions_per_triangle")? / value("geometry.drawn_share")?,
            words: FlatTriangle::WORDS as f64,
            frame_words: (Clear::WORDS + swap().len() + Fence::WORDS) as f64,
            clocks: value(clocks)?,
            clear_clocks: value("rtl.n8.clear_clocks")?,
        };
        let time = FrameTime::new(triangles, &counts);
        let name = |what: &str| format!("frame.{triangles}_triangles_{what}");
        frames.extend([
            Measurement {
                note: Some(format!("bound by {}", time.bound.name())),
                ..Measurement::new(&name("ms"), time.frame, "ms")
            },
            Measurement {
                note: Some(format!("at {INSTRUCTIONS_PER_CLOCK} instructions a clock")),
                ..Measurement::new(&name("cpu_ms"), time.processor, "ms")
            },
            Measurement::new(&name("bridge_ms"), time.bridge, "ms"),
            Measurement::new(&name("raster_ms"), time.rasterizer, "ms"),
        ]);
    }
    Ok(frames)
}

#[cfg(test)]
mod tests {
    use super::*;

    const COUNTS: Counts =
        Counts { instructions: 400.0, words: 11.0, frame_words: 5.0, clocks: 12.0, clear_clocks: 10_000.0 };

    fn is_near(found: f64, wanted: f64) -> bool {
        (found - wanted).abs() < 1e-6
    }

    /// Worked by hand: 400 instructions are 800 clocks of 1.25 ns, a microsecond; 11 words at 25 ns are
    /// 275 ns; 12 clocks at 20 ns are 240 ns. 420,000 clocks of 25.175 MHz are 16.683217 ms.
    #[test]
    fn a_triangle_s_times_add_up_and_the_screen_is_waited_for() {
        let time = FrameTime::new(1_000, &COUNTS);
        assert!(is_near(time.processor, 1.0), "{time:?}");
        assert!(is_near(time.bridge, 0.275_125), "{time:?}");
        assert!(is_near(time.rasterizer, 0.44), "{time:?}");
        assert!((time.frame - 16.683_217).abs() < 1e-5, "{time:?}");
        assert_eq!(time.bound, Bound::VerticalBlank);
    }

    /// 13,000 triangles: 13 ms and 3.575125 ms are 16.575125 ms, just in time; 13,100 take 16.702625 ms, too late.
    #[test]
    fn a_frame_that_misses_a_blank_takes_two() {
        assert_eq!(FrameTime::new(13_000, &COUNTS).bound, Bound::VerticalBlank);
        let late = FrameTime::new(13_100, &COUNTS);
        assert_eq!(late.bound, Bound::Processor);
        assert!((late.frame - 33.366_435).abs() < 1e-5, "{late:?}");
    }

    #[test]
    fn whatever_takes_longest_is_named() {
        let bound = |counts| FrameTime::new(20_000, &counts).bound;
        assert_eq!(bound(Counts { instructions: 100.0, words: 44.0, ..COUNTS }), Bound::Bridge);
        // 20,000 × 60 clocks of 20 ns are 24 ms, and all else takes 10.5 ms.
        assert_eq!(bound(Counts { instructions: 100.0, clocks: 60.0, ..COUNTS }), Bound::Rasterizer);
        assert_eq!(FrameTime::new(0, &COUNTS).bound, Bound::VerticalBlank);
    }

    #[test]
    fn figures_are_taken_by_name_and_a_missing_one_is_named() {
        let mut measured = vec![
            Measurement::new("geometry.instructions_per_triangle", 160.0, "instructions"),
            Measurement::new("geometry.drawn_share", 0.4, "of submitted"),
            Measurement::new("rtl.n8.clocks_per_50px_triangle", 14.0, "clocks"),
            Measurement::new("rtl.n8.clocks_per_10px_triangle", 11.0, "clocks"),
        ];
        let error = frames(&measured).expect_err("no clear").to_string();
        assert!(error.contains("rtl.n8.clear_clocks"), "{error}");
        measured.push(Measurement::new("rtl.n8.clear_clocks", 9_600.0, "clocks"));
        let frames = frames(&measured).expect("all is there");
        let value = |name: &str| frames.iter().find(|it| it.name == name).map(|it| it.value);
        // 160 / 0.4 = 400 instructions, a microsecond each triangle.
        assert_eq!(value("frame.20000_triangles_cpu_ms"), Some(20.0));
        assert_eq!(value("frame.20000_triangles_ms"), Some(33.37));
        assert_eq!(value("frame.1000_triangles_ms"), Some(16.68));
        // 5,000 × 11 clocks and 9,600 more, at 20 ns.
        assert_eq!(value("frame.5000_triangles_raster_ms"), Some(1.29));
    }
}
