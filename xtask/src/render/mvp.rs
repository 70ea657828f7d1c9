//! Reads a model-view-projection matrix from a file.

use std::path::Path;

use anyhow::{Context, bail};

use super::camera::Matrix64;

const REMEDY: &str = "give 16 finite numbers, row by row, with spaces or commas between";

/// Reads the matrix in the file at `path`.
///
/// # Errors
/// When the file cannot be read or holds no matrix; the error names the number that is wrong.
pub fn read(path: &Path) -> anyhow::Result<Matrix64> {
    let text = std::fs::read_to_string(path).with_context(|| format!("cannot read the matrix {}", path.display()))?;
    parse(&text).with_context(|| format!("in the matrix {}", path.display()))
}

/// Parses 16 numbers, row by row; white space and commas part them, `#` starts a comment.
fn parse(text: &str) -> anyhow::Result<Matrix64> {
    let mut matrix = [[0.0; 4]; 4];
    let mut count = 0;
    for (index, line) in text.lines().enumerate() {
        let line = line.split('#').next().unwrap_or_default();
        for word in line.split(|letter: char| letter.is_whitespace() || letter == ',').filter(|word| !word.is_empty()) {
            let at = || format!("line {}, number {}", index + 1, count + 1);
            let number: f64 = match word.parse() {
                Ok(number) => number,
                Err(_) => bail!("{}: `{}` is no number: {REMEDY}", at(), word.escape_debug()),
            };
            if !number.is_finite() {
                bail!("{}: `{word}` is not finite: {REMEDY}", at());
            }
            if let Some(slot) = matrix.as_flattened_mut().get_mut(count) {
                *slot = number;
            }
            count += 1;
        }
    }
    if count != 16 {
        bail!("{count} numbers instead of 16: {REMEDY}");
    }
    Ok(matrix)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spaces_lines_and_commas_part_numbers() {
        let expected =
            [[1.0, 2.0, 3.0, 4.0], [5.0, 6.0, 7.0, 8.0], [9.0, 10.0, 11.0, 12.0], [13.0, 14.0, 15.0, -1.6e1]];
        for text in [
            "1 2 3 4\n5 6 7 8\n9 10 11 12\n13 14 15 -1.6e1\n",
            "# by rows\n1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,-16",
            "1, 2, 3, 4,\r\n5, 6, 7, 8,\r\n9\t10 11 12\r\n13 14 15 -16 # the end",
        ] {
            assert_eq!(parse(text).expect(text), expected);
        }
    }

    #[test]
    fn what_is_no_matrix_is_named() {
        let fifteen = "1 ".repeat(15);
        for (text, expected) in [
            (fifteen.clone(), "15 numbers instead of 16"),
            (format!("{fifteen}1 1"), "17 numbers instead of 16"),
            (String::new(), "0 numbers instead of 16"),
            (format!("{fifteen}\nNaN"), "line 2, number 16: `NaN` is not finite"),
            (format!("{fifteen}1e999"), "line 1, number 16: `1e999` is not finite"),
            ("1 2 x".to_string(), "line 1, number 3: `x` is no number"),
        ] {
            let message = parse(&text).expect_err(&text).to_string();
            assert!(message.starts_with(expected), "{message}");
        }
    }
}
