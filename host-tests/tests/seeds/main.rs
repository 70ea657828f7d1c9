//! What the five systems that the project grows out of computed, by their own formulas in floating point, against
//! what the firmware's scenes make.

mod plate;
mod polygons;
mod solids;
mod wireframe;

use controls::{Button, Buttons, Config, ControllerState, Controls, DualShock3Report};
use firmware::scene::stage::Stage;
use firmware::viewer::Viewer;
use geometry::Matrix;

/// A viewer, and the pad that moves it.
struct Player {
    viewer: Viewer,
    controls: Controls,
}

impl Player {
    fn new(viewer: Viewer) -> Self {
        Self { viewer, controls: Controls::new(Config::default()) }
    }

    /// Hands reports in that come between two frames, draws a frame, and returns it.
    fn frame(&mut self, reports: &[DualShock3Report]) -> Stage {
        for report in reports {
            self.controls.accept_dualshock3(&report.to_bytes()).expect("a good report");
        }
        let state: ControllerState = self.controls.state();
        self.viewer.update(&state);
        self.controls.end_frame();
        self.viewer.stage(&state)
    }
}

/// A level pad with buttons held.
fn holding(held: &[Button]) -> DualShock3Report {
    DualShock3Report { held: held.iter().copied().collect::<Buttons>(), ..DualShock3Report::default() }
}

/// A matrix in `f64`.
fn float(matrix: &Matrix) -> [[f64; 4]; 4] {
    matrix.rows.map(|row| row.map(|element| element.to_num::<f64>()))
}

/// The farthest that two matrices are apart in any element.
fn difference(one: &[[f64; 4]; 4], other: &[[f64; 4]; 4]) -> f64 {
    let pairs = one.as_flattened().iter().zip(other.as_flattened());
    pairs.map(|(one, other)| (one - other).abs()).fold(0.0, f64::max)
}
