//! Where the workspace is, and where xtask puts what it makes.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::{env, fs, io, process};

/// Returns the folder of the workspace's `Cargo.toml`.
///
/// Under `cargo xtask` cargo says where the crate is; a binary that is started by hand
/// falls back on the place it was built from.
pub fn workspace_root() -> PathBuf {
    let crate_folder = env::var_os("CARGO_MANIFEST_DIR")
        .map(PathBuf::from)
        .filter(|folder| folder.ends_with("xtask"))
        .unwrap_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")));
    match crate_folder.parent() {
        Some(root) => root.to_path_buf(),
        None => crate_folder,
    }
}

/// Returns the folder for everything that is built: `CARGO_TARGET_DIR`, or `target` in the workspace.
pub fn target_folder() -> PathBuf {
    match env::var_os("CARGO_TARGET_DIR") {
        Some(folder) if !folder.is_empty() => workspace_root().join(folder),
        _ => workspace_root().join("target"),
    }
}

/// Returns `path` as a person would type it: relative to the current folder where it lies below it.
pub fn for_display(path: &Path) -> &Path {
    match env::current_dir() {
        Ok(current) => path.strip_prefix(&current).unwrap_or(path),
        Err(_) => path,
    }
}

/// A folder in the system's temporary folder that goes, with all in it, when this value goes.
///
/// Its path is short: a Unix socket's path has at most 104 bytes on macOS.
#[derive(Debug)]
pub struct TemporaryFolder(PathBuf);

impl TemporaryFolder {
    /// Makes a folder that nobody else has.
    ///
    /// # Errors
    ///
    /// When the system's temporary folder takes no folders.
    pub fn new() -> io::Result<Self> {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        loop {
            let number = COUNT.fetch_add(1, Ordering::Relaxed);
            let path = env::temp_dir().join(format!("halfspace-{}-{number}", process::id()));
            match fs::create_dir(&path) {
                Ok(()) => return Ok(Self(path)),
                // Left by an earlier process of the same number that was killed.
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
    }

    /// Returns where the folder is.
    pub fn path(&self) -> &Path {
        &self.0
    }
}

impl Drop for TemporaryFolder {
    fn drop(&mut self) {
        // Nothing is lost when it stays: the system clears its temporary folder.
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_workspace_root_holds_this_crate() {
        assert!(workspace_root().join("xtask/src/paths.rs").is_file());
    }

    #[test]
    fn temporary_folders_differ_and_go() {
        let folders = [(); 2].map(|()| TemporaryFolder::new().expect("folders can be made"));
        let paths = folders.each_ref().map(|folder| folder.path().to_path_buf());
        assert!(paths[0] != paths[1] && paths.iter().all(|path| path.is_dir()));
        drop(folders);
        assert!(paths.iter().all(|path| !path.exists()));
    }

    #[test]
    fn a_path_below_the_current_folder_is_shown_short() {
        let current = env::current_dir().expect("tests run in a folder");
        assert_eq!(for_display(&current.join("a/b")), Path::new("a/b"));
        assert_eq!(for_display(Path::new("/elsewhere/b")), Path::new("/elsewhere/b"));
    }
}
