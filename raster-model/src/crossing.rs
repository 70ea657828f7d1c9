//! Where an edge function changes sign along a row.

/// Walks the border of one edge's half-plane down the rows of a box.
///
/// In every row of the box an edge function that does not wrap is ≥ 0 in the columns from some
/// column on (step in x ≥ 0) or up to some column (step in x < 0). The second case becomes the
/// first by complementing: `!value ≥ 0` exactly where `value < 0`, and the steps change sign.
/// From row to row the border moves one way only, so the walk takes at most about
/// 2 · columns + rows steps for a whole triangle, each an addition and a comparison.
pub(crate) struct Crossing {
    /// The first column with `value` ≥ 0, or `columns` if there is none. Counted from the box's left.
    column: usize,
    /// Columns of the box.
    columns: usize,
    /// The edge, complemented if `ends_row`, at `column` (which may be one right of the box).
    value: i32,
    /// Never negative.
    step_x: i32,
    step_y: i32,
    /// Whether the covered columns end at `column`, rather than begin there.
    ends_row: bool,
}

impl Crossing {
    /// Returns the border in the first row of a box of `columns` columns.
    ///
    /// `value` is the edge at the box's upper left pixel. It must not wrap anywhere in the box,
    /// nor in the column right of it.
    #[inline]
    pub(crate) fn new(value: i32, (step_x, step_y): (i32, i32), columns: usize) -> Self {
        let ends_row = step_x < 0;
        let (value, step_x, step_y) = if ends_row { (!value, -step_x, -step_y) } else { (value, step_x, step_y) };
        let mut crossing = Self { column: 0, columns, value, step_x, step_y, ends_row };
        crossing.walk_right();
        crossing
    }

    /// Goes on to the next row.
    #[inline(always)]
    pub(crate) fn next_row(&mut self) {
        self.value += self.step_y;
        if self.step_y < 0 {
            self.walk_right();
        } else {
            self.walk_left();
        }
    }

    /// Narrows the columns `first..end` to those that the edge covers in this row.
    #[inline(always)]
    pub(crate) fn narrow(&self, first: &mut usize, end: &mut usize) {
        if self.ends_row {
            *end = self.column.min(*end);
        } else {
            *first = self.column.max(*first);
        }
    }

    /// Walks to the border when it can only lie here or further right.
    #[inline(always)]
    fn walk_right(&mut self) {
        while self.value < 0 && self.column < self.columns {
            self.value += self.step_x;
            self.column += 1;
        }
    }

    /// Walks to the border when it can only lie here or further left.
    #[inline(always)]
    fn walk_left(&mut self) {
        while self.value >= self.step_x && self.column > 0 {
            self.value -= self.step_x;
            self.column -= 1;
        }
    }
}
