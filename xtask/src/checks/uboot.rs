//! A step in which U-Boot itself starts from the card, in QEMU.
//!
//! QEMU has no Cyclone V, so it is Debian's U-Boot for QEMU's `virt` machine: the same source
//! with the same shell, FAT reader and script format. The script differs from the card's in what the machines
//! differ in: the disk's name, where the memory begins, and that the program, which is not for that machine,
//! is named and not started.

use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::mpsc;
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, ensure};

use super::State;
use crate::card::layout::card;
use crate::card::program::Program;
use crate::card::uboot::UBoot;
use crate::card::{CardFile, Extras, FPGA_IMAGE_NAME, PROGRAM_NAME, SCRIPT_NAME, files, script};
use crate::cli::Board;
use crate::paths::TemporaryFolder;
use crate::setup::{Packages, ensure_file, ensure_uboot};

/// Debian's and other systems' places are not the same.
const PATHS: [&str; 2] = ["/usr/lib/u-boot/qemu_arm/u-boot.bin", "/usr/share/u-boot/qemu_arm/u-boot.bin"];
const PACKAGES: Packages = Packages { apt: &["u-boot-qemu"], dnf: &["uboot-images-armv7"], pacman: &[], brew: &[] };
const PATIENCE: Duration = Duration::from_secs(60);
/// What the script says last when it cannot go on, and when it can.
const ENDS: [&str; 2] = ["cannot be read from partition 1", "would go"];

/// The script runs to its end with and without an FPGA image, and says so when the program is missing.
pub(super) fn follows_the_script(state: &State) -> anyhow::Result<()> {
    let bios = ensure_file("U-Boot for QEMU", &PATHS, &PACKAGES, &state.progress)?;
    let qemu = state.qemu()?;
    let elf = state.elf(Board::De1Soc)?;
    let uboot = UBoot::read(&ensure_uboot(&state.progress)?.image)?;
    let program = Program::read(&elf)?;
    let script = for_virt(&script::text(program.address))?;
    let with = |extras: Extras, leave_out: &str| {
        let mut files = files(&program, extras);
        files.retain(|file| file.name != leave_out);
        for file in files.iter_mut().filter(|file| file.name == SCRIPT_NAME) {
            file.bytes = script::image(&script);
        }
        files
    };
    let folder = TemporaryFolder::new().context("cannot make a temporary folder")?;
    let run = |name: &str, files: Vec<CardFile>| -> anyhow::Result<String> {
        let disk = folder.path().join(name);
        fs::write(&disk, card(&files, &uboot)?).context("cannot write the card")?;
        boot(&qemu, &bios, &disk)
    };
    let (size, mesh_size) = (300_001, 70_003);
    let all = Extras {
        fpga_image: Some(vec![0x5A; size]),
        mesh: Some(vec![0xA5; mesh_size]),
        options: Some("usb full usb pulse".into()),
    };
    let [with_image, without, without_program] = thread::scope(|scope| {
        let jobs = [
            ("with", with(all, "")),
            ("without", with(Extras::default(), "")),
            ("no-program", with(Extras::default(), PROGRAM_NAME)),
        ];
        let threads = jobs.map(|(name, files)| scope.spawn(move || run(name, files)));
        threads.map(|thread| thread.join().expect("it does not panic"))
    });
    let says = |said: &str, words: &[&str]| {
        words.iter().try_for_each(|word| {
            ensure!(said.contains(word), "U-Boot did not say `{word}`:\n{said}");
            Ok(())
        })
    };
    let read = format!("{} bytes read", program.bytes.len());
    // This U-Boot cannot configure an FPGA, so the program is told to.
    let with_image = with_image?;
    says(&with_image, &[&format!("{size} bytes read"), "U-Boot could not configure the FPGA", &read])?;
    let words = format!("rbf 0x48000000 {size:x} mesh 0x4a000000 {mesh_size:x} usb full usb pulse");
    says(&with_image, &[&format!("would go 0x41000000 {words}\r")])?;
    says(&without?, &[&format!("No {FPGA_IMAGE_NAME} on the card"), &read, "would go 0x41000000\r"])?;
    says(&without_program?, &[&format!("{PROGRAM_NAME} cannot be read from partition 1 of the card")])
}

/// Returns the script for a machine whose memory begins at 0x40000000 and whose disk is on virtio.
fn for_virt(script: &str) -> anyhow::Result<String> {
    let mut text = script.to_string();
    for (here, there) in [
        ("mmc 0:1", "virtio 0:1"),
        ("0x01000000", "0x41000000"),
        ("0x08000000", "0x48000000"),
        ("0x0a000000", "0x4a000000"),
        ("  go ", "  echo would go "),
    ] {
        ensure!(text.contains(here), "the script has lost its `{here}`");
        text = text.replace(here, there);
    }
    Ok(text)
}

/// Starts U-Boot with a disk, and returns what it says until the script's end.
fn boot(qemu: &Path, bios: &Path, disk: &Path) -> anyhow::Result<String> {
    let mut command = Command::new(qemu);
    command.args(["-M", "virt", "-cpu", "cortex-a15", "-m", "512", "-display", "none", "-monitor", "none"]);
    command.args(["-audiodev", "none,id=none", "-net", "none", "-serial", "stdio", "-bios"]).arg(bios);
    command.arg("-drive").arg(format!("if=none,format=raw,id=card,file={}", disk.display()));
    command.args(["-device", "virtio-blk-device,drive=card"]);
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::inherit());
    let mut child = command.spawn().with_context(|| format!("cannot start {}", qemu.display()))?;
    let mut output = child.stdout.take().context("QEMU's output is not connected")?;
    let (sender, receiver) = mpsc::channel();
    let reader = thread::spawn(move || {
        let mut buffer = [0; 4096];
        while let Ok(count @ 1..) = output.read(&mut buffer) {
            if sender.send(buffer[..count].to_vec()).is_err() {
                break;
            }
        }
    });
    let started = Instant::now();
    let mut said = Vec::new();
    while !is_over(&said) && started.elapsed() < PATIENCE {
        match receiver.recv_timeout(Duration::from_millis(100)) {
            Ok(bytes) => said.extend(bytes),
            Err(mpsc::RecvTimeoutError::Timeout) => {}
            Err(mpsc::RecvTimeoutError::Disconnected) => break,
        }
    }
    drop(receiver);
    child.kill().context("cannot stop QEMU")?;
    child.wait().context("cannot wait for QEMU")?;
    let _ = reader.join();
    let said = String::from_utf8_lossy(&said).into_owned();
    ensure!(is_over(said.as_bytes()), "U-Boot did not come to the script's end in {} s:\n{said}", PATIENCE.as_secs());
    Ok(said)
}

/// Whether a line that ends the script stands there whole.
fn is_over(said: &[u8]) -> bool {
    let said = String::from_utf8_lossy(said);
    said.split_inclusive('\n').any(|line| line.ends_with('\n') && ENDS.iter().any(|end| line.contains(end)))
}
