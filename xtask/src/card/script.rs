//! What U-Boot does: its script `boot.scr`, as text and in the envelope that `source` wants (a
//! legacy image: a header of 64 bytes with checksums, U-Boot's `include/image.h`).

use crc::{CRC_32_ISO_HDLC, Crc};
use firmware::de1_soc::memory_map;

use super::{FPGA_IMAGE_NAME, MESH_NAME, OPTIONS_NAME, PROGRAM_NAME};

/// First byte of where the program may lie: `CODE` of memory.x.
pub const PROGRAM_START: u32 = 0x0100_0000;
/// One more than its last.
pub const PROGRAM_END: u32 = PROGRAM_START + (16 << 20);
/// First byte of where the FPGA's image is loaded.
pub const FPGA_IMAGE: u32 = memory_map::FPGA_IMAGE;
/// First byte of where a mesh file is loaded, behind it.
pub const MESH: u32 = 0x0A00_0000;
/// One more than the last byte of where the program looks for files.
pub const FILES_END: u32 = memory_map::FPGA_IMAGE_END;

/// Time stamp of everything on the card, in seconds since 1970: 1 January 1980, where FAT's time begins.
pub const TIME: u32 = 315_532_800;
/// Name in the header.
pub const NAME: &str = "Halfspace";

const HEADER_BYTES: usize = 64;
const MAGIC: u32 = 0x2705_1956;
/// Operating system Linux, processor ARM, a script, not compressed: as `mkimage -A arm -T script` has it.
const KIND: [u8; 4] = [5, 2, 6, 0];
const CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// Returns the script for a program that is loaded to `address` and starts there.
///
/// It is written for U-Boot 2023.01 and its hush shell. A command has at most 15 words after its name: some
/// boards' U-Boot takes no more.
pub fn text(address: u32) -> String {
    format!(
        "\
# Starts Halfspace on the DE1-SoC. Written by `cargo xtask image`.
# U-Boot runs this from partition 1 of the SD card; every number is hexadecimal.

setenv fpga_image
if test -e mmc 0:1 {FPGA_IMAGE_NAME}; then
  if load mmc 0:1 {FPGA_IMAGE:#010x} {FPGA_IMAGE_NAME}; then
    # The next load overwrites filesize.
    setenv fpga_image rbf {FPGA_IMAGE:#010x} ${{filesize}}
    if fpga load 0 {FPGA_IMAGE:#010x} ${{filesize}}; then
      echo FPGA configured with {FPGA_IMAGE_NAME}
      setenv fpga_image
    else
      echo U-Boot could not configure the FPGA: Halfspace tries again, and tells why
    fi
  else
    echo {FPGA_IMAGE_NAME} cannot be read from the card: the FPGA stays as it is
  fi
else
  echo No {FPGA_IMAGE_NAME} on the card: the FPGA stays as it is
fi

# Of a line like `options=usb full`. It is loaded to where the next file goes.
setenv options
if test -e mmc 0:1 {OPTIONS_NAME}; then
  if load mmc 0:1 {MESH:#010x} {OPTIONS_NAME}; then
    env import -t -r {MESH:#010x} ${{filesize}} options
  fi
fi

setenv mesh_file
if test -e mmc 0:1 {MESH_NAME}; then
  if load mmc 0:1 {MESH:#010x} {MESH_NAME}; then
    setenv mesh_file mesh {MESH:#010x} ${{filesize}}
  else
    echo {MESH_NAME} cannot be read from the card: Halfspace shows what is built in
  fi
fi

# The program opens the bridges to the FPGA itself, after it has looked.
if load mmc 0:1 {address:#010x} {PROGRAM_NAME}; then
  # What was loaded may still be in the data cache, and what lay there before in the
  # instruction cache: U-Boot itself ran at {address:#010x} before it moved up.
  dcache flush
  dcache off
  icache flush
  icache off
  go {address:#010x} ${{fpga_image}} ${{mesh_file}} ${{options}}
else
  echo {PROGRAM_NAME} cannot be read from partition 1 of the card: copy it
fi
"
    )
}

/// Returns the script's file.
pub fn image(text: &str) -> Vec<u8> {
    // A list of lengths that ends with 0, then the one script.
    let mut data = Vec::new();
    data.extend((text.len() as u32).to_be_bytes());
    data.extend(0_u32.to_be_bytes());
    data.extend(text.as_bytes());
    let mut header = header(&data, 0);
    header = self::header(&data, CRC.checksum(&header));
    [&header[..], &data].concat()
}

/// Returns the header with this checksum in it; the checksum is over the header with 0.
fn header(data: &[u8], checksum: u32) -> [u8; HEADER_BYTES] {
    let mut header = [0; HEADER_BYTES];
    let load_and_entry = 0;
    let words = [MAGIC, checksum, TIME, data.len() as u32, load_and_entry, load_and_entry, CRC.checksum(data)];
    for (place, word) in header.chunks_exact_mut(4).zip(words) {
        place.copy_from_slice(&word.to_be_bytes());
    }
    header[28..32].copy_from_slice(&KIND);
    header[32..32 + NAME.len()].copy_from_slice(NAME.as_bytes());
    header
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_program_lies_clear_of_all_else() {
        let memory = include_str!("../../../memory.x");
        assert!(
            memory.contains("_code_start : 0x01000000,\n                LENGTH = 16M"),
            "memory.x and the script differ"
        );
        // U-Boot's scriptaddr, where this very script runs from.
        const { assert!(PROGRAM_END <= 0x0210_0000 && FPGA_IMAGE > 0x0210_0000) };
    }

    #[test]
    fn no_command_has_more_words_than_u_boot_takes() {
        for line in text(PROGRAM_START).lines().filter(|line| !line.trim().starts_with('#')) {
            assert!(line.split_whitespace().count() <= 16, "{line}");
        }
    }

    #[test]
    fn the_program_is_told_of_an_fpga_image_that_u_boot_could_not_use() {
        // The same words that the firmware's own reader is tested with.
        assert!(text(PROGRAM_START).contains("setenv fpga_image rbf 0x08000000 ${filesize}\n"));
        assert!(text(PROGRAM_START).contains("  go 0x01000000 ${fpga_image} ${mesh_file} ${options}\n"));
        assert!(text(PROGRAM_START).contains("setenv mesh_file mesh 0x0a000000 ${filesize}\n"));
    }
}
