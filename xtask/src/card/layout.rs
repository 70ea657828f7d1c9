//! Where what lies on the card: a partition table in the first sector (MBR), the file system,
//! and U-Boot in a partition of type 0xA2, where the Cyclone V's boot ROM looks for it
//! (Cyclone V HPS TRM, A.4.4.1).

use std::ops::Range;

use super::CardFile;
use super::fat;
use super::uboot::UBoot;

/// Bytes of a sector.
pub const SECTOR: usize = 512;
const SECTORS_A_MIB: u32 = 1 << 11;
/// Partition 1: the files.
const FILES: Range<u32> = SECTORS_A_MIB..65 * SECTORS_A_MIB;
/// Partition 2: U-Boot. Partitions begin on whole MiB, as a card's erase blocks do.
const UBOOT: Range<u32> = FILES.end..FILES.end + SECTORS_A_MIB;
/// Most bytes that U-Boot may have.
pub const UBOOT_BYTES_MAX: usize = (UBOOT.end - UBOOT.start) as usize * SECTOR;

/// FAT32, addressed by sector number.
const KIND_FILES: u8 = 0x0C;
const KIND_UBOOT: u8 = 0xA2;
/// What tells one disk from another in a partition table.
const DISK_ID: u32 = 0x4861_6C66;
/// Heads, sectors and cylinders are not used: the largest stand for any.
const NO_GEOMETRY: [u8; 3] = [0xFE, 0xFF, 0xFF];

/// Returns the whole card.
///
/// # Errors
/// When the files do not fit.
pub fn card(files: &[CardFile], uboot: &UBoot) -> anyhow::Result<Vec<u8>> {
    let mut card = vec![0; UBOOT.end as usize * SECTOR];
    card[..SECTOR].copy_from_slice(&partition_table());
    let bytes = |sectors: Range<u32>| sectors.start as usize * SECTOR..sectors.end as usize * SECTOR;
    fat::write(&mut card[bytes(FILES)], files)?;
    card[bytes(UBOOT)][..uboot.bytes.len()].copy_from_slice(&uboot.bytes);
    Ok(card)
}

fn partition_table() -> [u8; SECTOR] {
    let mut sector = [0; SECTOR];
    sector[440..444].copy_from_slice(&DISK_ID.to_le_bytes());
    let partitions = [(0x80, KIND_FILES, FILES), (0, KIND_UBOOT, UBOOT)];
    for (entry, (active, kind, sectors)) in sector[446..510].chunks_exact_mut(16).zip(partitions) {
        entry[0] = active;
        entry[1..4].copy_from_slice(&NO_GEOMETRY);
        entry[4] = kind;
        entry[5..8].copy_from_slice(&NO_GEOMETRY);
        entry[8..12].copy_from_slice(&sectors.start.to_le_bytes());
        entry[12..16].copy_from_slice(&(sectors.end - sectors.start).to_le_bytes());
    }
    sector[510..].copy_from_slice(&[0x55, 0xAA]);
    sector
}
