//! Steps that keys ask for, one a frame.

use crate::{Button, Buttons};

/// Names a step that is asked for by a tap, and again in every frame while the key is down.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum Request {
    /// Left arrow, or left on the D-pad.
    Left = 0,
    /// Right arrow, or right on the D-pad.
    Right = 1,
    /// Up arrow, or up on the D-pad.
    Up = 2,
    /// Down arrow, or down on the D-pad.
    Down = 3,
    /// A key that zooms in, or R2.
    Nearer = 4,
    /// A key that zooms out, or L2.
    Farther = 5,
}

impl Request {
    pub(crate) const ALL: [Self; 6] = [Self::Left, Self::Right, Self::Up, Self::Down, Self::Nearer, Self::Farther];

    /// The buttons that ask for each, in the order of [`ALL`](Self::ALL).
    const BUTTONS: [Button; Self::ALL.len()] =
        [Button::Left, Button::Right, Button::Up, Button::Down, Button::R2, Button::L2];

    const fn bit(self) -> u8 {
        1 << self as u8
    }
}

/// Holds a set of steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Requests(u8);

impl Requests {
    /// Returns what these buttons ask for.
    pub(crate) fn of_buttons(held: Buttons) -> Self {
        let asked = Request::ALL.into_iter().zip(Request::BUTTONS).filter(|(_, button)| held.contains(*button));
        asked.map(|(request, _)| request).collect()
    }

    /// Returns what either set has.
    pub(crate) fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl FromIterator<Request> for Requests {
    fn from_iter<I: IntoIterator<Item = Request>>(requests: I) -> Self {
        requests.into_iter().fold(Self::default(), |set, request| Self(set.0 | request.bit()))
    }
}

/// Keeps what was asked for until its frame comes, in the order of asking.
///
/// A step waits at most once. One whose key is still down when its frame ends asks again, behind those that
/// wait already: of two keys that are held, each has every other frame. A key that was typed at a terminal, which
/// tells of no release, asks once.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct RequestLatch {
    waiting: [Option<Request>; Request::ALL.len()],
    held: Requests,
    /// Of those that are held, the ones that ask for one step alone.
    once: Requests,
}

impl RequestLatch {
    /// Takes in what is asked for now: what was not before queues up.
    pub(crate) fn update(&mut self, held: Requests) {
        let before = core::mem::replace(&mut self.held, held);
        self.once.0 &= held.0;
        self.ask(Requests(held.0 & !before.0));
    }

    /// Has those of these that are held ask no further until they are let go.
    pub(crate) fn ask_once(&mut self, requests: Requests) {
        self.once.0 |= requests.0 & self.held.0;
    }

    /// Returns what was asked for first.
    pub(crate) fn first(&self) -> Option<Request> {
        self.waiting[0]
    }

    /// Takes away what was asked for first.
    pub(crate) fn end_frame(&mut self) {
        self.waiting[0] = None;
        self.waiting.rotate_left(1);
        self.ask(Requests(self.held.0 & !self.once.0));
    }

    fn ask(&mut self, requests: Requests) {
        for request in Request::ALL.into_iter().filter(|request| requests.0 & request.bit() != 0) {
            if !self.waiting.contains(&Some(request))
                && let Some(free) = self.waiting.iter_mut().find(|waiting| waiting.is_none())
            {
                *free = Some(request);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Request, RequestLatch, Requests};
    use std::vec::Vec;

    fn held(requests: &[Request]) -> Requests {
        requests.iter().copied().collect()
    }

    /// The steps of so many frames.
    fn frames(latch: &mut RequestLatch, count: usize) -> Vec<Option<Request>> {
        let frame = |_| {
            let first = latch.first();
            latch.end_frame();
            first
        };
        (0..count).map(frame).collect()
    }

    #[test]
    fn taps_between_two_frames_are_done_one_a_frame_in_their_order() {
        let mut latch = RequestLatch::default();
        for tap in [Request::Nearer, Request::Left, Request::Nearer, Request::Up] {
            latch.update(held(&[tap]));
            latch.update(held(&[]));
        }
        let expected = [Some(Request::Nearer), Some(Request::Left), Some(Request::Up), None];
        assert_eq!(frames(&mut latch, 4), expected);
    }

    #[test]
    fn keys_that_are_held_take_turns_and_stop_when_let_go() {
        let mut latch = RequestLatch::default();
        latch.update(held(&[Request::Farther]));
        latch.update(held(&[Request::Farther, Request::Down]));
        let [down, farther] = [Some(Request::Down), Some(Request::Farther)];
        assert_eq!(frames(&mut latch, 5), [farther, down, farther, down, farther]);
        latch.update(held(&[]));
        assert_eq!(frames(&mut latch, 3), [down, farther, None], "what was asked for is done");
    }

    #[test]
    fn all_of_them_fit() {
        let mut latch = RequestLatch::default();
        for _ in 0..3 {
            latch.update(held(&Request::ALL));
            latch.update(held(&[]));
        }
        assert_eq!(frames(&mut latch, 7), [&Request::ALL.map(Some)[..], &[None]].concat());
    }
}
