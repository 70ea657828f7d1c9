//! Values of flags that are more than a word or a number.

use firmware::scene::Scene;
use firmware::style::Style;

use crate::qemu::UsbIds;
use crate::session;
use crate::verilated::UNITS;

/// Angles about the x, y and z axis, in degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotation {
    /// Degrees about the x, y and z axis, each finite.
    pub degrees: [f64; 3],
}

/// Reads `054c:0268`, as lsusb has it.
pub(super) fn parse_usb_ids(text: &str) -> Result<UsbIds, String> {
    let is_id = |text: &&str| text.len() == 4 && text.bytes().all(|digit| digit.is_ascii_hexdigit());
    let id = |text| Some(text).filter(is_id).and_then(|text| u16::from_str_radix(text, 16).ok());
    let ids = text.split_once(':').and_then(|(vendor, product)| id(vendor).zip(id(product)));
    let (vendor, product) = ids.ok_or("give the ids that lsusb shows, four hexadecimal digits each: 054c:0268")?;
    Ok(UsbIds { vendor, product })
}

/// Reads a number of pixel units.
pub(super) fn parse_units(text: &str) -> Result<u32, String> {
    match text.parse() {
        Ok(units) if UNITS.contains(&units) => Ok(units),
        _ => Err("the design is built with 1, 2, 4 or 8 pixel units".to_string()),
    }
}

/// Reads `X,Y,Z` as three finite angles in degrees.
pub(super) fn parse_rotation(text: &str) -> Result<Rotation, String> {
    let remedy = "give three numbers of degrees with commas between, like 20,-30,0";
    let parts: Vec<&str> = text.split(',').collect();
    let [x, y, z] = parts.as_slice() else {
        return Err(format!("{} numbers instead of 3: {remedy}", parts.len()));
    };
    let mut degrees = [0.0; 3];
    for (angle, part) in degrees.iter_mut().zip([x, y, z]) {
        *angle = match part.trim().parse::<f64>() {
            Ok(number) if number.is_finite() => number,
            _ => return Err(format!("`{part}` is no angle: {remedy}")),
        };
    }
    Ok(Rotation { degrees })
}

/// Reads a scene's name.
pub(super) fn parse_scene(text: &str) -> Result<Scene, String> {
    session::scene_named(text).map_err(|error| error.to_string())
}

/// Reads a style's name.
pub(super) fn parse_style(text: &str) -> Result<Style, String> {
    session::style_named(text).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wrong_rotation_names_the_remedy() {
        for wrong in ["1,2", "1,2,x", "1,2,inf", "", "1,2,3,4"] {
            let message = parse_rotation(wrong).expect_err(wrong);
            assert!(message.contains("like 20,-30,0"), "{message}");
        }
    }

    #[test]
    fn usb_ids_are_those_of_lsusb() {
        assert_eq!(parse_usb_ids("054c:0268"), Ok(UsbIds { vendor: 0x054C, product: 0x0268 }));
        for wrong in ["", "054c", "054c:", "54c:268", "0x054c:0x0268", "054c:026g", "+54c:0268"] {
            assert!(parse_usb_ids(wrong).expect_err(wrong).contains("lsusb"), "{wrong}");
        }
    }
}
