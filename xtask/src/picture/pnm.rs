//! The two Netpbm forms that are used: QEMU's screen dumps (PPM) and depth buffers (16-bit PGM).

use std::fs;
use std::path::Path;

use anyhow::{Context, ensure};

use super::Picture;

/// Writes depths as a binary PGM of 16 bits, the most significant byte first: 0 is the near plane
/// (black), 65,535 the far one.
///
/// # Errors
///
/// When there is not one depth for each pixel, or the file cannot be written.
pub fn write_depth_pgm(path: &Path, width: u32, height: u32, depths: &[u16]) -> anyhow::Result<()> {
    let expected = u64::from(width) * u64::from(height);
    ensure!(depths.len() as u64 == expected, "{} depths for {width}×{height} pixels", depths.len());
    let mut bytes = format!("P5\n{width} {height}\n65535\n").into_bytes();
    bytes.extend(depths.iter().flat_map(|depth| depth.to_be_bytes()));
    fs::write(path, bytes).with_context(|| format!("cannot write {}: check that its folder exists", path.display()))
}

/// Reads a binary PPM (P6) of 8 bits, as QEMU's `screendump` writes it.
///
/// # Errors
///
/// When the file cannot be read or is no such picture.
pub fn read_ppm(path: &Path) -> anyhow::Result<Picture> {
    let bytes = fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
    parse_ppm(&bytes).with_context(|| format!("{} is no 8-bit PPM picture (P6)", path.display()))
}

fn parse_ppm(bytes: &[u8]) -> anyhow::Result<Picture> {
    let mut rest = bytes.strip_prefix(b"P6").context("it does not start with P6")?;
    let mut numbers = [0_u32; 3];
    for number in &mut numbers {
        rest = rest.trim_ascii_start();
        while rest.first() == Some(&b'#') {
            let end = rest.iter().position(|byte| *byte == b'\n').context("its header has no end")?;
            rest = rest[end..].trim_ascii_start();
        }
        let digits = rest.iter().take_while(|byte| byte.is_ascii_digit()).count();
        *number = str::from_utf8(&rest[..digits])?.parse().context("its header lacks a number")?;
        rest = &rest[digits..];
    }
    let [width, height, maximum] = numbers;
    ensure!(maximum == 255, "its largest value is {maximum}, not 255");
    let [separator, pixels @ ..] = rest else {
        anyhow::bail!("it has no pixels");
    };
    ensure!(separator.is_ascii_whitespace(), "its header has no end");
    Picture::new(width, height, pixels.to_vec())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_elf::TestFile;
    use crate::test_random::Random;

    #[test]
    fn a_screen_dump_is_read() {
        for header in ["P6\n2 1\n255\n", "P6 # from QEMU\n#\n2\t1 255 "] {
            let bytes = [header.as_bytes(), &[1, 2, 3, 10, 32, 35]].concat();
            let picture = parse_ppm(&bytes).expect(header);
            assert_eq!((picture.width(), picture.height()), (2, 1));
            assert_eq!(picture.bytes(), [1, 2, 3, 10, 32, 35]);
        }
    }

    #[test]
    fn other_files_are_refused() {
        for text in [
            "",
            "P5\n1 1\n255\n...",
            "P6",
            "P6\n1",
            "P6\n1 1\n65535\n......",
            "P6\n2 1\n255\n...",
            "P6\n1 1\n255",
            "P6 #",
        ] {
            assert!(parse_ppm(text.as_bytes()).is_err(), "{text:?}");
        }
        let mut random = Random::new(3);
        for _ in 0..2_000 {
            let alphabet = b"P60123456789 \n#";
            let text: Vec<u8> = (0..random.below(30)).map(|_| alphabet[random.below(alphabet.len())]).collect();
            let _ = parse_ppm(&[b"P6\n", text.as_slice()].concat());
        }
    }

    #[test]
    fn depths_are_written_most_significant_byte_first() {
        let file = TestFile::new("depth.pgm", &[]);
        write_depth_pgm(file.path(), 2, 1, &[0x1234, 0xffff]).expect("the temporary folder takes files");
        let bytes = fs::read(file.path()).expect("just written");
        assert_eq!(bytes, b"P5\n2 1\n65535\n\x12\x34\xff\xff");
        assert!(write_depth_pgm(file.path(), 2, 2, &[0]).is_err());
    }
}
