//! What U-Boot's `go` tells the program: `go ADDRESS rbf IMAGE BYTES` has it configure the FPGA with
//! the image (.rbf) that was loaded to `IMAGE`; both numbers are hexadecimal, as U-Boot's are.
//!
//! ```text
//! load mmc 0:1 0x08000000 halfspace.rbf
//! go 0x01000000 rbf 0x08000000 ${filesize}
//! ```

use core::fmt;
use heapless::{String, Vec};

use super::memory_map::{FPGA_IMAGE, FPGA_IMAGE_END};

/// Words that are looked at, and the longest word.
const WORDS: usize = 8;
const LENGTH: usize = 24;

/// The words after `go`, the address of the program first.
pub type Words = Vec<String<LENGTH>, WORDS>;

/// An FPGA image in memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Image {
    /// Its first byte; a multiple of 4.
    pub address: u32,
    /// Its length in bytes, at least 1.
    pub bytes: u32,
}

/// Why the words could not be followed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ArgumentError {
    /// A word that means nothing here.
    Unknown(String<LENGTH>),
    /// `rbf` without its two numbers.
    Missing,
    /// A word that is no hexadecimal number.
    NotANumber(String<LENGTH>),
    /// An image that does not lie where the program can read it.
    Misplaced(Image),
}

impl fmt::Display for ArgumentError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown(word) => write!(out, "argument `{word}` means nothing")?,
            Self::Missing => out.write_str("argument `rbf` wants two numbers")?,
            Self::NotANumber(word) => write!(out, "argument `{word}` is no hexadecimal number")?,
            Self::Misplaced(Image { address, bytes }) => write!(
                out,
                "an image of {bytes:#x} bytes at {address:#010x} does not lie on a multiple of 4 in {FPGA_IMAGE:#010x}…{:#010x}",
                FPGA_IMAGE_END - 1
            )?,
        }
        write!(out, ": use `go ADDRESS rbf {FPGA_IMAGE:#010x} ${{filesize}}`")
    }
}

/// Returns the image that the FPGA is to be configured with, if one is named.
///
/// # Errors
/// [`ArgumentError`]; the program goes on without.
pub fn image(words: &Words) -> Result<Option<Image>, ArgumentError> {
    match words.get(1..).unwrap_or_default() {
        [] => Ok(None),
        [rbf, address, bytes] if rbf == "rbf" => {
            let image = Image { address: hexadecimal(address)?, bytes: hexadecimal(bytes)? };
            let end = u64::from(image.address) + u64::from(image.bytes).next_multiple_of(4);
            let inside = image.address >= FPGA_IMAGE && end <= u64::from(FPGA_IMAGE_END);
            if image.bytes > 0 && image.address.is_multiple_of(4) && inside {
                Ok(Some(image))
            } else {
                Err(ArgumentError::Misplaced(image))
            }
        }
        [rbf, ..] if rbf == "rbf" => Err(ArgumentError::Missing),
        [word, ..] => Err(ArgumentError::Unknown(word.clone())),
    }
}

fn hexadecimal(word: &String<LENGTH>) -> Result<u32, ArgumentError> {
    let digits = word.strip_prefix("0x").unwrap_or(word);
    // `from_str_radix` takes a sign, U-Boot does not.
    if digits.starts_with('+') {
        return Err(ArgumentError::NotANumber(word.clone()));
    }
    u32::from_str_radix(digits, 16).map_err(|_| ArgumentError::NotANumber(word.clone()))
}

/// Copies the words that `go` passes in r0 and r1: a count, and a list of pointers to strings.
///
/// Whatever the two hold, this only reads in the SDRAM, and takes nothing but printable words: the
/// program may have been started in another way.
///
/// # Safety
/// The whole SDRAM can be read: the MMU is off.
#[cfg(target_arch = "arm")]
#[must_use]
pub unsafe fn of_go([count, list]: [u32; 2]) -> Words {
    /// The SDRAM, without its first MiB, which need not be RAM.
    const SDRAM: core::ops::Range<u32> = 0x0010_0000..0x4000_0000;

    let mut words = Words::new();
    if !list.is_multiple_of(4) {
        return words;
    }
    for index in 0..count.min(WORDS as u32) {
        let entry = list.wrapping_add(4 * index);
        if !SDRAM.contains(&entry) {
            break;
        }
        // SAFETY: in the SDRAM and aligned.
        let start = unsafe { core::ptr::with_exposed_provenance::<u32>(entry as usize).read_volatile() };
        let mut word = String::new();
        for address in (start..SDRAM.end).take(LENGTH + 1) {
            if !SDRAM.contains(&address) {
                return words;
            }
            // SAFETY: in the SDRAM.
            match unsafe { core::ptr::with_exposed_provenance::<u8>(address as usize).read_volatile() } {
                0 => break,
                byte if byte.is_ascii_graphic() && word.push(byte.into()).is_ok() => {}
                _ => return words,
            }
        }
        // There is room: the loop goes round as often as there is.
        let _ = words.push(word);
    }
    words
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::string::ToString;

    fn parse(line: &str) -> Result<Option<Image>, ArgumentError> {
        let mut words = Words::new();
        for word in line.split(' ') {
            words.push(String::try_from(word).unwrap()).unwrap();
        }
        image(&words)
    }

    #[test]
    fn an_image_is_named_in_hexadecimal_with_or_without_a_prefix() {
        let wanted = Ok(Some(Image { address: 0x0800_0000, bytes: 0x001a_2b3c }));
        assert_eq!(parse("0x01000000 rbf 0x08000000 1a2b3c"), wanted);
        assert_eq!(parse("01000000 rbf 08000000 0x1A2B3C"), wanted);
        assert_eq!(parse("0x01000000"), Ok(None));
        assert_eq!(image(&Words::new()), Ok(None));
    }

    #[test]
    fn every_mistake_names_the_word_and_the_remedy() {
        for (line, word) in [
            ("1000000 rfb 8000000 100", "`rfb` means nothing"),
            ("1000000 rbf", "two numbers"),
            ("1000000 rbf 8000000", "two numbers"),
            ("1000000 rbf 8000000 100 7", "two numbers"),
            ("1000000 rbf 8o00000 100", "`8o00000` is no"),
            ("1000000 rbf 8000000 ${filesize}", "`${filesize}` is no"),
            ("1000000 rbf +8000000 100", "`+8000000` is no"),
            ("1000000 rbf 108000000 100", "`108000000` is no"),
        ] {
            let error = parse(line).unwrap_err().to_string();
            assert!(error.contains(word), "{error}");
            assert!(error.ends_with("use `go ADDRESS rbf 0x08000000 ${filesize}`"), "{error}");
        }
    }

    #[test]
    fn an_image_lies_whole_in_its_window() {
        for good in ["8000000 8000000", "ffffffc 1", "ffffffc 4"] {
            assert!(matches!(parse(&["1000000 rbf ", good].concat()), Ok(Some(_))), "{good}");
        }
        for bad in
            ["7fffffc 8", "8000000 8000001", "8000002 4", "ffffffc 5", "8000000 0", "8000000 ffffffff", "ffffffff 1"]
        {
            assert!(matches!(parse(&["1000000 rbf ", bad].concat()), Err(ArgumentError::Misplaced(_))), "{bad}");
        }
    }
}
