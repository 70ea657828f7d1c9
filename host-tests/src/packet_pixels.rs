//! Which pixels a packet covers and at which depth, by the formats' definition.
//!
//! Sums in 64 bits, each pixel from scratch: no steps that pile up and nothing of the model.

use fpga_regs::packet::TriangleShape;

/// Returns a triangle's three edge values at a pixel, not wrapped.
pub fn edges_at(shape: &TriangleShape, x: i32, y: i32) -> [i64; 3] {
    let right = i64::from(x) - i64::from(shape.columns.first());
    let down = i64::from(y) - i64::from(shape.rows.first());
    let steps = shape.steps.map(|steps| (i64::from(steps.step_x()), i64::from(steps.step_y())));
    let third = (-steps[0].0 - steps[1].0, -steps[0].1 - steps[1].1);
    let value =
        |index: usize, (step_x, step_y): (i64, i64)| i64::from(shape.edges[index]) + right * step_x + down * step_y;
    [value(0, steps[0]), value(1, steps[1]), value(2, third)]
}

/// Returns whether the packet covers a pixel of its box.
pub fn covers(shape: &TriangleShape, x: i32, y: i32) -> bool {
    let within = |first: u16, last: u16, value: i32| (i32::from(first)..=i32::from(last)).contains(&value);
    within(shape.columns.first(), shape.columns.last(), x)
        && within(shape.rows.first(), shape.rows.last(), y)
        && edges_at(shape, x, y).iter().all(|edge| *edge >= 0)
}

/// Returns the depth at a pixel, Q20.12 modulo 2³², as it comes out of the sum.
pub fn depth_at(shape: &TriangleShape, x: i32, y: i32) -> i32 {
    let right = i64::from(x) - i64::from(shape.columns.first());
    let down = i64::from(y) - i64::from(shape.rows.first());
    let [start, step_x, step_y] =
        [shape.depth, shape.depth_step_x, shape.depth_step_y].map(|depth| i64::from(depth.to_bits()));
    (start + right * step_x + down * step_y) as i32
}

/// Calls `each` with every pixel that the packet covers.
pub fn for_each(shape: &TriangleShape, mut each: impl FnMut(i32, i32)) {
    for y in shape.rows.first().into()..=i32::from(shape.rows.last()) {
        for x in shape.columns.first().into()..=i32::from(shape.columns.last()) {
            if covers(shape, x, y) {
                each(x, y);
            }
        }
    }
}
