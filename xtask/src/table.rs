//! Text tables for a terminal: words to the left, numbers to the right.

use std::fmt;

/// One column: its heading and which way its cells lean.
#[derive(Clone, Debug)]
pub struct Column {
    heading: String,
    right: bool,
}

impl Column {
    /// Returns a column of words, aligned to the left.
    pub fn text(heading: impl Into<String>) -> Self {
        Self { heading: heading.into(), right: false }
    }

    /// Returns a column of numbers, aligned to the right.
    pub fn number(heading: impl Into<String>) -> Self {
        Self { heading: heading.into(), right: true }
    }
}

/// A table that [`Display`](fmt::Display) prints with a rule under the headings.
#[derive(Clone, Debug)]
pub struct Table {
    columns: Vec<Column>,
    rows: Vec<Vec<String>>,
}

impl Table {
    /// Returns an empty table.
    pub fn new(columns: impl IntoIterator<Item = Column>) -> Self {
        Self { columns: columns.into_iter().collect(), rows: Vec::new() }
    }

    /// Adds a row; cells that are missing stay empty.
    ///
    /// # Panics
    ///
    /// When there are more cells than columns: the caller's mistake, not an input's.
    pub fn row<Cell: Into<String>>(&mut self, cells: impl IntoIterator<Item = Cell>) -> &mut Self {
        let mut row: Vec<String> = cells.into_iter().map(Into::into).collect();
        assert!(row.len() <= self.columns.len(), "{} cells for {} columns", row.len(), self.columns.len());
        row.resize(self.columns.len(), String::new());
        self.rows.push(row);
        self
    }

    /// Returns each column's width in characters.
    fn widths(&self) -> Vec<usize> {
        let mut widths: Vec<usize> = self.columns.iter().map(|column| column.heading.chars().count()).collect();
        for row in &self.rows {
            for (width, cell) in widths.iter_mut().zip(row) {
                *width = (*width).max(cell.chars().count());
            }
        }
        widths
    }

    fn line<'a>(&self, widths: &[usize], cells: impl Iterator<Item = &'a str>) -> String {
        let mut line = String::new();
        for ((cell, width), column) in cells.zip(widths).zip(&self.columns) {
            let padded = if column.right { format!("{cell:>width$}  ") } else { format!("{cell:<width$}  ") };
            line.push_str(&padded);
        }
        line.trim_end().to_string()
    }
}

impl fmt::Display for Table {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let widths = self.widths();
        let headings = self.columns.iter().map(|column| column.heading.as_str());
        writeln!(formatter, "{}", self.line(&widths, headings))?;
        let rules: Vec<String> = widths.iter().map(|width| "─".repeat(*width)).collect();
        writeln!(formatter, "{}", self.line(&widths, rules.iter().map(String::as_str)))?;
        for row in &self.rows {
            writeln!(formatter, "{}", self.line(&widths, row.iter().map(String::as_str)))?;
        }
        Ok(())
    }
}

/// Returns `number` with a comma between thousands: `1,234,567`.
pub fn thousands(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::with_capacity(digits.len() + digits.len() / 3);
    for (position, digit) in digits.chars().enumerate() {
        if position > 0 && (digits.len() - position).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_lean_left_and_numbers_right() {
        let mut table = Table::new([Column::text("stage"), Column::number("words")]);
        table.row(["clear", "2"]).row(["triangles", "1,234"]).row(["–"]);
        let expected = "\
stage      words
─────────  ─────
clear          2
triangles  1,234
–
";
        assert_eq!(table.to_string(), expected);
    }

    #[test]
    fn a_table_without_rows_shows_its_headings() {
        assert_eq!(Table::new([Column::number("n")]).to_string(), "n\n─\n");
    }

    #[test]
    fn thousands_are_parted() {
        let numbers = [0, 999, 1_000, 12_345, 1_234_567, u64::MAX];
        let texts = numbers.map(thousands);
        assert_eq!(texts, ["0", "999", "1,000", "12,345", "1,234,567", "18,446,744,073,709,551,615"]);
    }
}
