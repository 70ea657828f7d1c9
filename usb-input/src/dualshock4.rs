//! What a DualShock 4's report says beyond its report descriptor.

use controls::{Acceleration, Battery, DualShock3Report};

/// idVendor and idProduct, first and second model.
pub(crate) const PRODUCTS: [(u16, u16); 2] = [(0x054C, 0x05C4), (0x054C, 0x09CC)];

/// Bytes of the report, its id counted (Linux `hid-playstation.c`, SDL `SDL_hidapi_ps4.c`).
const ACCELERATION: usize = 19;
const STATUS: usize = 30;

/// Puts acceleration and battery into what the report descriptor told of a report of id 1.
pub(crate) fn complete(report: &mut DualShock3Report, bytes: &[u8]) {
    if let Some(&[x0, x1, y0, y1, z0, z1]) = bytes.get(ACCELERATION..ACCELERATION + 6) {
        report.acceleration = acceleration([[x0, x1], [y0, y1], [z0, z1]].map(i16::from_le_bytes));
    }
    if let Some(&status) = bytes.get(STATUS) {
        report.battery = battery(status);
    }
}

/// Converts x (right), y (up), z (to the player), 8192 to the g, to a DualShock 3's readings: x likewise, y and z
/// as minus its third and its second, 113 to the g from 511 on (SDL `SDL_hidapi_ps3.c`).
fn acceleration([x, y, z]: [i16; 3]) -> Acceleration {
    const ZERO: i32 = 511;
    let counts = |reading: i32| (ZERO + (reading * 113 + 4096).div_euclid(8192)).clamp(0, 1023) as u16;
    Acceleration::from_raw([counts(x.into()), counts(-i32::from(z)), counts(-i32::from(y))])
}

/// Bit 4: on the cable. Bits 0 to 3: tenths, 11 for full.
fn battery(status: u8) -> Battery {
    match (status & 0x10 != 0, status & 0x0F) {
        (true, 11..) => Battery::Charged,
        (true, _) => Battery::Charging,
        (false, 0) => Battery::Empty,
        (false, 1..=2) => Battery::Dying,
        (false, 3..=5) => Battery::Low,
        (false, 6..=8) => Battery::High,
        (false, _) => Battery::Full,
    }
}

#[cfg(test)]
mod tests {
    use super::{acceleration, battery};
    use controls::{Acceleration, Battery, Tilt};

    #[test]
    fn at_rest_it_is_level() {
        assert_eq!(acceleration([0, 8192, 0]), Acceleration::LEVEL);
    }

    #[test]
    fn it_leans_the_same_way() {
        let roll = |axes| Tilt::from_acceleration(acceleration(axes)).roll.to_num::<i32>();
        // Its right side up is on its left side.
        assert_eq!([[8192, 0, 0], [-8192, 0, 0]].map(roll), [90, -90]);
    }

    /// Readings of both pads, each lying on a table, where their shapes tip them alike.
    #[test]
    fn it_nods_the_same_way() {
        let resting = Tilt::from_acceleration(acceleration([234, 8040, 1294])).pitch;
        let dualshock3 = Tilt::from_acceleration(Acceleration::from_raw([503, 492, 400])).pitch;
        assert!((dualshock3 - resting).abs() < 1, "{dualshock3} {resting}");
        assert!(resting > 8);
    }

    #[test]
    fn no_reading_leaves_ten_bits() {
        for axes in [[i16::MIN; 3], [i16::MAX; 3]] {
            let raw = acceleration(axes).to_raw();
            assert!(raw.iter().all(|&word| word <= 1023), "{raw:?}");
        }
    }

    #[test]
    fn the_battery_is_tenths() {
        assert_eq!(battery(0x1B), Battery::Charged);
        assert_eq!(battery(0x15), Battery::Charging);
        assert_eq!(
            [0, 1, 4, 7, 10].map(battery),
            [Battery::Empty, Battery::Dying, Battery::Low, Battery::High, Battery::Full]
        );
    }
}
