//! The card's file system: FAT32, which U-Boot and every PC read.

use std::io::{Cursor, Write};

use anyhow::{Context, ensure};
use fatfs::{Date, DateTime, FatType, FileSystem, FormatVolumeOptions, FsOptions, Time, TimeProvider, format_volume};

use super::CardFile;
use super::layout::SECTOR;

const LABEL: [u8; 11] = *b"HALFSPACE  ";
const VOLUME_ID: u32 = 0x4861_6C66;

/// The time of [`TIME`](super::script::TIME).
#[derive(Debug)]
struct Begin;

impl TimeProvider for Begin {
    fn get_current_date(&self) -> Date {
        Date { year: 1980, month: 1, day: 1 }
    }

    fn get_current_date_time(&self) -> DateTime {
        DateTime { date: self.get_current_date(), time: Time { hour: 0, min: 0, sec: 0, millis: 0 } }
    }
}

/// Makes a file system in `partition` with `files` in its root folder, dated 1 January 1980.
///
/// # Errors
/// When the files do not fit; the error says how much room there is.
pub fn write(partition: &mut [u8], files: &[CardFile]) -> anyhow::Result<()> {
    let options = FormatVolumeOptions::new()
        .fat_type(FatType::Fat32)
        .bytes_per_sector(SECTOR as u16)
        .bytes_per_cluster(SECTOR as u32)
        .volume_id(VOLUME_ID)
        .volume_label(LABEL);
    format_volume(Cursor::new(&mut *partition), options).context("cannot make the card's file system")?;
    let options = FsOptions::new().time_provider(&Begin);
    let system = FileSystem::new(Cursor::new(partition), options).context("cannot open the card's file system")?;
    let free = system.stats().context("cannot count the card's free clusters")?;
    let room = u64::from(free.free_clusters()) * u64::from(free.cluster_size());
    let wanted: u64 = files.iter().map(|file| file.bytes.len().next_multiple_of(SECTOR) as u64).sum();
    ensure!(
        wanted <= room,
        "the files take {wanted} bytes, and the card's partition has room for {room}: is the FPGA image a raw one (.rbf)?"
    );
    for file in files {
        write_file(&system, file).with_context(|| format!("cannot write {} on the card", file.name))?;
    }
    system.unmount().context("cannot finish the card's file system")
}

fn write_file<Disk: fatfs::ReadWriteSeek>(system: &FileSystem<Disk>, file: &CardFile) -> std::io::Result<()> {
    let mut out = system.root_dir().create_file(file.name)?;
    out.write_all(&file.bytes)?;
    out.flush()
}
