//! What a person may want to set.

use crate::{LowPass, StickResponse};
use fixed::types::I16F16;

/// Sets how reports become a state. Every value is valid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    /// How strongly the accelerometer is smoothed. A quarter by default.
    pub low_pass: LowPass,
    /// The dead zone of the accelerometer, in counts (113 are 1 g). 4 by default, the fuzz that
    /// Linux `hid-sony.c` sets.
    ///
    /// Up to this many counts from level read as level; from twice as many on, readings count in
    /// full; between the two the reading rises twice as fast, so that it never jumps. A change that
    /// is no larger does not count as the pad having moved.
    pub tilt_dead_zone_counts: u8,
    /// How a stick's way becomes its effect. Progressive by default.
    pub stick_response: StickResponse,
    /// How far a held arrow key turns the tilt, in degrees a frame. 1.5 by default: level to 90° in
    /// a second at 60 frames a second. A negative rate turns the keys round.
    pub key_tilt_degrees_per_frame: I16F16,
}

impl Default for Config {
    fn default() -> Self {
        Self {
            low_pass: LowPass::Quarter,
            tilt_dead_zone_counts: 4,
            stick_response: StickResponse::Progressive,
            key_tilt_degrees_per_frame: const { I16F16::lit("1.5") },
        }
    }
}

#[cfg(feature = "defmt")]
impl defmt::Format for Config {
    fn format(&self, formatter: defmt::Formatter<'_>) {
        defmt::write!(
            formatter,
            "Config {{ {}, dead zone {} counts, {}, keys {}/65536 degree a frame }}",
            self.low_pass,
            self.tilt_dead_zone_counts,
            self.stick_response,
            self.key_tilt_degrees_per_frame.to_bits()
        );
    }
}
