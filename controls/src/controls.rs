//! Pad, keyboard and panel, merged.

use crate::edges::EdgeLatch;
use crate::keyboard_state::KeyboardState;
use crate::pad_state::{Movement, PadState};
use crate::request::{RequestLatch, Requests};
use crate::{
    Button, Config, ControllerState, DualShock3Report, KeyboardReport, PanelReport, Report, ReportError, Source, Stick,
    Tilt,
};

/// Takes in reports and keeps the [`ControllerState`] that they make.
///
/// Reports may come at any rate: [`state`](Self::state) is read, and [`end_frame`](Self::end_frame)
/// called, once a frame.
#[derive(Clone, Copy, Debug)]
pub struct Controls {
    config: Config,
    pad: Option<PadState>,
    keyboard: KeyboardState,
    /// The panel's keys, as a keyboard's that do the same.
    panel: KeyboardState,
    edges: EdgeLatch,
    requests: RequestLatch,
    /// The pose as it is, seen or not.
    tilt: Tilt,
    /// The tilt is the pad's, which moved last; else it is what the keys made of it. A pad that is
    /// plugged in leads at once.
    pad_leads: bool,
    /// The pose that is seen while Cross is held.
    frozen: Option<Tilt>,
    last_moved: Option<Source>,
}

impl Controls {
    /// Starts with nothing connected, nothing held and a level tilt.
    #[must_use]
    pub fn new(config: Config) -> Self {
        Self {
            config,
            pad: None,
            keyboard: KeyboardState::default(),
            panel: KeyboardState::default(),
            edges: EdgeLatch::default(),
            requests: RequestLatch::default(),
            tilt: Tilt::LEVEL,
            pad_leads: false,
            frozen: None,
            last_moved: None,
        }
    }

    /// Takes in a report of any kind.
    ///
    /// # Errors
    ///
    /// [`ReportError`] for one that cannot be read; nothing has changed then.
    pub fn accept(&mut self, report: Report<'_>) -> Result<(), ReportError> {
        match report {
            Report::DualShock3(bytes) => self.accept_dualshock3(bytes),
            Report::Keyboard(bytes) => self.accept_keyboard(bytes),
            Report::Panel(bytes) => self.accept_panel(bytes),
            Report::Disconnected(source) => {
                self.disconnect(source);
                Ok(())
            }
        }
    }

    /// Takes in a serial frame of kind 0x01 to 0x03.
    ///
    /// # Errors
    ///
    /// [`ReportError`] for any other kind and for a payload that cannot be read; nothing has changed
    /// then.
    pub fn accept_frame(&mut self, kind: u8, payload: &[u8]) -> Result<(), ReportError> {
        self.accept(Report::from_frame(kind, payload)?)
    }

    /// Takes in a DualShock 3's input report, 49 bytes. The first one makes the pad present.
    ///
    /// # Errors
    ///
    /// [`ReportError`] as of [`DualShock3Report::parse`]; nothing has changed then.
    pub fn accept_dualshock3(&mut self, bytes: &[u8]) -> Result<(), ReportError> {
        let report = DualShock3Report::parse(bytes)?;
        let movement = match &mut self.pad {
            Some(pad) => pad.update(&report, &self.config),
            absent => {
                *absent = Some(PadState::new(&report, &self.config));
                Movement { tilt: true, anything: true }
            }
        };
        self.pad_leads |= movement.tilt;
        if movement.anything {
            self.last_moved = Some(Source::DualShock3);
        }
        self.merge();
        Ok(())
    }

    /// Takes in a boot keyboard's report, 8 bytes. One that says "too many keys" changes nothing.
    ///
    /// # Errors
    ///
    /// [`ReportError::KeyboardLength`]; nothing has changed then.
    pub fn accept_keyboard(&mut self, bytes: &[u8]) -> Result<(), ReportError> {
        if let Some(report) = KeyboardReport::parse(bytes)?
            && self.keyboard.update(report.into())
        {
            self.last_moved = Some(Source::Keyboard);
            self.merge();
        }
        Ok(())
    }

    /// Takes in a key that was typed where nobody tells when it is let go, by its usage on a USB keyboard: as if it
    /// was let go and pressed, but it asks for one step only, however long it stays down.
    pub fn type_key(&mut self, usage: u8) {
        for usage in [0, usage] {
            // Its length is right.
            let _ = self.accept_keyboard(&[0, 0, usage, 0, 0, 0, 0, 0]);
        }
        self.requests.ask_once(self.keyboard.requests().union(Requests::of_buttons(self.keyboard.held)));
    }

    /// Takes in what a board's own keys and switches are, 3 bytes.
    ///
    /// # Errors
    ///
    /// [`ReportError::PanelLength`]; nothing has changed then.
    pub fn accept_panel(&mut self, bytes: &[u8]) -> Result<(), ReportError> {
        if self.panel.update(PanelReport::parse(bytes)?.as_keys()) {
            self.last_moved = Some(Source::Panel);
            self.merge();
        }
        Ok(())
    }

    /// Lets go of everything that a source holds. The tilt stays where it is.
    pub fn disconnect(&mut self, source: Source) {
        match source {
            Source::DualShock3 => self.pad = None,
            Source::Keyboard => self.keyboard = KeyboardState::default(),
            Source::Panel => self.panel = KeyboardState::default(),
        }
        self.merge();
    }

    /// Returns what the application is to see now.
    #[must_use]
    pub fn state(&self) -> ControllerState {
        let stick = |of: fn(&PadState) -> Stick| self.pad.as_ref().map(of).unwrap_or_default();
        ControllerState {
            tilt: self.frozen.unwrap_or(self.tilt),
            frozen: self.frozen.is_some(),
            left_stick: stick(|pad| pad.left_stick).merged(self.keyboard.left_stick()).merged(self.panel.left_stick()),
            right_stick: stick(|pad| pad.right_stick)
                .merged(self.keyboard.right_stick())
                .merged(self.panel.right_stick()),
            arrows: self.keyboard.arrows().merged(self.panel.arrows()),
            held: self.edges.held,
            pressed: self.edges.pressed,
            released: self.edges.released,
            asked: self.requests.first(),
            pad_present: self.pad.is_some(),
            battery: self.pad.map(|pad| pad.battery).unwrap_or_default(),
            last_moved: self.last_moved,
        }
    }

    /// Ends a frame: forgets the edges, and turns the tilt by the arrow keys that are down
    /// or were tapped in it: a key that is down at n ends of frames turns n times, and at least once.
    pub fn end_frame(&mut self) {
        let rate = self.config.key_tilt_degrees_per_frame;
        let mut turned = false;
        for (keys, source) in [(&mut self.keyboard, Source::Keyboard), (&mut self.panel, Source::Panel)] {
            let [roll, pitch] = keys.turning();
            keys.end_frame();
            if [roll, pitch] != [0, 0] {
                let step = |way: i32| rate.saturating_mul_int(way);
                self.tilt = self.tilt.turned(step(roll), step(pitch));
                self.last_moved = Some(source);
                turned = true;
            }
        }
        if turned {
            self.keys_lead();
        }
        self.edges.end_frame();
        self.requests.end_frame();
    }

    /// Makes one of both sources after either has changed.
    fn merge(&mut self) {
        let before = self.tilt;
        let mut held = self.keyboard.held | self.panel.held;
        if let Some(pad) = &self.pad {
            held |= pad.held;
            if self.pad_leads {
                self.tilt = pad.tilt;
            }
        }
        if self.edges.update(held).contains(Button::R3) {
            self.tilt = Tilt::LEVEL;
            self.keys_lead();
        }
        let keys = self.keyboard.requests().union(self.panel.requests());
        self.requests.update(keys.union(Requests::of_buttons(held)));
        self.frozen = held.contains(Button::Cross).then_some(self.frozen.unwrap_or(before));
    }

    /// Takes the tilt from the pad until it moves again.
    fn keys_lead(&mut self) {
        self.pad_leads = false;
        if let Some(pad) = &mut self.pad {
            pad.settle();
        }
    }
}
