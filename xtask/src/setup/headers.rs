//! Whether a compiler finds a header.

use std::io::Write;
use std::process::{Command, Stdio};

use super::packages::find_program;
use anyhow::Context;

/// Asks `compiler` for a header of `language` (`c` or `c++`); no compiler finds none.
///
/// # Errors
/// When the compiler is there and cannot be run.
pub(super) fn has_header(compiler: &str, language: &str, name: &str) -> anyhow::Result<bool> {
    if find_program(compiler).is_none() {
        return Ok(false);
    }
    let mut child = Command::new(compiler)
        .args(["-E", "-x", language, "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .with_context(|| format!("cannot start {compiler}"))?;
    if let Some(mut input) = child.stdin.take() {
        // A compiler that does not read says so by its status.
        let _ = writeln!(input, "#include <{name}>");
    }
    Ok(child.wait().with_context(|| format!("cannot wait for {compiler}"))?.success())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_header_is_there_or_not() {
        let found = |compiler, name| has_header(compiler, "c", name).expect("it runs");
        assert!(found("cc", "stddef.h"));
        assert!(!found("cc", "no-such-header-of-halfspace.h"));
        assert!(!found("no-such-compiler-of-halfspace", "stddef.h"));
    }
}
