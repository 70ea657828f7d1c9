//! What the application sees.

use crate::{Battery, Buttons, Request, Source, Stick, Tilt};
use fixed::types::I2F14;

/// Holds everything that the controls say in one frame, whatever it came from.
///
/// The [table of controls](crate#what-each-control-does) tells what each is for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ControllerState {
    /// How the model lies, in degrees. While `frozen` it is what it was before the freeze.
    pub tilt: Tilt,
    /// Cross is held: the pose stays. Sticks and buttons go on, for the application to heed or not.
    pub frozen: bool,
    /// The left stick.
    pub left_stick: Stick,
    /// The right stick.
    pub right_stick: Stick,
    /// The way that the arrow keys point, 0 or ±1 in each axis; what they do to the tilt is in `tilt` already.
    pub arrows: Stick,
    /// The buttons that are down now.
    pub held: Buttons,
    /// The buttons that went down in this frame, even if they are up again.
    pub pressed: Buttons,
    /// The buttons that went up in this frame, even if they are down again.
    pub released: Buttons,
    /// The step of this frame: of those that were asked for and not yet done, the first.
    pub asked: Option<Request>,
    /// A pad has reported and not been disconnected.
    pub pad_present: bool,
    /// How full the pad's battery is.
    pub battery: Battery,
    /// What moved last: a button, a stick or a tilt. `None` before anything did. It stays when the
    /// source is disconnected.
    pub last_moved: Option<Source>,
}

impl ControllerState {
    /// Returns the way the model is pushed across the screen, right and up positive.
    #[must_use]
    pub const fn pan(&self) -> Stick {
        self.left_stick
    }

    /// Returns how fast the model spins about its upright axis, −1 to 1, to the right positive.
    #[must_use]
    pub const fn turn(&self) -> I2F14 {
        self.right_stick.x
    }

    /// Returns how fast the model comes nearer, −1 to 1, nearer positive.
    #[must_use]
    pub const fn zoom(&self) -> I2F14 {
        self.right_stick.y
    }
}
