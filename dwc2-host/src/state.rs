//! All that the driver knows, and the one routine that takes it further.

use core::task::Waker;

use embassy_usb_driver::Speed;
use embassy_usb_driver::host::DeviceEvent;

use crate::hardware::Core;
use crate::port::Phase;
use crate::registers::{Gintmsk, Gintsts, Haint};
use crate::slot::{Activity, Fate, Slot};
use crate::{Config, Fault, PIPES, TransferError};

/// Channels that a core has at most.
pub(crate) const CHANNELS: usize = 16;

/// Wakers to call once the state is not borrowed any more.
#[derive(Default)]
pub(crate) struct Wakes([Option<Waker>; PIPES + 1]);

impl Wakes {
    pub(crate) fn wake(self) {
        self.0.into_iter().flatten().for_each(Waker::wake);
    }
}

/// What the stack is to be told about the root port.
#[derive(Default)]
pub(crate) struct News {
    /// The stack knows of a device.
    announced: bool,
    overcurrent: bool,
    disconnected: bool,
    connected: Option<Speed>,
    /// A reset of the bus that the stack asked for is over, one way or the other.
    reset_over: bool,
}

impl News {
    /// A device is there and was reset.
    pub(crate) fn connect(&mut self, speed: Speed) {
        self.connected = Some(speed);
    }

    /// The device that was there is not any more.
    pub(crate) fn disconnect(&mut self) {
        self.connected = None;
        self.disconnected |= core::mem::take(&mut self.announced);
    }

    pub(crate) fn overcurrent(&mut self) {
        self.overcurrent = true;
    }

    pub(crate) fn end_reset(&mut self) {
        self.reset_over = true;
    }

    pub(crate) fn take_reset_over(&mut self) -> bool {
        core::mem::take(&mut self.reset_over)
    }

    /// The next event, oldest first.
    pub(crate) fn take(&mut self) -> Option<DeviceEvent> {
        self.reset_over = false;
        if core::mem::take(&mut self.overcurrent) {
            return Some(DeviceEvent::Overcurrent);
        }
        if core::mem::take(&mut self.disconnected) {
            return Some(DeviceEvent::Disconnected);
        }
        let speed = self.connected.take()?;
        self.announced = true;
        Some(DeviceEvent::Connected(speed))
    }

    fn any(&self) -> bool {
        self.overcurrent || self.disconnected || self.connected.is_some() || self.reset_over
    }
}

/// The driver's state.
pub(crate) struct State<'d> {
    pub(crate) hardware: Core<'d>,
    pub(crate) config: Config,
    pub(crate) phase: Phase,
    /// When the phase is over, or has failed.
    pub(crate) phase_end: u64,
    /// Of the device on the root port.
    pub(crate) speed: Speed,
    pub(crate) news: News,
    /// A reset of the bus that the stack asked for is under way: its end is no news.
    pub(crate) reset_asked: bool,
    pub(crate) event_waker: Option<Waker>,
    pub(crate) fault: Option<Fault>,
    pub(crate) slots: [Option<Slot>; PIPES],
    /// Which pipe holds each channel.
    pub(crate) channels: [Option<usize>; CHANNELS],
    /// Channels that this core has.
    pub(crate) channel_count: usize,
    /// Frame of the last preamble.
    pub(crate) preamble_frame: Option<u16>,
    /// GINTMSK lets start-of-frame interrupts through.
    frame_interrupts: bool,
    /// Somebody who waits may go on.
    pub(crate) stirred: bool,
}

impl<'d> State<'d> {
    pub(crate) fn new(hardware: Core<'d>, config: Config) -> Self {
        Self {
            hardware,
            config,
            phase: Phase::Identify,
            phase_end: 0,
            speed: Speed::Full,
            news: News::default(),
            reset_asked: false,
            event_waker: None,
            fault: None,
            slots: [const { None }; PIPES],
            channels: [None; CHANNELS],
            channel_count: 0,
            preamble_frame: None,
            frame_interrupts: false,
            stirred: false,
        }
    }

    /// Takes what the core reports, does what is due, and says whom to wake. By `poll` it does so too for what is due
    /// by the clock.
    pub(crate) fn service(&mut self, poll: bool) -> Option<Wakes> {
        let now = self.hardware.now();
        let news = self.phase.started() && self.take_interrupts(now);
        self.advance(now, news);
        if poll {
            self.check_deadlines(now);
            self.call_turns(now);
        }
        self.launch(now);
        self.wakes()
    }

    /// Tells whether there is news of the port.
    fn take_interrupts(&mut self, now: u64) -> bool {
        let status: Gintsts = self.hardware.read();
        let frame = status.start_of_frame() && self.frame_interrupts;
        if frame || status.disconnect() {
            self.hardware.write(Gintsts::default().with_start_of_frame(frame).with_disconnect(status.disconnect()));
        }
        if status.channel() {
            let waiting = self.hardware.read::<Haint>().channels();
            for channel in (0..CHANNELS as u8).filter(|channel| waiting & 1 << channel != 0) {
                self.channel_interrupt(channel, now);
            }
        }
        status.port() || status.disconnect()
    }

    /// Which interrupts the core may raise from now on.
    pub(crate) fn set_interrupts(&mut self, frames: bool) {
        self.frame_interrupts = frames;
        if frames {
            // Those that began before are no news.
            self.hardware.write(Gintsts::default().with_start_of_frame(true));
        }
        self.hardware.write(
            Gintmsk::default().with_start_of_frame(frames).with_port(true).with_channel(true).with_disconnect(true),
        );
    }

    /// Lets the start of frames interrupt, or not.
    pub(crate) fn watch_frames(&mut self, frames: bool) {
        if frames != self.frame_interrupts {
            self.set_interrupts(frames);
        }
    }

    fn wakes(&mut self) -> Option<Wakes> {
        if !core::mem::take(&mut self.stirred) && !self.news.any() {
            return None;
        }
        let mut wakes = Wakes::default();
        let (event, pipes) = wakes.0.split_first_mut().expect("an array of PIPES + 1");
        if self.news.any() {
            *event = self.event_waker.take();
        }
        for (wake, slot) in pipes.iter_mut().zip(&mut self.slots) {
            if let Some(slot) = slot
                && (!slot.busy() || matches!(slot.activity, Activity::Exchange))
            {
                *wake = slot.waker.take();
            }
        }
        Some(wakes)
    }

    /// Ends what every pipe is at; none of them is good for anything any more.
    pub(crate) fn drop_all(&mut self) {
        self.channels = [None; CHANNELS];
        for index in 0..PIPES {
            if let Some(slot) = &mut self.slots[index] {
                slot.stale = true;
                if slot.busy() {
                    self.end(index, Err(TransferError::Disconnected));
                }
            }
        }
    }

    /// A transfer is over; its channel is free.
    pub(crate) fn end(&mut self, index: usize, result: Result<usize, TransferError>) {
        self.stirred = true;
        let Some(slot) = &mut self.slots[index] else { return };
        slot.effort.deadline = None;
        slot.activity = match (slot.effort.fate, result) {
            (Fate::Cancelled, Ok(length)) => Activity::Kept(length),
            (Fate::Cancelled, Err(_)) => Activity::Idle,
            _ => Activity::Done(result),
        };
        if slot.orphan {
            self.slots[index] = None;
        }
    }
}
