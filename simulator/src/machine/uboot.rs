//! What U-Boot leaves behind when its `go` calls a program (hardware.md §5.3's source: U-Boot's
//! `cmd/boot.c`, `arch/arm/lib/cache-cp15.c`).

use crate::bus::UBOOT;
use crate::cpu::Start;
use crate::memory::Memory;

/// U-Boot's exception vectors, once it has moved itself.
const VECTORS: u32 = UBOOT;
/// Its translation table, near the end of the SDRAM.
const TRANSLATION_TABLE: u32 = 0x3FFF_0000;
/// Its stack.
const STACK: u32 = 0x3EF0_0000;
/// What it keeps on its heap of the command line: the list of its words, and behind it the words.
const ARGUMENTS: u32 = 0x3EF0_0000;

/// Sections of 1 MiB in SDRAM.
const SDRAM_SECTIONS: u32 = 1024;
/// Read and write for all, execute never, strongly ordered; U-Boot's domains check none of it.
const STRONGLY_ORDERED: u32 = 0b11 << 10 | 1 << 4 | 0b10;
/// Write-back: C and B.
const WRITE_BACK: u32 = STRONGLY_ORDERED | 1 << 3 | 1 << 2;

/// What is done before the jump: by a script, or a person.
#[derive(Debug, Clone)]
pub(super) struct Go {
    /// The words behind `go`, the address among them.
    pub words: Vec<String>,
    /// Whether `dcache flush`, `dcache off`, `icache off` come first, as in the card's script.
    pub caches_off: bool,
}

/// Returns where and how a program starts.
pub(super) fn start(entry: u32, sdram: &Memory, go: &Go) -> Start {
    let words = &go.words;
    let mut text = ARGUMENTS + 4 * words.len() as u32;
    for (place, word) in (ARGUMENTS..).step_by(4).zip(words) {
        sdram.set_word(place, text);
        sdram.load(text, word.as_bytes());
        sdram.load(text + word.len() as u32, &[0]);
        text += word.len() as u32 + 1;
    }
    let arguments = [words.len() as u32, ARGUMENTS];
    Start {
        entry,
        stack: STACK,
        translation_table: TRANSLATION_TABLE,
        vectors: VECTORS,
        cached: !go.caches_off,
        arguments,
    }
}

/// Writes U-Boot's translation table: SDRAM write-back, all else strongly ordered.
pub(super) fn write_translation_table(sdram: &Memory) {
    for section in 0..4096 {
        let attributes = if section < SDRAM_SECTIONS { WRITE_BACK } else { STRONGLY_ORDERED };
        sdram.set_word(TRANSLATION_TABLE + 4 * section, section << 20 | attributes);
    }
}
