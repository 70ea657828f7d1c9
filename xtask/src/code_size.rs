//! What parts of a board's firmware take of its image.

use std::fs;
use std::path::Path;

use anyhow::Context;
use object::{Object, ObjectSymbol, SymbolKind};

use crate::cli::Board;
use crate::firmware_build::build_firmware;
use crate::measure::Measurement;
use crate::progress::Progress;
use crate::setup::ensure_firmware_toolchain;

/// Bytes of code that driver, hub and HID may have together.
const USB_BYTES_MAXIMUM: f64 = 40.0 * 1024.0;
/// Crates whose names are in the names of their functions, and of generic ones that were made for them.
const USB_CRATES: [&str; 3] = ["dwc2_host", "usb_input", "embassy_"];

/// Builds the DE1-SoC's image and returns how many bytes of code serve USB.
///
/// # Errors
/// When the firmware does not build or is not what it should be.
pub fn measurement(progress: &Progress) -> anyhow::Result<Measurement> {
    let elf = build_firmware(Board::De1Soc, &[], &ensure_firmware_toolchain(progress)?, progress)?;
    let bytes = usb_bytes(functions(&elf)?.iter().map(|(name, size)| (name.as_str(), *size)));
    anyhow::ensure!(bytes > 0, "{} has no function of {}", elf.display(), USB_CRATES.join(", "));
    Ok(Measurement { bar: Some(USB_BYTES_MAXIMUM), ..Measurement::new("usb.code_bytes", bytes as f64, "bytes") })
}

/// Returns the functions of an ELF file and their sizes in bytes.
fn functions(elf: &Path) -> anyhow::Result<Vec<(String, u64)>> {
    let bytes = fs::read(elf).with_context(|| format!("cannot read {}", elf.display()))?;
    let file = object::File::parse(&*bytes).with_context(|| format!("{} is no object file", elf.display()))?;
    let text = file.symbols().filter(|symbol| symbol.kind() == SymbolKind::Text);
    text.map(|symbol| Ok((symbol.name()?.to_string(), symbol.size()))).collect()
}

fn usb_bytes<'a>(functions: impl Iterator<Item = (&'a str, u64)>) -> u64 {
    let is_usb = |name: &str| USB_CRATES.iter().any(|part| name.contains(part));
    functions.filter(|(name, _)| is_usb(name)).map(|(_, size)| size).sum()
}

#[cfg(test)]
mod tests {
    use super::usb_bytes;

    #[test]
    fn functions_of_the_crates_and_made_for_them_count() {
        let functions = [
            ("_ZN9usb_input5stack5Stack4poll17h0e2c2686e5d5b11fE", 1),
            ("_ZN4core3ptr60drop_in_place$LT$dwc2_host..driver..Allocator$GT$17hffc62dab56492613E", 20),
            ("_ZN93_$LT$embassy_futures..select..Select$LT$A$C$B$GT$$u20$as$u20$core..future..Future$GT$4pollE", 300),
            ("_ZN8geometry6matrix6Matrix12orthographic17h10bb5c6f12ae575eE", 4_000),
        ];
        assert_eq!(usb_bytes(functions.into_iter()), 321);
    }
}
