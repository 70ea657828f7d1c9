//! ELF files for tests, built by hand: ARM code to run, and the symbols of a defmt log.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

const HEADER_BYTES: u32 = 52;
const PROGRAM_HEADER_BYTES: u32 = 32;
const SECTION_HEADER_BYTES: u32 = 40;
const SYMBOL_BYTES: u32 = 16;
/// Start of vexpress-a9's RAM as QEMU maps it.
const LOAD_ADDRESS: u32 = 0x6000_0000;

/// A 32-bit little-endian ARM executable.
pub struct TestElf {
    code: Vec<u8>,
    symbols: Vec<(String, u32)>,
}

impl TestElf {
    /// Starts a file that runs `instructions` from the first.
    pub fn new(instructions: &[u32]) -> Self {
        Self { code: instructions.iter().flat_map(|word| word.to_le_bytes()).collect(), symbols: Vec::new() }
    }

    /// Adds a symbol in the section `.defmt`.
    pub fn defmt_symbol(&mut self, name: &str, value: u32) {
        self.symbols.push((name.to_string(), value));
    }

    /// Returns the file's bytes: header, program header, code, symbols, their names, section names,
    /// section headers.
    pub fn bytes(&self) -> Vec<u8> {
        const SECTION_NAMES: &[u8] = b"\0.defmt\0.symtab\0.strtab\0.shstrtab\0";
        let code_offset = HEADER_BYTES + PROGRAM_HEADER_BYTES;
        let symbols_offset = code_offset + self.code.len() as u32;
        let mut names = vec![0];
        let mut symbols = words(&[0; 4]);
        for (name, value) in &self.symbols {
            symbols.extend(words(&[names.len() as u32, *value, 1]));
            symbols.extend([0x10, 0, 1, 0]); // global, no type, section 1
            names.extend(name.as_bytes());
            names.push(0);
        }
        let names_offset = symbols_offset + symbols.len() as u32;
        let section_names_offset = names_offset + names.len() as u32;
        let sections_offset = (section_names_offset + SECTION_NAMES.len() as u32).next_multiple_of(4);
        let section_count = if self.symbols.is_empty() { 0 } else { 5_u32 };

        let mut file = b"\x7fELF\x01\x01\x01\0\0\0\0\0\0\0\0\0".to_vec();
        file.extend([2, 0, 40, 0]); // executable, ARM
        file.extend(words(&[
            1,
            LOAD_ADDRESS,
            HEADER_BYTES,
            if section_count == 0 { 0 } else { sections_offset },
            0x0500_0400,
        ]));
        let sizes = [
            HEADER_BYTES,
            PROGRAM_HEADER_BYTES,
            1,
            SECTION_HEADER_BYTES,
            section_count,
            section_count.saturating_sub(1),
        ];
        file.extend(sizes.iter().flat_map(|size| (*size as u16).to_le_bytes()));
        let size = self.code.len() as u32;
        file.extend(words(&[1, code_offset, LOAD_ADDRESS, LOAD_ADDRESS, size, size, 5, 4]));
        file.extend(&self.code);
        file.extend(&symbols);
        file.extend(&names);
        file.extend(SECTION_NAMES);
        file.resize(sections_offset as usize, 0);
        if section_count > 0 {
            let section = |name, kind, offset, size, link, info, entry| {
                words(&[name, kind, 0, 0, offset, size, link, info, 1, entry])
            };
            file.extend(section(0, 0, 0, 0, 0, 0, 0));
            file.extend(section(1, 1, code_offset, 0, 0, 0, 0));
            file.extend(section(8, 2, symbols_offset, symbols.len() as u32, 3, 1, SYMBOL_BYTES));
            file.extend(section(16, 3, names_offset, names.len() as u32, 0, 0, 0));
            file.extend(section(24, 3, section_names_offset, SECTION_NAMES.len() as u32, 0, 0, 0));
        }
        file
    }
}

fn words(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

/// A file in the temporary folder that goes with this value.
pub struct TestFile(PathBuf);

impl TestFile {
    /// Writes `bytes` to a file of its own.
    pub fn new(name: &str, bytes: &[u8]) -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let path = std::env::temp_dir().join(format!("halfspace-test-{}-{number}-{name}", std::process::id()));
        fs::write(&path, bytes).expect("the temporary folder takes files");
        Self(path)
    }

    /// Returns where the file is.
    pub fn path(&self) -> &Path {
        &self.0
    }
}

impl Drop for TestFile {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.0);
    }
}
