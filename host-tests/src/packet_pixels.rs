//! Which pixels a packet covers and at which depth, by the formats' definition.
//!
//! Sums in 64 bits, each pixel from scratch: no steps that pile up and nothing of the model.

use fpga_regs::packet::FlatTriangle;

/// Returns a triangle's three edge values at a pixel, not wrapped.
pub fn edges_at(triangle: &FlatTriangle, x: i32, y: i32) -> [i64; 3] {
    let right = i64::from(x) - i64::from(triangle.columns.first());
    let down = i64::from(y) - i64::from(triangle.rows.first());
    let steps = triangle.steps.map(|steps| (i64::from(steps.step_x()), i64::from(steps.step_y())));
    let third = (-steps[0].0 - steps[1].0, -steps[0].1 - steps[1].1);
    let value =
        |index: usize, (step_x, step_y): (i64, i64)| i64::from(triangle.edges[index]) + right * step_x + down * step_y;
    [value(0, steps[0]), value(1, steps[1]), value(2, third)]
}

/// Returns whether the packet covers a pixel of its box.
pub fn covers(triangle: &FlatTriangle, x: i32, y: i32) -> bool {
    let within = |first: u16, last: u16, value: i32| (i32::from(first)..=i32::from(last)).contains(&value);
    within(triangle.columns.first(), triangle.columns.last(), x)
        && within(triangle.rows.first(), triangle.rows.last(), y)
        && edges_at(triangle, x, y).iter().all(|edge| *edge >= 0)
}

/// Returns the depth at a pixel, Q20.12 modulo 2³², as it comes out of the sum.
pub fn depth_at(triangle: &FlatTriangle, x: i32, y: i32) -> i32 {
    let right = i64::from(x) - i64::from(triangle.columns.first());
    let down = i64::from(y) - i64::from(triangle.rows.first());
    let [start, step_x, step_y] =
        [triangle.depth, triangle.depth_step_x, triangle.depth_step_y].map(|depth| i64::from(depth.to_bits()));
    (start + right * step_x + down * step_y) as i32
}

/// Calls `each` with every pixel that the packet covers.
pub fn for_each(triangle: &FlatTriangle, mut each: impl FnMut(i32, i32)) {
    for y in triangle.rows.first().into()..=i32::from(triangle.rows.last()) {
        for x in triangle.columns.first().into()..=i32::from(triangle.columns.last()) {
            if covers(triangle, x, y) {
                each(x, y);
            }
        }
    }
}
