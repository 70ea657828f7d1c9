//! Prints how many clocks work takes, a line of JSON for each figure. `cargo xtask bench` starts it.

use rtl_sim::{UNITS, bench};

fn main() {
    for figure in UNITS.into_iter().flat_map(bench::measure) {
        println!("{}", serde_json::to_string(&figure).expect("a figure is plain data"));
    }
}
