//! Steps that look at the SD card with other people's tools: sfdisk, fsck.vfat, mtools, mkimage,
//! objcopy. Of our own is only the CRC of the preloader, written again from its definition.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, bail, ensure};
use object::{Object, ObjectSymbol};
use serde::Deserialize;

use super::State;
use crate::card::program::Program;
use crate::card::uboot::UBoot;
use crate::card::{Extras, FPGA_IMAGE_NAME, MESH_NAME, OPTIONS_NAME, PROGRAM_NAME, SCRIPT_NAME, files, script};
use crate::cli::Board;
use crate::commands::image;
use crate::paths::TemporaryFolder;
use crate::progress::Progress;
use crate::setup::{Packages, ensure_tool, ensure_uboot, find_program};

const MIB: usize = 1 << 20;
const FDISK: Packages =
    Packages { apt: &["fdisk"], dnf: &["util-linux-core"], pacman: &["util-linux"], brew: &["util-linux"] };
const DOSFSTOOLS: Packages =
    Packages { apt: &["dosfstools"], dnf: &["dosfstools"], pacman: &["dosfstools"], brew: &["dosfstools"] };
const MTOOLS: Packages = Packages { apt: &["mtools"], dnf: &["mtools"], pacman: &["mtools"], brew: &["mtools"] };
const UBOOT_TOOLS: Packages =
    Packages { apt: &["u-boot-tools"], dnf: &["uboot-tools"], pacman: &["uboot-tools"], brew: &["u-boot-tools"] };
const BINUTILS: Packages = Packages {
    apt: &["binutils-arm-none-eabi"],
    dnf: &["binutils-arm-linux-gnu"],
    pacman: &["arm-none-eabi-binutils"],
    brew: &["arm-none-eabi-binutils"],
};

struct Tools {
    sfdisk: PathBuf,
    fsck: PathBuf,
    mcopy: PathBuf,
    mdir: PathBuf,
    mkimage: PathBuf,
    objcopy: PathBuf,
}

impl Tools {
    fn find(progress: &Progress) -> anyhow::Result<Self> {
        Ok(Self {
            sfdisk: system_tool("sfdisk", &FDISK, progress)?,
            fsck: system_tool("fsck.vfat", &DOSFSTOOLS, progress)?,
            mcopy: ensure_tool("mcopy", &MTOOLS, progress)?,
            mdir: ensure_tool("mdir", &MTOOLS, progress)?,
            mkimage: ensure_tool("mkimage", &UBOOT_TOOLS, progress)?,
            objcopy: ensure_tool("arm-none-eabi-objcopy", &BINUTILS, progress)?,
        })
    }
}

/// Finds a tool that on some systems lies outside of a user's `PATH`.
fn system_tool(program: &str, packages: &Packages, progress: &Progress) -> anyhow::Result<PathBuf> {
    let elsewhere = ["/usr/sbin", "/sbin"].map(|folder| Path::new(folder).join(program));
    match elsewhere.into_iter().find(|path| find_program(program).is_none() && path.is_file()) {
        Some(path) => Ok(path),
        None => ensure_tool(program, packages, progress),
    }
}

/// The whole card, as `cargo xtask image` makes it, with an FPGA image that is none.
pub(super) fn card(state: &State) -> anyhow::Result<()> {
    let tools = Tools::find(&state.progress)?;
    let built = ensure_uboot(&state.progress)?;
    let uboot = UBoot::read(&built.image)?;
    let elf = state.elf(Board::De1Soc)?;
    let folder = TemporaryFolder::new().context("cannot make a temporary folder")?;
    let output = folder.path();

    let program = Program::read(&elf)?;
    // As long as an uncompressed one.
    let fpga_image: Vec<u8> = (0..7_000_001_u32).map(|index| (index.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
    let mesh = fpga_image[..100_003].to_vec();
    let files =
        files(&program, Extras { fpga_image: Some(fpga_image), mesh: Some(mesh), options: Some("usb full".into()) });
    image::write_files(output, &program, &files)?;
    image::write_card(output, &files, &uboot)?;
    let card = fs::read(output.join(image::CARD_IMAGE)).context("there is no card image")?;

    let [files_partition, uboot_partition] = partitions(&tools, output)?;
    let part = |range: &[usize; 2]| &card[range[0]..range[1]];
    check_files(&tools, output, part(&files_partition))?;
    check_uboot(&tools, output, part(&uboot_partition), &uboot)?;
    check_script(&tools, output)?;
    let binary = output.join("objcopy.bin");
    run(Command::new(&tools.objcopy).args(["-O", "binary"]).arg(&elf).arg(&binary))?;
    ensure!(read(&binary)? == read(&output.join("card").join(PROGRAM_NAME))?, "objcopy makes another {PROGRAM_NAME}");
    check_commands(&built.elf, &script::text(program.address))?;
    image::write_card(output, &files, &uboot)?;
    ensure!(read(&output.join(image::CARD_IMAGE))? == card, "a second card image differs from the first");
    println!("halfspace.bin: {} bytes; U-Boot {}", program.bytes.len(), built.version);
    Ok(())
}

/// Returns the two partitions as sfdisk reads the table: first byte, and one more than the last.
fn partitions(tools: &Tools, output: &Path) -> anyhow::Result<[[usize; 2]; 2]> {
    #[derive(Deserialize)]
    struct Answer {
        partitiontable: Table,
    }
    #[derive(Deserialize)]
    struct Table {
        label: String,
        sectorsize: usize,
        partitions: Vec<Partition>,
    }
    #[derive(Deserialize)]
    struct Partition {
        start: usize,
        size: usize,
        r#type: String,
        #[serde(default)]
        bootable: bool,
    }
    let image = output.join(image::CARD_IMAGE);
    let said = run(Command::new(&tools.sfdisk).arg("--verify").arg(&image))?;
    ensure!(said.contains("No errors detected"), "sfdisk finds fault with the partition table: {said}");
    let said = run(Command::new(&tools.sfdisk).arg("--json").arg(&image))?;
    let Answer { partitiontable: table } = serde_json::from_str(&said).context("sfdisk's JSON is not as expected")?;
    ensure!(table.label == "dos", "the partition table is a {} one", table.label);
    let [files, uboot] = table.partitions.as_slice() else {
        bail!("{} partitions instead of 2", table.partitions.len());
    };
    ensure!(
        files.r#type == "c" && files.bootable,
        "partition 1 is of type {}, or cannot be started from",
        files.r#type
    );
    ensure!(uboot.r#type == "a2", "partition 2 is of type {}, where the boot ROM looks for a2", uboot.r#type);
    let bytes = |it: &Partition| [it.start, it.start + it.size].map(|sector| sector * table.sectorsize);
    let (files, uboot) = (bytes(files), bytes(uboot));
    ensure!(files[0] % MIB == 0 && uboot[0] % MIB == 0, "a partition does not begin on a whole MiB");
    ensure!(files[0] > 0 && files[1] <= uboot[0], "the partitions overlap: {files:x?} and {uboot:x?}");
    let length = fs::metadata(&image).context("there is no card image")?.len();
    ensure!(uboot[1] as u64 <= length, "partition 2 ends behind the image");
    Ok([files, uboot])
}

fn check_files(tools: &Tools, output: &Path, partition: &[u8]) -> anyhow::Result<()> {
    let image = output.join("files.img");
    fs::write(&image, partition).context("cannot write the file system's copy")?;
    run(Command::new(&tools.fsck).args(["-n", "-v"]).arg(&image))
        .context("fsck.vfat finds fault with the file system")?;
    let list = run(Command::new(&tools.mdir).args(["-b", "-i"]).arg(&image).arg("::"))?;
    let mut names: Vec<&str> = list.lines().filter_map(|line| line.strip_prefix("::/")).collect();
    names.sort_unstable();
    ensure!(names == [SCRIPT_NAME, PROGRAM_NAME, FPGA_IMAGE_NAME, MESH_NAME, OPTIONS_NAME], "mdir lists {names:?}");
    for name in names {
        let copy = output.join(format!("copy-of-{name}"));
        run(Command::new(&tools.mcopy).args(["-n", "-i"]).arg(&image).arg(format!("::{name}")).arg(&copy))?;
        ensure!(
            read(&copy)? == read(&output.join("card").join(name))?,
            "{name} on the card differs from that in card/"
        );
    }
    Ok(())
}

/// All four copies of the preloader, and U-Boot itself.
fn check_uboot(tools: &Tools, output: &Path, partition: &[u8], uboot: &UBoot) -> anyhow::Result<()> {
    const COPY: usize = 64 << 10;
    ensure!(partition.starts_with(&uboot.bytes), "partition 2 does not begin with U-Boot");
    for (number, copy) in partition.chunks_exact(COPY).take(4).enumerate() {
        check_preloader(copy).with_context(|| format!("copy {} of the preloader", number + 1))?;
        let path = output.join("preloader");
        fs::write(&path, copy).context("cannot write the preloader's copy")?;
        let said = run(Command::new(&tools.mkimage).args(["-l", "-T", "socfpgaimage"]).arg(&path))?;
        ensure!(said.contains("Cyclone V"), "mkimage takes copy {} of the preloader for {said}", number + 1);
    }
    let path = output.join("proper");
    fs::write(&path, &partition[4 * COPY..uboot.bytes.len()]).context("cannot write U-Boot's copy")?;
    let said = run(Command::new(&tools.mkimage).arg("-l").arg(&path))?;
    ensure!(said.contains("U-Boot Firmware") && said.contains("de1-soc"), "mkimage takes U-Boot for {said}");
    Ok(())
}

/// Header and CRC by the handbook's definition, a bit at a time, without the code that reads a file for --uboot.
fn check_preloader(copy: &[u8]) -> anyhow::Result<()> {
    let header = copy.get(0x40..0x4C).context("it is cut")?;
    ensure!(header[..6] == [0x41, 0x53, 0x30, 0x31, 0, 0], "no validation word, version 0 and flags 0: {header:02x?}");
    let sum = header[..10].iter().fold(0_u32, |sum, byte| sum + u32::from(*byte));
    ensure!([sum as u8, (sum >> 8) as u8] == header[10..], "the header's checksum is {sum:#x}: {header:02x?}");
    let length = 4 * (usize::from(header[6]) | usize::from(header[7]) << 8);
    ensure!(length > 0x4C && length <= 60 << 10, "a length of {length} bytes");
    let mut crc = u32::MAX;
    for byte in &copy[..length - 4] {
        for bit in (0..8).rev() {
            let feed = crc >> 31 ^ u32::from(byte >> bit & 1);
            crc = crc << 1 ^ if feed == 1 { 0x04C1_1DB7 } else { 0 };
        }
    }
    ensure!((!crc).to_le_bytes() == copy[length - 4..length], "its CRC is {:#010x}, not what it ends with", !crc);
    Ok(())
}

/// mkimage reads the script, and makes the same bytes of its text.
fn check_script(tools: &Tools, output: &Path) -> anyhow::Result<()> {
    let said = run(Command::new(&tools.mkimage).arg("-l").arg(output.join(SCRIPT_NAME)))?;
    ensure!(said.contains("ARM Linux Script (uncompressed)"), "mkimage takes {SCRIPT_NAME} for {said}");
    let again = output.join("again.scr");
    run(Command::new(&tools.mkimage)
        .env("SOURCE_DATE_EPOCH", script::TIME.to_string())
        .args(["-A", "arm", "-T", "script", "-C", "none", "-n", script::NAME, "-d"])
        .arg(output.join(image::SCRIPT_TEXT))
        .arg(&again))?;
    ensure!(read(&again)? == read(&output.join(SCRIPT_NAME))?, "mkimage makes another {SCRIPT_NAME} of the same text");
    Ok(())
}

/// Every command of the script is in the U-Boot that was built.
fn check_commands(uboot: &Path, script: &str) -> anyhow::Result<()> {
    const ENTRY: &str = "_u_boot_list_2_cmd_2_";
    let bytes = read(uboot)?;
    let elf = object::File::parse(bytes.as_slice()).context("U-Boot's ELF file cannot be read")?;
    let known: Vec<&str> = elf.symbols().filter_map(|it| it.name().ok()?.strip_prefix(ENTRY)).collect();
    ensure!(known.contains(&"version"), "U-Boot's ELF file lists no commands");
    let mut count = 0;
    for line in script.lines().map(str::trim).filter(|line| !line.starts_with('#')) {
        let command = line.trim_start_matches("if ").split([' ', ';']).next().unwrap_or_default();
        if !["", "else", "fi"].contains(&command) {
            ensure!(known.contains(&command), "the script's command `{command}` is not in this U-Boot");
            count += 1;
        }
    }
    ensure!(count >= 10, "only {count} commands were found in the script");
    Ok(())
}

fn read(path: &Path) -> anyhow::Result<Vec<u8>> {
    fs::read(path).with_context(|| format!("cannot read {}", path.display()))
}

/// Runs a tool in English, and returns what it said.
fn run(command: &mut Command) -> anyhow::Result<String> {
    let output = command.env("LC_ALL", "C").output().with_context(|| format!("cannot start {command:?}"))?;
    let [out, error] = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    ensure!(output.status.success(), "{command:?} failed ({}):\n{out}{error}", output.status);
    Ok(out)
}
