//! `cargo xtask image`: what goes on the DE1-SoC's SD card.

use std::fs;
use std::path::Path;

use anyhow::Context;

use crate::card::layout::card;
use crate::card::program::{BYTES_MAX, Program};
use crate::card::uboot::UBoot;
use crate::card::{
    CardFile, Extras, FPGA_IMAGE_NAME, MESH_NAME, OPTIONS_NAME, PROGRAM_NAME, SCRIPT_NAME, files, read_fpga_image,
    read_mesh, script,
};
use crate::cli::{Board, ImageArguments};
use crate::firmware_build::build_firmware;
use crate::model::mesh_file;
use crate::paths::{for_display, target_folder};
use crate::progress::Progress;
use crate::setup::{ensure_firmware_toolchain, ensure_uboot};
use crate::table::{Column, Table, thousands};

/// Folder of what is copied onto a card that starts already.
pub const CARD_FOLDER: &str = "card";
/// The whole card.
pub const CARD_IMAGE: &str = "halfspace-sd.img";
/// U-Boot with its preloader.
pub const UBOOT_NAME: &str = "u-boot-with-spl.sfp";
/// The script's text.
pub const SCRIPT_TEXT: &str = "boot.cmd";

/// Builds the firmware and U-Boot, and puts both on a card.
///
/// # Errors
///
/// When an input is not what it should be, the firmware or U-Boot does not build, or the output cannot be
/// written. Without U-Boot there is no card image, but all the rest is there.
pub fn run(arguments: &ImageArguments) -> anyhow::Result<()> {
    let progress = Progress::new();
    // What is given is looked at before minutes go into building.
    let fpga_image = arguments.rbf.as_deref().map(read_fpga_image).transpose()?;
    let given = arguments.uboot.as_deref().map(UBoot::read).transpose()?;
    let output = arguments.output.clone().unwrap_or_else(|| target_folder().join("de1-soc"));
    let mesh = arguments.mesh.as_deref().map(|path| read_mesh(&mesh_file(path, &output)?)).transpose()?;

    let toolchain = ensure_firmware_toolchain(&progress)?;
    let elf = build_firmware(Board::De1Soc, &[], &toolchain, &progress)?;
    let program = Program::read(&elf)?;
    let files = files(&program, Extras { fpga_image, mesh, options: arguments.options.clone() });
    write_files(&output, &program, &files)?;
    let (uboot, origin) = match given {
        Some(uboot) => (uboot, "as given".to_string()),
        None => {
            let built = ensure_uboot(&progress).with_context(|| {
                let card = output.join(CARD_FOLDER);
                format!(
                    "there is no card image; what a card that starts already needs is in {}",
                    for_display(&card).display()
                )
            })?;
            (UBoot::read(&built.image)?, format!("version {}", built.version))
        }
    };
    write_card(&output, &files, &uboot)?;
    print!("{}", summary(&files, &uboot, &origin));
    if files.iter().all(|file| file.name != FPGA_IMAGE_NAME) {
        println!("No FPGA image is on the card: give it with --rbf fpga/build/halfspace.rbf, or load it over JTAG.");
    }
    println!("{} goes onto a card as README §Flash says.", for_display(&output.join(CARD_IMAGE)).display());
    Ok(())
}

/// Writes the program, the script, and the folder of what is copied.
///
/// # Errors
/// When something cannot be written.
pub fn write_files(output: &Path, program: &Program, files: &[CardFile]) -> anyhow::Result<()> {
    let folder = output.join(CARD_FOLDER);
    fs::create_dir_all(&folder).with_context(|| format!("cannot make the folder {}", folder.display()))?;
    // An older run's would go onto a card with this one's files.
    for name in [PROGRAM_NAME, SCRIPT_NAME, FPGA_IMAGE_NAME, MESH_NAME, OPTIONS_NAME] {
        remove(&folder.join(name))?;
    }
    remove(&output.join(CARD_IMAGE))?;
    write(&output.join(PROGRAM_NAME), &program.bytes)?;
    write(&output.join(SCRIPT_TEXT), script::text(program.address).as_bytes())?;
    for file in files {
        write(&folder.join(file.name), &file.bytes)?;
        if file.name == SCRIPT_NAME {
            write(&output.join(file.name), &file.bytes)?;
        }
    }
    Ok(())
}

/// Writes U-Boot and the whole card.
///
/// # Errors
/// When the files do not fit, or something cannot be written.
pub fn write_card(output: &Path, files: &[CardFile], uboot: &UBoot) -> anyhow::Result<()> {
    write(&output.join(UBOOT_NAME), &uboot.bytes)?;
    write(&output.join(CARD_IMAGE), &card(files, uboot)?)
}

fn write(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    fs::write(path, bytes).with_context(|| format!("cannot write {}", path.display()))
}

fn remove(path: &Path) -> anyhow::Result<()> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            Err(error).with_context(|| format!("cannot remove {}", path.display()))
        }
        _ => Ok(()),
    }
}

fn summary(files: &[CardFile], uboot: &UBoot, origin: &str) -> Table {
    let mut table = Table::new([Column::text("on the card"), Column::number("bytes"), Column::text("")]);
    for CardFile { name, bytes } in files {
        let note = if *name == PROGRAM_NAME {
            format!("of {} it may have", thousands(BYTES_MAX as u64))
        } else {
            String::new()
        };
        table.row([(*name).to_string(), thousands(bytes.len() as u64), note]);
    }
    table.row(["U-Boot".to_string(), thousands(uboot.bytes.len() as u64), origin.to_string()]);
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paths::TemporaryFolder;

    #[test]
    fn an_older_run_s_fpga_image_and_card_go() {
        let folder = TemporaryFolder::new().expect("folders can be made");
        let program = Program { address: 0x0100_0000, bytes: vec![7; 4] };
        let options = Some("usb full".to_string());
        let with = files(&program, Extras { fpga_image: Some(vec![0xFF; 8]), mesh: Some(vec![1; 8]), options });
        write_files(folder.path(), &program, &with).expect("it can be written");
        fs::write(folder.path().join(CARD_IMAGE), "old").expect("it can be written");
        fs::write(folder.path().join("card/notes.txt"), "mine").expect("it can be written");
        write_files(folder.path(), &program, &files(&program, Extras::default())).expect("it can be written");
        let exists = |name: &str| folder.path().join(name).exists();
        assert!(!exists("card/halfspace.rbf") && !exists("card/model.mesh") && !exists(CARD_IMAGE));
        assert!(!exists("card/options.txt"));
        assert!(exists("card/notes.txt") && exists("card/boot.scr") && exists("card/halfspace.bin"));
        assert!(exists("halfspace.bin") && exists("boot.scr") && exists("boot.cmd"));
    }
}
