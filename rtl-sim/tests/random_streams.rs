//! Random streams through the device and the model: every pixel, depth, counter and flag equal.

mod common;

use common::pair::Pair;
use common::random::Random;
use common::stream::random_stream;

/// Triangles for each number of pixel units, unless HALFSPACE_TRIANGLES says otherwise.
const TRIANGLES: u32 = 52_000;

fn streams(units: u32) {
    let triangles = std::env::var("HALFSPACE_TRIANGLES").map_or(TRIANGLES, |text| text.parse().expect("a number"));
    random_stream(&mut Pair::new(units), triangles, &mut Random::new(u64::from(units) * 7919));
}

#[test]
fn one_unit_equals_the_model() {
    streams(1);
}

#[test]
fn two_units_equal_the_model() {
    streams(2);
}

#[test]
fn four_units_equal_the_model() {
    streams(4);
}

#[test]
fn eight_units_equal_the_model() {
    streams(8);
}
