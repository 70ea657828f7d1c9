//! Debian's source packages, without a change to the machine: apt is given a list of sources, and
//! folders for all it writes, of our own.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use anyhow::{Context, ensure};

use super::logged::Log;
use crate::progress::Step;

const LIMIT: Duration = Duration::from_secs(900);

/// A source package, unpacked and patched.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct SourcePackage {
    /// Where it lies.
    pub(super) folder: PathBuf,
    /// Its version.
    pub(super) version: String,
}

/// Fetches the newest version of `package` into `folder`, in place of what is there.
///
/// # Errors
/// When the machine has no list of sources, or they cannot be reached; with the end of what apt said.
pub(super) fn fetch(package: &str, folder: &Path, log: &Log, step: &Step) -> anyhow::Result<SourcePackage> {
    if folder.exists() {
        fs::remove_dir_all(folder).with_context(|| format!("cannot remove {}", folder.display()))?;
    }
    let apt_folder = folder.join("apt");
    for part in ["sources", "lists/partial", "cache/archives/partial"] {
        let part = apt_folder.join(part);
        fs::create_dir_all(&part).with_context(|| format!("cannot make {}", part.display()))?;
    }
    write_sources(&apt_folder.join("sources"))?;
    let apt_get = |words: &[&str]| {
        let mut command = Command::new("apt-get");
        command.current_dir(folder).env("LC_ALL", "C").args(words);
        for (setting, path) in
            [("Dir::Etc::SourceParts", "sources"), ("Dir::State::Lists", "lists"), ("Dir::Cache", "cache")]
        {
            command.arg("-o").arg(format!("{setting}={}", apt_folder.join(path).display()));
        }
        // The unprivileged user that apt downloads as may not get into our folders.
        for setting in [
            "Dir::Etc::SourceList=/dev/null",
            "APT::Sandbox::User=root",
            "Acquire::Languages=none",
            "Acquire::Retries=3",
        ] {
            command.args(["-o", setting]);
        }
        log.run(command, step, LIMIT)
    };
    apt_get(&["update"])?;
    apt_get(&["source", "--download-only", package])?;
    let description = description_in(folder, package)?;
    let source = folder.join("source");
    let mut unpack = Command::new("dpkg-source");
    // apt has checked the signatures.
    unpack.current_dir(folder).args(["--no-check", "--extract"]).arg(&description).arg(&source);
    log.run(unpack, step, LIMIT)?;
    fs::remove_dir_all(&apt_folder).with_context(|| format!("cannot remove {}", apt_folder.display()))?;
    let stem = description.file_stem().unwrap_or_default().to_string_lossy();
    let version = stem.split_once('_').map_or("of unknown version", |(_, version)| version).to_string();
    Ok(SourcePackage { folder: source, version })
}

/// Returns the package's description (.dsc).
fn description_in(folder: &Path, package: &str) -> anyhow::Result<PathBuf> {
    let entries = fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))?;
    let mut files = entries.flatten().map(|entry| entry.path());
    files
        .find(|path| path.extension().is_some_and(|extension| extension == "dsc"))
        .with_context(|| format!("apt-get has downloaded nothing for the source package {package}"))
}

/// Writes the machine's own lists of sources into `folder`, with source packages instead of programs.
fn write_sources(folder: &Path) -> anyhow::Result<()> {
    let output = Command::new("apt-get")
        .args(["indextargets", "--format", "$(SOURCESENTRY)", "Created-By: Packages"])
        .output()
        .context("cannot start apt-get")?;
    // A line is a file's path, a colon and a line number.
    let entries = String::from_utf8_lossy(&output.stdout).into_owned();
    let files: BTreeSet<&str> = entries.lines().filter_map(|line| Some(line.rsplit_once(':')?.0)).collect();
    ensure!(!files.is_empty(), "apt has no list of sources: see /etc/apt/sources.list.d");
    for (number, file) in files.iter().enumerate() {
        let text = fs::read_to_string(file).with_context(|| format!("cannot read {file}"))?;
        let kind = if file.ends_with(".sources") { "sources" } else { "list" };
        let path = folder.join(format!("{number}.{kind}"));
        fs::write(&path, source_list(&text)).with_context(|| format!("cannot write {}", path.display()))?;
    }
    Ok(())
}

/// Turns a list of sources, in either of its two formats, into one of source packages.
fn source_list(text: &str) -> String {
    let mut list = String::new();
    for line in text.lines() {
        let word = line.split_whitespace().next().unwrap_or_default();
        match word {
            "Types:" => list.push_str("Types: deb-src"),
            // A disc that is not in its drive.
            "deb" if line.contains("cdrom:") => continue,
            "deb" => list.push_str(&line.replacen("deb", "deb-src", 1)),
            // It is there already for the programs of the same place.
            "deb-src" => continue,
            _ => list.push_str(line),
        }
        list.push('\n');
    }
    list
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_formats_of_a_list_of_sources_become_source_packages() {
        let lines = "# main\ndeb [signed-by=/k.gpg] http://h/debian stable main\ndeb-src http://h/debian stable main\n\
                     deb cdrom:[Debian]/ stable main\n";
        assert_eq!(source_list(lines), "# main\ndeb-src [signed-by=/k.gpg] http://h/debian stable main\n");
        let blocks = "Types: deb deb-src\nURIs: http://h/deb\nSuites: stable\n\nTypes: deb\nURIs: http://i/\n";
        let wanted = "Types: deb-src\nURIs: http://h/deb\nSuites: stable\n\nTypes: deb-src\nURIs: http://i/\n";
        assert_eq!(source_list(blocks), wanted);
    }
}
