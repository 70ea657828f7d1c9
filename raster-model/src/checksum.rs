//! One number that names a picture, the same on the host and on the board.

use crc::{CRC_32_ISO_HDLC, Crc};

const CRC_32: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// Returns the CRC-32 (IEEE 802.3, as in zlib and PNG) of a picture's bytes, row 0 first.
///
/// `picture` is a colour buffer as [`Device::front`](crate::Device::front) returns it; any other
/// bytes will do as well.
pub fn picture_checksum(picture: &[u8]) -> u32 {
    CRC_32.checksum(picture)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_check_value_of_the_catalogue_comes_out() {
        assert_eq!(picture_checksum(b"123456789"), 0xcbf4_3926);
        assert_eq!(picture_checksum(&[]), 0);
    }
}
