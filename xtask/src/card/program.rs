//! The firmware as U-Boot loads it: the bytes of the ELF file's segments, one after the other, as
//! they are to lie in memory. (`objcopy -O binary` makes the same.)

use std::fs;
use std::path::Path;

use anyhow::{Context, ensure};
use object::Endianness;
use object::elf::{EM_ARM, PT_LOAD};
use object::read::elf::{ElfFile32, FileHeader, ProgramHeader};

use super::script::{PROGRAM_END, PROGRAM_START};

/// Most bytes that the program may have.
pub const BYTES_MAX: usize = 256 * 1024;

/// A program that starts at its first byte.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Program {
    /// Where it is loaded, and where it starts.
    pub address: u32,
    /// What is loaded there.
    pub bytes: Vec<u8>,
}

impl Program {
    /// Takes the program out of an ELF file.
    ///
    /// # Errors
    /// When the file cannot be read, is no program for the board, or is larger than [`BYTES_MAX`].
    pub fn read(elf: &Path) -> anyhow::Result<Self> {
        let bytes = fs::read(elf).with_context(|| format!("cannot read {}", elf.display()))?;
        Self::from_elf(&bytes).with_context(|| format!("{} is no program for the card", elf.display()))
    }

    fn from_elf(elf: &[u8]) -> anyhow::Result<Self> {
        let file = ElfFile32::<Endianness>::parse(elf).context("it is no 32-bit ELF file")?;
        let endian = file.endian();
        let header = file.elf_header();
        let machine = header.e_machine(endian);
        ensure!(
            machine == EM_ARM && endian == Endianness::Little,
            "it is for machine {machine}, not for a little-endian ARM ({EM_ARM})"
        );
        let mut segments = Vec::new();
        for segment in file.elf_program_headers().iter().filter(|segment| segment.p_type(endian) == PT_LOAD) {
            let bytes = segment.data(endian, elf).ok().context("a segment lies outside of the file")?;
            if !bytes.is_empty() {
                segments.push((segment.p_paddr(endian), bytes));
            }
        }
        segments.sort_by_key(|(address, _)| *address);
        let (address, _) = *segments.first().context("it has nothing to load")?;
        let mut bytes = Vec::new();
        for (start, segment) in segments {
            let (start, end) = (u64::from(start), u64::from(start) + segment.len() as u64);
            ensure!(
                start >= u64::from(PROGRAM_START) && end <= u64::from(PROGRAM_END),
                "it has bytes at {start:#010x}…{end:#010x}; U-Boot's script loads to {PROGRAM_START:#010x}…{PROGRAM_END:#010x}: see memory.x"
            );
            let offset = (start - u64::from(address)) as usize;
            ensure!(offset >= bytes.len(), "two of its segments have bytes at {start:#010x}");
            bytes.resize(offset, 0);
            bytes.extend(segment);
        }
        let entry = header.e_entry(endian);
        ensure!(
            entry == address,
            "it starts at {entry:#010x}, but the script starts it at its first byte, {address:#010x}"
        );
        ensure!(bytes.len() <= BYTES_MAX, "it has {} bytes, more than the {BYTES_MAX} it may have", bytes.len());
        Ok(Self { address, bytes })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const EXECUTABLE: u32 = 0x0028_0002;

    /// An ELF file with segments of `[address, bytes in the file, bytes in memory]`, filled with 1, 2 and so on.
    fn elf(machine_and_type: u32, entry: u32, segments: &[[u32; 3]]) -> Vec<u8> {
        let mut file = b"\x7fELF\x01\x01\x01\0\0\0\0\0\0\0\0\0".to_vec();
        let mut data = 52 + 32 * segments.len() as u32;
        let mut push = |words: &[u32]| file.extend(words.iter().flat_map(|word| word.to_le_bytes()));
        push(&[machine_and_type, 1, entry, 52, 0, 0x0500_0400, 0x0020_0034, segments.len() as u32 | 40 << 16, 0]);
        for [address, in_file, in_memory] in segments {
            push(&[PT_LOAD, data, 0xDEAD_0000, *address, *in_file, *in_memory, 5, 4]);
            data += in_file;
        }
        for (number, segment) in segments.iter().enumerate() {
            file.resize(file.len() + segment[1] as usize, number as u8 + 1);
        }
        file
    }

    fn refusal(file: &[u8]) -> String {
        format!("{:#}", Program::from_elf(file).expect_err("it is no program for the card"))
    }

    #[test]
    fn segments_lie_where_they_are_loaded_and_what_has_no_bytes_is_left_out() {
        let file = elf(EXECUTABLE, 0x0100_0000, &[[0x0100_0008, 3, 3], [0x0100_0000, 4, 4], [0x0280_0000, 0, 64]]);
        let program = Program::from_elf(&file).expect("a good file");
        assert_eq!(program, Program { address: 0x0100_0000, bytes: vec![2, 2, 2, 2, 0, 0, 0, 0, 1, 1, 1] });
    }

    #[test]
    fn what_the_script_could_not_start_is_refused() {
        let start = 0x0100_0000;
        assert!(refusal(b"halfspace").contains("no 32-bit ELF"));
        assert!(refusal(&elf(0x0003_0002, start, &[[start, 4, 4]])).contains("machine 3"));
        assert!(refusal(&elf(EXECUTABLE, start, &[[start, 0, 4]])).contains("nothing to load"));
        assert!(refusal(&elf(EXECUTABLE, start + 4, &[[start, 8, 8]])).contains("starts at 0x01000004"));
        assert!(refusal(&elf(EXECUTABLE, start, &[[start, 8, 8], [start + 4, 4, 4]])).contains("two of its segments"));
        for stray in [0x00FF_FFFC, 0x0280_0000, 0xFFFF_FFFC] {
            let message = refusal(&elf(EXECUTABLE, start, &[[start, 4, 4], [stray, 4, 4]]));
            assert!(message.contains(&format!("bytes at {stray:#010x}")), "{message}");
        }
        let mut cut = elf(EXECUTABLE, start, &[[start, 8, 8]]);
        cut.pop();
        assert!(refusal(&cut).contains("outside of the file"));
        let large = BYTES_MAX as u32 + 1;
        assert!(
            refusal(&elf(EXECUTABLE, start, &[[start, large, large]])).contains("262145 bytes, more than the 262144")
        );
    }
}
