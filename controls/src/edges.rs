//! Presses and releases, kept until the frame is over.

use crate::Buttons;

/// Latches the edges of a set of buttons between two frames.
///
/// A press and its release may both come between two frames; both are then reported, and `held`
/// says that the button is up.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct EdgeLatch {
    pub(crate) held: Buttons,
    pub(crate) pressed: Buttons,
    pub(crate) released: Buttons,
}

impl EdgeLatch {
    /// Takes in what is held now and returns what has gone down since the last call.
    pub(crate) fn update(&mut self, held: Buttons) -> Buttons {
        let pressed = held & !self.held;
        self.pressed |= pressed;
        self.released |= self.held & !held;
        self.held = held;
        pressed
    }

    /// Forgets the edges, not what is held.
    pub(crate) fn end_frame(&mut self) {
        self.pressed = Buttons::NONE;
        self.released = Buttons::NONE;
    }
}

#[cfg(test)]
mod tests {
    use super::EdgeLatch;
    use crate::{Button, Buttons};

    #[test]
    fn a_tap_between_two_frames_is_kept_as_both_edges() {
        let mut edges = EdgeLatch::default();
        let cross = Buttons::from(Button::Cross);
        edges.update(cross);
        edges.update(Buttons::NONE);
        assert_eq!((edges.held, edges.pressed, edges.released), (Buttons::NONE, cross, cross));
        edges.end_frame();
        assert_eq!((edges.pressed, edges.released), (Buttons::NONE, Buttons::NONE));
    }

    #[test]
    fn the_same_buttons_again_are_no_edge() {
        let mut edges = EdgeLatch::default();
        let start = Buttons::from(Button::Start);
        assert_eq!(edges.update(start), start);
        edges.end_frame();
        assert_eq!(edges.update(start), Buttons::NONE);
        assert_eq!((edges.held, edges.pressed, edges.released), (start, Buttons::NONE, Buttons::NONE));
    }
}
