//! Whether a file is U-Boot for the DE1-SoC, as the Cyclone V's boot ROM takes it
//! (`u-boot-with-spl.sfp`): four copies of the preloader (SPL), 64 KiB apart, then U-Boot proper.
//!
//! The ROM takes the first copy whose header and checksum are right. The header lies at byte 0x40
//! of a copy: a magic number, version 0, flags 0, the length in words, 0, and the sum of the ten bytes before.
//! Its last word is a CRC of all before it. (Cyclone V HPS TRM, appendix A; U-Boot's `tools/socfpgaimage.c`.)

use std::fs;
use std::path::Path;

use anyhow::{Context, bail, ensure};
use crc::{CRC_32_BZIP2, CRC_32_ISO_HDLC, Crc};

use super::layout::UBOOT_BYTES_MAX;

const COPIES: usize = 4;
const COPY_BYTES: usize = 0x1_0000;
/// Where U-Boot proper begins.
const PROPER: usize = COPIES * COPY_BYTES;
const HEADER: usize = 0x40;
const HEADER_BYTES: usize = 12;
const MAGIC: u32 = 0x3130_5341;
/// Most bytes that the ROM loads of a copy.
const PRELOADER_BYTES_MAX: usize = 60 * 1024;
const PRELOADER_CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_BZIP2);

/// U-Boot's own image: a header of 64 bytes.
const IMAGE_MAGIC: [u8; 4] = [0x27, 0x05, 0x19, 0x56];
const IMAGE_HEADER_BYTES: usize = 64;
const IMAGE_CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);
/// The other format it may have, a device tree with U-Boot in it.
const TREE_MAGIC: [u8; 4] = [0xD0, 0x0D, 0xFE, 0xED];

/// U-Boot with its preloader, checked.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UBoot {
    /// The file.
    pub bytes: Vec<u8>,
}

impl UBoot {
    /// Reads `u-boot-with-spl.sfp`.
    ///
    /// # Errors
    /// When it cannot be read, or is not what the board starts from; the error says what is wrong with it.
    pub fn read(path: &Path) -> anyhow::Result<Self> {
        let bytes = fs::read(path).with_context(|| format!("cannot read U-Boot from {}", path.display()))?;
        Self::new(bytes).with_context(|| {
            format!("{} is no U-Boot for the DE1-SoC's card: give u-boot-with-spl.sfp", path.display())
        })
    }

    /// Checks the bytes of `u-boot-with-spl.sfp`.
    ///
    /// # Errors
    /// What is wrong with them.
    pub fn new(bytes: Vec<u8>) -> anyhow::Result<Self> {
        if bytes.starts_with(&IMAGE_MAGIC) || bytes.starts_with(&TREE_MAGIC) {
            bail!("it is U-Boot without its preloader");
        }
        ensure!(
            bytes.len() <= UBOOT_BYTES_MAX,
            "it has {} bytes, more than the {UBOOT_BYTES_MAX} of its partition: is it a whole card?",
            bytes.len()
        );
        for number in 0..COPIES {
            let copy = bytes.get(number * COPY_BYTES..(number + 1) * COPY_BYTES);
            let copy = copy.with_context(|| {
                format!(
                    "it ends inside of copy {} of {COPIES} of the preloader, after {} bytes",
                    number + 1,
                    bytes.len()
                )
            })?;
            check_preloader(copy).with_context(|| format!("copy {} of {COPIES} of the preloader", number + 1))?;
        }
        check_proper(&bytes[PROPER..]).with_context(|| format!("U-Boot itself, from byte {PROPER:#x} on"))?;
        Ok(Self { bytes })
    }
}

fn check_preloader(copy: &[u8]) -> anyhow::Result<()> {
    let header = &copy[HEADER..][..HEADER_BYTES];
    let word = |at: usize| u16::from_le_bytes([header[at], header[at + 1]]);
    let magic = u32::from_le_bytes([header[0], header[1], header[2], header[3]]);
    ensure!(magic == MAGIC, "{magic:#010x} stands at byte {HEADER:#x} where a header begins with {MAGIC:#010x}");
    let version = header[4];
    ensure!(version == 0, "its header has version {version}, that of another device; the Cyclone V's is 0");
    let sum: u16 = header[..10].iter().map(|byte| u16::from(*byte)).sum();
    let found = word(10);
    ensure!(found == sum, "its header says checksum {found:#06x}, but has {sum:#06x}");
    let length = usize::from(word(6)) * 4;
    ensure!(
        (HEADER + HEADER_BYTES + 4..=PRELOADER_BYTES_MAX).contains(&length),
        "its header says {length} bytes; the boot ROM loads at most {PRELOADER_BYTES_MAX}"
    );
    let (body, crc) = copy[..length].split_at(length - 4);
    let (found, crc) = (PRELOADER_CRC.checksum(body), u32::from_le_bytes([crc[0], crc[1], crc[2], crc[3]]));
    ensure!(found == crc, "its CRC is {found:#010x}, but it ends with {crc:#010x}: was it changed or damaged?");
    Ok(())
}

fn check_proper(bytes: &[u8]) -> anyhow::Result<()> {
    if bytes.starts_with(&TREE_MAGIC) {
        return Ok(());
    }
    ensure!(bytes.starts_with(&IMAGE_MAGIC), "no image begins there");
    ensure!(bytes.len() >= IMAGE_HEADER_BYTES, "its header is cut");
    let (header, data) = bytes.split_at(IMAGE_HEADER_BYTES);
    let word = |at: usize| u32::from_be_bytes([header[at], header[at + 1], header[at + 2], header[at + 3]]);
    let mut without = header.to_vec();
    without[4..8].fill(0);
    ensure!(IMAGE_CRC.checksum(&without) == word(4), "its header is damaged (CRC)");
    let length = word(12) as usize;
    let data = data.get(..length).with_context(|| format!("{} of {length} bytes are there: it is cut", data.len()))?;
    ensure!(IMAGE_CRC.checksum(data) == word(24), "it is damaged (CRC)");
    Ok(())
}

/// A stand-in that the board would load and that does nothing; for tests.
#[cfg(test)]
pub(crate) fn stand_in() -> Vec<u8> {
    let mut copy = vec![0_u8; COPY_BYTES];
    let length = 0x200;
    copy[..4].copy_from_slice(&0xEAFF_FFFE_u32.to_le_bytes());
    copy[HEADER..HEADER + 8].copy_from_slice(&[0x41, 0x53, 0x30, 0x31, 0, 0, (length / 4) as u8, 0]);
    copy[HEADER + 10] = 0x41 + 0x53 + 0x30;
    copy[HEADER + 10] = copy[HEADER + 10].wrapping_add(0x31).wrapping_add((length / 4) as u8);
    copy[HEADER + 11] = 1;
    let crc = PRELOADER_CRC.checksum(&copy[..length - 4]);
    copy[length - 4..length].copy_from_slice(&crc.to_le_bytes());
    let proper = super::script::image("true\n");
    [&copy[..], &copy, &copy, &copy, &proper].concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(change: impl FnOnce(&mut Vec<u8>)) -> String {
        let mut bytes = stand_in();
        change(&mut bytes);
        format!("{:#}", UBoot::new(bytes).expect_err("it is broken"))
    }

    /// The check value of this CRC in the catalogue of parametrised CRC algorithms.
    #[test]
    fn the_preloader_s_crc_is_the_most_significant_bit_first_one() {
        assert_eq!(PRELOADER_CRC.checksum(b"123456789"), 0xFC89_1918);
    }

    #[test]
    fn a_good_file_is_taken() {
        UBoot::new(stand_in()).expect("a good file");
    }

    #[test]
    fn what_is_wrong_is_named_with_its_place() {
        assert!(refusal(|bytes| *bytes = bytes.split_off(PROPER)).contains("without its preloader"));
        assert!(refusal(|bytes| bytes.truncate(0x2_8000)).contains("inside of copy 3 of 4"));
        assert!(refusal(|bytes| bytes.clear()).contains("after 0 bytes"));
        assert!(refusal(|bytes| bytes[0x3_0040] = 0).contains("copy 4 of 4 of the preloader: 0x31305300"));
        assert!(refusal(|bytes| bytes[0x44] = 1).contains("version 1, that of another device"));
        assert!(refusal(|bytes| bytes[0x46] += 1).contains("checksum"));
        assert!(refusal(|bytes| bytes[0x2_0100] ^= 1).contains("copy 3 of 4 of the preloader: its CRC"));
        assert!(refusal(|bytes| bytes.truncate(PROPER)).contains("no image begins there"));
        assert!(refusal(|bytes| bytes.truncate(PROPER + 20)).contains("header is cut"));
        assert!(refusal(|bytes| bytes[PROPER + 8] ^= 1).contains("header is damaged"));
        assert!(refusal(|bytes| bytes.truncate(PROPER + 70)).contains("6 of 13 bytes"));
        assert!(refusal(|bytes| *bytes.last_mut().expect("bytes") ^= 1).contains("it is damaged"));
        assert!(refusal(|bytes| bytes.resize(UBOOT_BYTES_MAX + 1, 0)).contains("is it a whole card?"));
    }

    #[test]
    fn a_length_beyond_what_the_rom_loads_is_refused() {
        let message = refusal(|bytes| {
            bytes[0x46..0x48].copy_from_slice(&0x3C01_u16.to_le_bytes());
            let sum: u16 = bytes[0x40..0x4A].iter().map(|byte| u16::from(*byte)).sum();
            bytes[0x4A..0x4C].copy_from_slice(&sum.to_le_bytes());
        });
        assert!(message.contains("says 61444 bytes; the boot ROM loads at most 61440"), "{message}");
    }
}
