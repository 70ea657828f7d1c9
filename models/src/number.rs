//! Numbers in text.

use crate::Problem;
use crate::error::quoted;

/// Returns a word's number.
pub(crate) fn number(word: &str) -> Result<f64, Problem> {
    match word.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        Ok(_) => Err(Problem::NotFinite { text: quoted(word) }),
        Err(_) => Err(Problem::NotANumber { text: quoted(word) }),
    }
}

/// Returns a number that a binary file or JSON gave.
pub(crate) fn finite(number: f64) -> Result<f64, Problem> {
    if number.is_finite() { Ok(number) } else { Err(Problem::NotFinite { text: number.to_string() }) }
}
