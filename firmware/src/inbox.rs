//! Bytes that were read and not looked at yet.

/// Takes a source's bytes one by one, and reads them many at a time.
#[derive(Debug, Default)]
pub struct Inbox {
    bytes: heapless::Deque<u8, BYTES>,
}

/// Bytes that are read at once.
const BYTES: usize = 64;

impl Inbox {
    /// Returns the next byte. When none is left it asks `read`, which fills a buffer's beginning and returns how much;
    /// `None` when that is nothing.
    pub fn next(&mut self, read: impl FnOnce(&mut [u8]) -> usize) -> Option<u8> {
        if self.bytes.is_empty() {
            let mut buffer = [0; BYTES];
            let count = read(&mut buffer).min(BYTES);
            // As many as there is room for.
            self.bytes.extend(buffer[..count].iter().copied());
        }
        self.bytes.pop_front()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_come_in_their_order_and_are_read_when_none_is_left() {
        let mut inbox = Inbox::default();
        let two = |buffer: &mut [u8]| {
            buffer[..2].copy_from_slice(&[7, 8]);
            2
        };
        assert_eq!(inbox.next(two), Some(7));
        assert_eq!(inbox.next(|_| panic!("one is left")), Some(8));
        assert_eq!(inbox.next(|_| 0), None);
        assert_eq!(inbox.next(two), Some(7));
    }

    #[test]
    fn a_source_that_says_more_than_it_was_given_room_for_is_not_believed() {
        let mut inbox = Inbox::default();
        assert_eq!(inbox.next(|_| 1_000), Some(0));
        assert!((1..BYTES).all(|_| inbox.next(|_| 0) == Some(0)));
        assert_eq!(inbox.next(|_| 0), None);
    }
}
