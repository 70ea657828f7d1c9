//! What U-Boot's `go` tells the program: `rbf IMAGE BYTES` has it configure the FPGA with the image (.rbf) that was
//! loaded to `IMAGE`, `mesh FILE BYTES` show the mesh file that was loaded to `FILE`; `usb full` keeps the USB port at full
//! speed, `usb pulse` gives the pad's motor a short pulse when the pose is frozen. All numbers are hexadecimal, as
//! U-Boot's are.
//!
//! ```text
//! load mmc 0:1 0x08000000 halfspace.rbf
//! setenv bits ${filesize}
//! load mmc 0:1 0x0a000000 model.mesh
//! go 0x01000000 rbf 0x08000000 ${bits} mesh 0x0a000000 ${filesize}
//! ```

use core::fmt;

use heapless::{String, Vec};

use super::memory_map::{FPGA_IMAGE, FPGA_IMAGE_END};

/// Words that are looked at, and the longest word.
const WORDS: usize = 12;
const LENGTH: usize = 24;

/// A word.
type Word = String<LENGTH>;

/// The words after `go`, the address of the program first.
pub type Words = Vec<Word, WORDS>;

/// A file in memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Image {
    /// Its first byte; a multiple of 4.
    pub address: u32,
    /// Its length in bytes, at least 1.
    pub bytes: u32,
}

/// What the words ask for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Asked {
    /// The image that the FPGA is to be configured with.
    pub image: Option<Image>,
    /// The mesh file that is to be shown.
    pub mesh: Option<Image>,
    /// What USB is to do.
    pub usb: UsbWishes,
}

/// What USB is to do otherwise than it does by itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct UsbWishes {
    /// The port stays at full speed.
    pub full_speed: bool,
    /// The pad's motor gives a pulse when the pose is frozen.
    pub pulse: bool,
}

/// Why the words could not be followed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ArgumentError {
    /// A word that means nothing here.
    Unknown(Word),
    /// `rbf` or `mesh` without its two numbers.
    Missing(Word),
    /// `rbf` or `mesh` a second time.
    Twice(Word),
    /// A word that is no hexadecimal number.
    NotANumber(Word),
    /// `usb` without a word that it knows.
    Usb,
    /// A file that does not lie where the program can read it.
    Misplaced(Image),
}

impl fmt::Display for ArgumentError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown(word) => write!(out, "argument `{word}` means nothing")?,
            Self::Missing(word) => write!(out, "argument `{word}` wants two numbers")?,
            Self::Twice(word) => write!(out, "argument `{word}` comes twice")?,
            Self::Usb => return out.write_str("argument `usb` wants `full` or `pulse` behind it"),
            Self::NotANumber(word) => write!(out, "argument `{word}` is no hexadecimal number")?,
            Self::Misplaced(Image { address, bytes }) => write!(
                out,
                "a file of {bytes:#x} bytes at {address:#010x} does not lie on a multiple of 4 in {FPGA_IMAGE:#010x}…{:#010x}",
                FPGA_IMAGE_END - 1
            )?,
        }
        write!(out, ": use `go ADDRESS rbf {FPGA_IMAGE:#010x} ${{filesize}}`, and `mesh` likewise")
    }
}

/// Returns what the words ask for.
///
/// # Errors
/// [`ArgumentError`]; the program goes on without any of it.
pub fn asked(words: &Words) -> Result<Asked, ArgumentError> {
    let mut asked = Asked::default();
    let mut rest = words.get(1..).unwrap_or_default();
    while let [name, others @ ..] = rest {
        let slot = match name.as_str() {
            "rbf" => &mut asked.image,
            "mesh" => &mut asked.mesh,
            "usb" => {
                rest = usb_word(others, &mut asked.usb)?;
                continue;
            }
            _ => return Err(ArgumentError::Unknown(name.clone())),
        };
        let [address, bytes, others @ ..] = others else { return Err(ArgumentError::Missing(name.clone())) };
        if slot.replace(image(address, bytes)?).is_some() {
            return Err(ArgumentError::Twice(name.clone()));
        }
        rest = others;
    }
    Ok(asked)
}

/// Takes the word behind `usb`; returns the rest.
fn usb_word<'a>(words: &'a [Word], wishes: &mut UsbWishes) -> Result<&'a [Word], ArgumentError> {
    let (word, rest) = words.split_first().ok_or(ArgumentError::Usb)?;
    match word.as_str() {
        "full" => wishes.full_speed = true,
        "pulse" => wishes.pulse = true,
        _ => return Err(ArgumentError::Usb),
    }
    Ok(rest)
}

fn image(address: &Word, bytes: &Word) -> Result<Image, ArgumentError> {
    let image = Image { address: hexadecimal(address)?, bytes: hexadecimal(bytes)? };
    let end = u64::from(image.address) + u64::from(image.bytes).next_multiple_of(4);
    let inside = image.address >= FPGA_IMAGE && end <= u64::from(FPGA_IMAGE_END);
    if image.bytes > 0 && image.address.is_multiple_of(4) && inside {
        Ok(image)
    } else {
        Err(ArgumentError::Misplaced(image))
    }
}

fn hexadecimal(word: &Word) -> Result<u32, ArgumentError> {
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

    fn parse(line: &str) -> Result<Asked, ArgumentError> {
        let mut words = Words::new();
        for word in line.split(' ') {
            words.push(String::try_from(word).unwrap()).unwrap();
        }
        asked(&words)
    }

    fn files(image: Option<Image>, mesh: Option<Image>) -> Asked {
        Asked { image, mesh, usb: UsbWishes::default() }
    }

    #[test]
    fn usb_is_held_at_full_speed_and_the_motor_let_on() {
        let full = parse("1000000 usb full").unwrap();
        assert_eq!(full.usb, UsbWishes { full_speed: true, pulse: false });
        let all = parse("1000000 usb pulse rbf 8000000 100 mesh a000000 77 usb full").unwrap();
        assert_eq!(all.usb, UsbWishes { full_speed: true, pulse: true });
        assert!(all.image.is_some() && all.mesh.is_some());
        for line in ["1000000 usb", "1000000 usb fast"] {
            let error = parse(line).unwrap_err().to_string();
            assert_eq!(error, "argument `usb` wants `full` or `pulse` behind it");
        }
    }

    #[test]
    fn files_are_named_in_hexadecimal_with_or_without_a_prefix() {
        let image = Some(Image { address: 0x0800_0000, bytes: 0x001a_2b3c });
        let mesh = Some(Image { address: 0x0a00_0000, bytes: 0x77 });
        assert_eq!(parse("0x01000000 rbf 0x08000000 1a2b3c"), Ok(files(image, None)));
        assert_eq!(parse("01000000 rbf 08000000 0x1A2B3C"), Ok(files(image, None)));
        assert_eq!(parse("01000000 mesh a000000 77"), Ok(files(None, mesh)));
        assert_eq!(parse("01000000 mesh a000000 77 rbf 8000000 1a2b3c"), Ok(files(image, mesh)));
        assert_eq!(parse("01000000 rbf 8000000 1a2b3c mesh a000000 77"), Ok(files(image, mesh)));
        assert_eq!(parse("0x01000000"), Ok(Asked::default()));
        assert_eq!(asked(&Words::new()), Ok(Asked::default()));
    }

    #[test]
    fn every_mistake_names_the_word_and_the_remedy() {
        for (line, word) in [
            ("1000000 rfb 8000000 100", "`rfb` means nothing"),
            ("1000000 rbf", "`rbf` wants two numbers"),
            ("1000000 mesh 8000000", "`mesh` wants two numbers"),
            ("1000000 rbf 8000000 100 7", "`7` means nothing"),
            ("1000000 rbf 8000000 100 mesh", "`mesh` wants two numbers"),
            ("1000000 rbf 8000000 100 rbf 8000000 4", "`rbf` comes twice"),
            ("1000000 rbf 8o00000 100", "`8o00000` is no"),
            ("1000000 rbf 8000000 ${filesize}", "`${filesize}` is no"),
            ("1000000 rbf +8000000 100", "`+8000000` is no"),
            ("1000000 mesh 108000000 100", "`108000000` is no"),
        ] {
            let error = parse(line).unwrap_err().to_string();
            assert!(error.contains(word), "{error}");
            assert!(error.ends_with("use `go ADDRESS rbf 0x08000000 ${filesize}`, and `mesh` likewise"), "{error}");
        }
    }

    #[test]
    fn a_file_lies_whole_in_its_window() {
        for name in ["rbf", "mesh"] {
            let of = |numbers: &str| parse(&["1000000 ", name, " ", numbers].concat());
            for good in ["8000000 8000000", "ffffffc 1", "ffffffc 4"] {
                assert!(of(good).is_ok_and(|asked| asked != Asked::default()), "{good}");
            }
            for bad in [
                "7fffffc 8",
                "8000000 8000001",
                "8000002 4",
                "ffffffc 5",
                "8000000 0",
                "8000000 ffffffff",
                "ffffffff 1",
            ] {
                assert!(matches!(of(bad), Err(ArgumentError::Misplaced(_))), "{bad}");
            }
        }
    }
}
