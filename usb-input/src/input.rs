//! Reading a keyboard or a pad, for as long as it is there.

use crate::descriptor::{HidInterface, PACKET_MAXIMUM};
use crate::ear::Ear;
use crate::link::{Link, Next};
use crate::mailbox::Outcome;
use crate::reader::{Reader, Reading, low_battery};
use crate::setup::{ReportType, Setup};
use crate::timing::{Moment, Wait};
use crate::{Event, Fault, Kind, Memory, Step, dualshock3};

/// A device whose reports are read.
#[derive(Debug)]
pub(crate) struct Input {
    kind: Kind,
    interface: u8,
    reader: Reader,
    ear: Ear,
    report: [u8; PACKET_MAXIMUM as usize],
    /// Bytes of the report that are there already.
    filled: usize,
    /// A short report was told of.
    short_told: bool,
    /// A low battery was told of.
    battery_told: bool,
    touch: Touch,
}

/// What a DualShock 3 is to do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Touch {
    /// It blinks by itself, until it has sent its first report.
    Blinking,
    /// Its lamp is to be lit, its motor to stop.
    Calm,
    Resting {
        frozen: bool,
    },
    /// Its motor is to run.
    Shake,
    Shaking {
        until: Moment,
    },
}

impl Input {
    pub(crate) fn new(kind: Kind, hid: &HidInterface, reader: &Reader) -> Self {
        Self {
            kind,
            interface: hid.number,
            reader: *reader,
            ear: Ear::new(hid.input, Step::Reports),
            report: [0; PACKET_MAXIMUM as usize],
            filled: 0,
            short_told: false,
            battery_told: false,
            touch: Touch::Blinking,
        }
    }

    pub(crate) const fn kind(&self) -> Kind {
        self.kind
    }

    /// Begins to listen.
    pub(crate) fn listen(&self, link: &Link, memory: &Memory) {
        link.mailbox(memory).listen(link.way(self.ear.endpoint));
    }

    /// Takes a packet.
    pub(crate) fn hear(&mut self, link: &Link, memory: &Memory, arrival: Outcome) {
        let mailbox = link.mailbox(memory);
        let Some(length) = self.ear.hear(arrival) else {
            self.filled = 0;
            return;
        };
        {
            let packet = mailbox.packet(length);
            let free = &mut self.report[self.filled..];
            let count = packet.len().min(free.len());
            free[..count].copy_from_slice(&packet[..count]);
            self.filled += count;
        }
        let size = usize::from(self.ear.endpoint.packet);
        // A report ends with a packet that is not full, or when it is whole.
        if length < size || self.filled >= self.reader.length() || self.filled + size > self.report.len() {
            self.tell(link, memory);
            self.filled = 0;
        }
        mailbox.go_on(false);
    }

    /// Tells what a report says.
    fn tell(&mut self, link: &Link, memory: &Memory) {
        let device = link.place();
        let event = match self.reader.read(&self.report[..self.filled]) {
            Reading::Keyboard(report) => Event::KeyboardReport { device, report },
            Reading::Pad(report) => {
                if self.touch == Touch::Blinking {
                    self.touch = Touch::Calm;
                }
                let low = low_battery(&report);
                if let (Some(battery), false) = (low, self.battery_told) {
                    memory.tell(Event::BatteryLow { device, battery });
                }
                self.battery_told = low.is_some();
                Event::PadReport { device, report }
            }
            Reading::Short if !self.short_told => {
                self.short_told = true;
                Event::Fault { device, fault: Fault::Report { length: self.filled as u8 } }
            }
            Reading::Short | Reading::Nothing => return,
        };
        memory.tell(event);
    }

    pub(crate) fn answered(&mut self, link: &Link, memory: &Memory, answer: Outcome) -> Result<(), Fault> {
        if !self.ear.answered(link, memory, answer)? {
            // How an output ends does not matter.
            self.touch = match self.touch {
                Touch::Shake => Touch::Shaking { until: memory.after(Wait::PULSE) },
                _ => Touch::Resting { frozen: memory.frozen.get() },
            };
        }
        Ok(())
    }

    pub(crate) fn next(&mut self, link: &mut Link, memory: &Memory) -> Result<Next, Fault> {
        if let Some(next) = self.ear.next(link, memory)? {
            return Ok(next);
        }
        if !matches!(self.reader, Reader::DualShock3) {
            return Ok(Next::Nothing);
        }
        let frozen = memory.frozen.get();
        match self.touch {
            Touch::Resting { frozen: false } if frozen && memory.config.pulse_on_freeze => self.touch = Touch::Shake,
            Touch::Resting { .. } => self.touch = Touch::Resting { frozen },
            Touch::Shaking { until } if memory.has_come(until) => self.touch = Touch::Calm,
            _ => {}
        }
        Ok(match self.touch {
            Touch::Calm | Touch::Shake => {
                let report = dualshock3::output(memory.config.player, self.touch == Touch::Shake);
                let setup = Setup::set_report(ReportType::Output, 0x01, self.interface);
                link.write(memory, Step::Reports, setup, &report)
            }
            _ => Next::Nothing,
        })
    }
}
