//! What the device's memories hold at one moment.

use fpga_regs::screen::PIXELS;

/// Both colour buffers and the depth buffer, row 0 first, each row from left to right.
#[derive(Clone, PartialEq, Eq)]
pub struct Memories {
    /// RGB332, by buffer number.
    pub colours: [Vec<u8>; 2],
    /// 0 is near.
    pub depths: Vec<u16>,
    /// Which buffer shows: 0 or 1.
    pub front_index: usize,
}

impl Memories {
    /// Returns room for the memories, all zero.
    pub(crate) fn zeroed(front_index: usize) -> Self {
        Self { colours: [vec![0; PIXELS], vec![0; PIXELS]], depths: vec![0; PIXELS], front_index }
    }

    /// Returns the buffer that shows.
    pub fn front(&self) -> &[u8] {
        &self.colours[self.front_index]
    }

    /// Returns the buffer that is drawn to.
    pub fn back(&self) -> &[u8] {
        &self.colours[1 - self.front_index]
    }
}
