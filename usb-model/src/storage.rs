//! A memory stick: no input device.

use crate::leaf::{Descriptors, Function, Leaf};
use crate::wire::Speed;

/// It answers nothing beyond its descriptors.
#[derive(Debug)]
pub struct Blocks;

/// A memory stick.
pub type Storage = Leaf<Blocks>;

/// Returns a memory stick that signals at a speed.
pub fn storage(speed: Speed) -> Storage {
    // 512 bytes at high speed, else 64.
    let [low, high] = if speed == Speed::High { [0, 2] } else { [64, 0] };
    let configuration = [
        &[9, 2, 32, 0, 1, 1, 0, 0x80, 100, 9, 4, 0, 0, 2, 8, 6, 0x50, 0][..],
        &[7, 5, 0x81, 2, low, high, 0, 7, 5, 0x02, 2, low, high, 0],
    ]
    .concat();
    let descriptors = Descriptors {
        device: vec![18, 1, 0, 2, 0, 0, 0, 64, 0x81, 0x07, 0x67, 0x55, 0, 1, 1, 2, 0, 1],
        configuration,
        strings: vec!["SanDisk".into(), "Cruzer Blade, with a name longer than anyone keeps".into()],
        reports: Vec::new(),
    };
    Leaf::new(speed, descriptors, Blocks)
}

impl Function for Blocks {
    fn request_in(&mut self, _now: u64, _setup: [u8; 8]) -> Option<Vec<u8>> {
        None
    }

    fn request_out(&mut self, _now: u64, _setup: [u8; 8], _data: &[u8]) -> bool {
        false
    }

    fn input(&mut self, _now: u64, _endpoint: u8) -> Option<Vec<u8>> {
        None
    }
}
