//! The files that are written from one source and committed: the contract's reference page, its
//! SystemVerilog packages, the page of the USB core's rules, the plate that the firmware shows, and the
//! sessions.

mod board_package;
mod game;
mod plate;
mod reference_page;
mod rtl_package;
mod seeds;
mod session;
mod usb_rules;

use anyhow::Context;

use crate::paths::workspace_root;

/// A generated file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct GeneratedFile {
    /// Where it lies in the workspace.
    pub path: &'static str,
    /// What it should hold.
    pub text: String,
}

impl GeneratedFile {
    /// Returns whether the file on disk holds what it should.
    pub fn is_fresh(&self) -> bool {
        std::fs::read_to_string(workspace_root().join(self.path)).is_ok_and(|text| text == self.text)
    }

    /// Writes the file.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn write(&self) -> anyhow::Result<()> {
        let path = workspace_root().join(self.path);
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).with_context(|| format!("cannot make the folder of {}", self.path))?;
        }
        std::fs::write(&path, &self.text).with_context(|| format!("cannot write {}", self.path))
    }
}

/// Returns all generated files as they should be.
///
/// # Errors
/// When a file that they are made from cannot be read.
pub fn all() -> anyhow::Result<Vec<GeneratedFile>> {
    Ok(vec![
        GeneratedFile { path: "docs/registers.md", text: reference_page::text() },
        GeneratedFile { path: "rtl/halfspace_pkg.sv", text: rtl_package::text() },
        GeneratedFile { path: "fpga/board_io_pkg.sv", text: board_package::text() },
        GeneratedFile { path: "firmware/src/scene/plate.rs", text: plate::text()? },
        GeneratedFile { path: "docs/usb-rules.md", text: usb_rules::text() },
        GeneratedFile { path: crate::session::DEMO, text: session::text() },
        GeneratedFile { path: crate::session::SEEDS, text: seeds::text() },
        GeneratedFile { path: crate::session::GAME, text: game::text() },
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn generated_files_are_fresh() {
        for file in all().expect("the sources are there") {
            assert!(file.is_fresh(), "{} is stale: run `cargo xtask generate` and commit it", file.path);
        }
    }
}
