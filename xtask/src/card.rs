//! What goes on the DE1-SoC's SD card, and the whole card as one file.
//!
//! | module | its one idea |
//! | --- | --- |
//! | [`program`] | the firmware's ELF file as the bytes that U-Boot loads |
//! | [`script`] | what U-Boot does with them: `boot.scr` |
//! | [`uboot`] | whether a file is U-Boot for this board |
//! | [`layout`] | where what lies: the partition table and the card |
//! | [`fat`] | the file system |
//!
//! The same input gives the same bytes: no clock and no random number has a part in them.

pub mod fat;
pub mod layout;
pub mod program;
pub mod script;
pub mod uboot;

use std::path::Path;

use anyhow::{Context, bail, ensure};
use firmware::de1_soc::arguments::{self, Words};

use program::Program;

/// Name of the program on the card.
pub const PROGRAM_NAME: &str = "halfspace.bin";
/// Name of the FPGA's image on the card.
pub const FPGA_IMAGE_NAME: &str = "halfspace.rbf";
/// Name of the model's mesh file on the card.
pub const MESH_NAME: &str = "model.mesh";
/// Name of the file of what the program is told besides.
pub const OPTIONS_NAME: &str = "options.txt";
/// Name of U-Boot's script on the card.
pub const SCRIPT_NAME: &str = "boot.scr";

/// A file in the root folder of the card's file system.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CardFile {
    /// Its name.
    pub name: &'static str,
    /// What it holds.
    pub bytes: Vec<u8>,
}

/// What may be on a card besides.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Extras {
    /// The FPGA's image.
    pub fpga_image: Option<Vec<u8>>,
    /// A model as a mesh file.
    pub mesh: Option<Vec<u8>>,
    /// What the program is told besides, as [`parse_options`] found it right.
    pub options: Option<String>,
}

/// Returns the files that U-Boot wants, and what there is besides.
pub fn files(program: &Program, extras: Extras) -> Vec<CardFile> {
    let script = script::image(&script::text(program.address));
    let mut files = vec![
        CardFile { name: SCRIPT_NAME, bytes: script },
        CardFile { name: PROGRAM_NAME, bytes: program.bytes.clone() },
    ];
    files.extend(extras.fpga_image.map(|bytes| CardFile { name: FPGA_IMAGE_NAME, bytes }));
    files.extend(extras.mesh.map(|bytes| CardFile { name: MESH_NAME, bytes }));
    let line = |options| format!("options={options}\n").into_bytes();
    files.extend(extras.options.map(|options| CardFile { name: OPTIONS_NAME, bytes: line(options) }));
    files
}

/// Takes words for the program that the card's script does not find by itself, like `usb full`.
///
/// # Errors
/// What the program would say of them.
pub fn parse_options(text: &str) -> Result<String, String> {
    const FILES: [&str; 2] = ["rbf", "mesh"];
    let mut words = Words::new();
    for word in ["go"].into_iter().chain(text.split_whitespace()) {
        if FILES.contains(&word) {
            return Err(format!("`{word}` is the card's script's to say: use --rbf and --mesh"));
        }
        let taken = word.try_into().ok().and_then(|word| words.push(word).ok());
        taken.ok_or_else(|| format!("`{word}` is too long, or a word too many"))?;
    }
    arguments::asked(&words).map_err(|error| error.to_string())?;
    Ok(text.split_whitespace().collect::<Vec<_>>().join(" "))
}

/// Reads an FPGA image (.rbf).
///
/// # Errors
/// When it cannot be read, is no raw image, or does not fit where U-Boot loads it.
pub fn read_fpga_image(path: &Path) -> anyhow::Result<Vec<u8>> {
    let bytes = std::fs::read(path).with_context(|| {
        format!("cannot read the FPGA image {}: `make` in fpga/ writes build/halfspace.rbf", path.display())
    })?;
    check_fpga_image(&bytes).with_context(|| format!("{} is no FPGA image for the card", path.display()))?;
    Ok(bytes)
}

/// A raw image has no mark of its own; what is told is what it surely is not.
fn check_fpga_image(bytes: &[u8]) -> anyhow::Result<()> {
    const LARGEST: usize = (script::MESH - script::FPGA_IMAGE) as usize;
    const OTHERS: [(&[u8], &str); 4] = [
        (b"SOF", "a .sof, which is for JTAG"),
        (b"POF", "a .pof, which is for the configuration memory"),
        (b"\x7fELF", "a program"),
        (b"<", "a web page"),
    ];
    const REMEDY: &str = "give the halfspace.rbf that `make` in fpga/ leaves in fpga/build";
    if let Some((_, what)) = OTHERS.iter().find(|(start, _)| bytes.starts_with(start)) {
        bail!("it is {what}: {REMEDY}");
    }
    ensure!(!bytes.is_empty(), "it is empty: {REMEDY}");
    ensure!(bytes.len() <= LARGEST, "it has {} bytes, and U-Boot has room for {LARGEST}: {REMEDY}", bytes.len());
    Ok(())
}

/// Reads a mesh file that U-Boot shall load.
///
/// # Errors
/// When it cannot be read, or does not fit where U-Boot loads it.
pub fn read_mesh(path: &Path) -> anyhow::Result<Vec<u8>> {
    const LARGEST: usize = (script::FILES_END - script::MESH) as usize;
    let bytes = std::fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
    ensure!(
        bytes.len() <= LARGEST,
        "{} has {} bytes, and U-Boot has room for {LARGEST}: use a model of fewer triangles",
        path.display(),
        bytes.len()
    );
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_file_of_quartus_is_refused_by_name() {
        let refusal = |bytes: &[u8]| check_fpga_image(bytes).expect_err("no raw image").to_string();
        assert!(check_fpga_image(&[0xFF; 64]).is_ok());
        assert!(refusal(b"SOF\0\x01").contains("it is a .sof, which is for JTAG: give the halfspace.rbf"));
        assert!(refusal(b"").contains("it is empty"));
        assert!(refusal(b"\x7fELF\x01").contains("it is a program"));
        assert!(refusal(&vec![0xFF; (32 << 20) + 1]).contains("room for 33554432"));
    }

    #[test]
    fn options_are_what_the_program_takes() {
        assert_eq!(parse_options(" usb  full usb pulse").as_deref(), Ok("usb full usb pulse"));
        for (text, says) in [
            ("usb fast", "argument `usb` wants `full` or `pulse`"),
            ("turbo", "argument `turbo` means nothing"),
            ("rbf 8000000 100", "use --rbf and --mesh"),
            ("a-word-that-is-longer-than-any", "is too long"),
        ] {
            let error = parse_options(text).expect_err("refused");
            assert!(error.contains(says), "{error}");
        }
        let extras = Extras { options: Some("usb full".into()), ..Extras::default() };
        let program = Program { address: 0x0100_0000, bytes: vec![1, 2, 3, 4] };
        let files = files(&program, extras);
        assert_eq!(files[2], CardFile { name: "options.txt", bytes: b"options=usb full\n".to_vec() });
    }

    #[test]
    fn an_fpga_image_and_a_mesh_are_on_the_card_only_if_given() {
        let program = Program { address: 0x0100_0000, bytes: vec![1, 2, 3, 4] };
        let some = || Some(vec![0xFF; 8]);
        let names = |fpga_image, mesh| {
            let extras = Extras { fpga_image, mesh, options: None };
            files(&program, extras).iter().map(|file| file.name).collect::<Vec<_>>()
        };
        assert_eq!(names(None, None), ["boot.scr", "halfspace.bin"]);
        assert_eq!(names(some(), None), ["boot.scr", "halfspace.bin", "halfspace.rbf"]);
        assert_eq!(names(None, some()), ["boot.scr", "halfspace.bin", "model.mesh"]);
    }
}
