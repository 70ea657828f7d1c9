//! How many clocks work takes, held against the bars that the project has set.
//!
//! Clocks of a simulation repeat. `--nocapture` prints them by the names of `cargo xtask bench`.

use rtl_sim::{UNITS, bench};

#[test]
fn the_bars_are_reached() {
    for units in UNITS {
        for figure in bench::measure(units) {
            println!("{} {:.3} {}", figure.name, figure.value, figure.unit);
            assert!(figure.holds(), "{} is {}, the bar is {:?}", figure.name, figure.value, figure.bar);
        }
    }
}
