//! The driver: identity check, flow control, time-outs, recovery.
//!
//! A read over the bridge costs as much as about twenty posted writes, so the driver keeps a
//! count of FIFO words that it knows to be free and reads STATUS only when that runs out.

use crate::error::RenderError;
use crate::packet::{self, Clear, Fence, Packet};
use crate::port::{Port, Wait};
use crate::registers::{
    Capabilities, Control, Errors, ID_HALF, Interrupts, Register, Screen, Status, VERSION_MAJOR, Version,
};
use crate::screen::{HEIGHT, Rgb332, WIDTH};

/// How long the driver waits before it gives up, in microseconds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Timeouts {
    /// For CONTROL.reset to return to 0.
    pub reset_us: u32,
    /// For the FIFO to take a word. A swap may hold it back for one frame of 16.7 ms.
    pub fifo_us: u32,
    /// For a fence to be passed.
    pub fence_us: u32,
    /// Time between two looks at a register while waiting without an interrupt.
    pub poll_us: u32,
    /// The same with an interrupt, which ends a wait by itself; the look is for a lost one.
    pub interrupt_us: u32,
}

impl Default for Timeouts {
    /// Returns a reset of 1 ms, six frames for the FIFO and the fence, and a look every 20 µs,
    /// or every 1 ms beside an interrupt.
    fn default() -> Self {
        Self { reset_us: 1_000, fifo_us: 100_000, fence_us: 100_000, poll_us: 20, interrupt_us: 1_000 }
    }
}

/// The device's counters since reset; each wraps at 2³².
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Counters {
    /// Triangles taken from the stream.
    pub triangles: u32,
    /// Pixels whose depth was tested.
    pub pixels_tested: u32,
    /// Pixels written.
    pub pixels_written: u32,
    /// Clocks in which a packet was under way.
    pub busy_cycles: u32,
    /// Clocks in which a packet waited.
    pub stalled_cycles: u32,
    /// Swaps that took place.
    pub frames_shown: u32,
    /// Bad packets.
    pub bad_packets: u32,
}

/// The driver of one FPGA.
///
/// Dropping it leaves the device running; [`stop`](Renderer::stop) idles it.
#[derive(Debug)]
pub struct Renderer<P, W> {
    port: P,
    wait: W,
    timeouts: Timeouts,
    capabilities: Capabilities,
    known_free: usize,
    next_tag: u32,
    words_pushed: u64,
}

impl<P: Port, W: Wait> Renderer<P, W> {
    /// Checks the device, resets and enables it.
    ///
    /// Nothing is touched before the port says that the FPGA is configured, and nothing is
    /// written before ID, VERSION, SCREEN and CAPABILITIES are as this software needs them.
    ///
    /// # Errors
    /// [`RenderError::NotConfigured`], [`WrongId`](RenderError::WrongId),
    /// [`WrongVersion`](RenderError::WrongVersion), [`WrongScreen`](RenderError::WrongScreen),
    /// [`WrongCapabilities`](RenderError::WrongCapabilities) or
    /// [`ResetStuck`](RenderError::ResetStuck).
    pub fn new(port: P, wait: W, timeouts: Timeouts) -> Result<Self, RenderError> {
        let capabilities = Capabilities::default();
        let mut renderer = Self { port, wait, timeouts, capabilities, known_free: 0, next_tag: 1, words_pushed: 0 };
        renderer.restart()?;
        Ok(renderer)
    }

    /// Checks the device anew, resets and enables it: after its FPGA was configured again, say.
    ///
    /// # Errors
    /// As [`new`](Renderer::new).
    pub fn restart(&mut self) -> Result<(), RenderError> {
        self.port.configured()?;
        self.capabilities = identify(&mut self.port)?;
        self.reset()
    }

    /// Resets the device, forgetting all that it had not yet drawn, and enables it again.
    ///
    /// The way back from every error: a packet under way is dropped, error flags and counters
    /// are cleared. The buffers keep their pixels.
    ///
    /// # Errors
    /// [`RenderError::ResetStuck`] when CONTROL.reset does not return to 0 in time.
    pub fn reset(&mut self) -> Result<(), RenderError> {
        self.known_free = 0;
        self.port.write(Register::Control, Control::default().with_reset(true).0);
        let mut waited_us = 0;
        while Control(self.port.read(Register::Control)).reset() {
            if waited_us >= self.timeouts.reset_us {
                return Err(RenderError::ResetStuck { waited_us });
            }
            waited_us += self.pause();
        }
        self.port.write(Register::LowWater, self.low_water());
        let interrupt = self.has_interrupt();
        let control = Control::default()
            .with_enable(true)
            .with_low_water_interrupt(interrupt)
            .with_swap_interrupt(interrupt)
            .with_fence_interrupt(interrupt)
            .with_error_interrupt(interrupt);
        self.port.write(Register::Control, control.0);
        Ok(())
    }

    /// Disables the device: it takes no more words. A packet of which some have come waits.
    pub fn stop(&mut self) {
        self.port.write(Register::Control, 0);
    }

    /// Pushes words into the FIFO, waiting for space as often as needed.
    ///
    /// `words` may hold any number of packets and may end inside one.
    ///
    /// # Errors
    /// [`RenderError::FifoStuck`] when the FIFO takes nothing for [`Timeouts::fifo_us`];
    /// [`RenderError::Device`] when the device flags an error. After either, the words that are
    /// left were not pushed, and only [`reset`](Renderer::reset) gives the stream a known state.
    pub fn push(&mut self, mut words: &[u32]) -> Result<(), RenderError> {
        while !words.is_empty() {
            if self.known_free == 0 {
                self.wait_for_space(words.len())?;
            }
            let (now, later) = words.split_at(words.len().min(self.known_free));
            self.port.push(now);
            self.known_free -= now.len();
            self.words_pushed += now.len() as u64;
            words = later;
        }
        Ok(())
    }

    /// Pushes a clear of the back buffer and the depth buffer.
    ///
    /// # Errors
    /// As [`push`](Renderer::push).
    pub fn clear(&mut self, colour: Rgb332, depth: u16) -> Result<(), RenderError> {
        self.push(&Clear { colour, depth }.encode())
    }

    /// Pushes a swap: the back buffer shows from the next vertical blank on.
    ///
    /// # Errors
    /// As [`push`](Renderer::push).
    pub fn swap(&mut self) -> Result<(), RenderError> {
        self.push(&packet::swap())
    }

    /// Pushes a fence with a tag of its own and returns the tag.
    ///
    /// # Errors
    /// As [`push`](Renderer::push).
    pub fn fence(&mut self) -> Result<u32, RenderError> {
        let tag = self.next_tag;
        self.next_tag = self.next_tag.wrapping_add(1);
        self.push(&Fence { tag }.encode())?;
        Ok(tag)
    }

    /// Waits until the stream has passed the fence with `tag`.
    ///
    /// # Errors
    /// [`RenderError::FenceTimeout`] after [`Timeouts::fence_us`]; [`RenderError::Device`] when
    /// the device flags an error meanwhile.
    pub fn wait_fence(&mut self, tag: u32) -> Result<(), RenderError> {
        let mut waited_us = 0;
        loop {
            self.clear_interrupts();
            let found = self.port.read(Register::Fence);
            // Tags grow and wrap: a later one has passed this one too.
            if found.wrapping_sub(tag) as i32 >= 0 {
                return Ok(());
            }
            self.check_device()?;
            if waited_us >= self.timeouts.fence_us {
                return Err(RenderError::FenceTimeout { waited_us, expected: tag, found });
            }
            waited_us += self.pause();
        }
    }

    /// Reads STATUS and reports an error flag, if any is set.
    ///
    /// # Errors
    /// [`RenderError::Device`] with the flags.
    pub fn check_device(&mut self) -> Result<(), RenderError> {
        let status = Status(self.port.read(Register::Status));
        self.check_status(status)
    }

    /// Reads the device's counters.
    pub fn counters(&mut self) -> Counters {
        Counters {
            triangles: self.port.read(Register::Triangles),
            pixels_tested: self.port.read(Register::PixelsTested),
            pixels_written: self.port.read(Register::PixelsWritten),
            busy_cycles: self.port.read(Register::BusyCycles),
            stalled_cycles: self.port.read(Register::StalledCycles),
            frames_shown: self.port.read(Register::FramesShown),
            bad_packets: self.port.read(Register::BadPackets),
        }
    }

    /// Returns what the device said of itself when it was checked.
    pub fn capabilities(&self) -> Capabilities {
        self.capabilities
    }

    /// Returns how many words were pushed since the renderer was made.
    pub fn words_pushed(&self) -> u64 {
        self.words_pushed
    }

    /// Returns the port, for what the driver does not do.
    pub fn port(&mut self) -> &mut P {
        &mut self.port
    }

    /// The low-water mark: half of the FIFO, so that one wait buys half a FIFO of words.
    fn low_water(&self) -> u32 {
        u32::from(self.capabilities.fifo_depth() / 2)
    }

    /// Waits until the FIFO takes `pending` words or is down to its low-water mark, whichever
    /// is less, so that a nearly full FIFO is not polled for a few words at a time.
    fn wait_for_space(&mut self, pending: usize) -> Result<(), RenderError> {
        let depth = usize::from(self.capabilities.fifo_depth());
        let enough = pending.min(depth - self.low_water() as usize);
        let (mut waited_us, mut most_free) = (0, 0);
        loop {
            self.clear_interrupts();
            let status = Status(self.port.read(Register::Status));
            self.check_status(status)?;
            let free = usize::from(status.fifo_free());
            if free >= enough {
                self.known_free = free;
                return Ok(());
            }
            if free > most_free {
                (most_free, waited_us) = (free, 0);
            }
            if waited_us >= self.timeouts.fifo_us {
                return Err(RenderError::FifoStuck { waited_us, free: status.fifo_free(), pending });
            }
            waited_us += self.pause();
        }
    }

    /// Clears the interrupt status before a look at the registers that the wait is about, so that an
    /// interrupt which comes after the look is not lost.
    ///
    /// All of it: the line is a level, and one bit that nobody clears would end every later wait at once.
    fn clear_interrupts(&mut self) {
        if self.has_interrupt() {
            let all = Interrupts::default().with_low_water(true).with_swap(true).with_fence(true).with_error(true);
            self.port.write(Register::Interrupts, all.0);
        }
    }

    /// Whether the device's interrupt ends a wait: it takes a wire on one side and a handler on the
    /// other.
    fn has_interrupt(&self) -> bool {
        W::INTERRUPT && self.capabilities.interrupt()
    }

    /// Waits for one step and returns how long it took, in microseconds.
    ///
    /// A step is longer with an interrupt, because that ends it.
    fn pause(&mut self) -> u32 {
        let micros = if self.has_interrupt() { self.timeouts.interrupt_us } else { self.timeouts.poll_us };
        self.wait.wait(micros).max(1)
    }

    fn check_status(&mut self, status: Status) -> Result<(), RenderError> {
        if !status.error() {
            return Ok(());
        }
        Err(RenderError::Device {
            errors: Errors(self.port.read(Register::Errors)),
            bad_packets: self.port.read(Register::BadPackets),
        })
    }
}

/// Reads who the device is, and returns what it can do.
fn identify<P: Port>(port: &mut P) -> Result<Capabilities, RenderError> {
    let found = port.read(Register::Id);
    if found != ID_HALF {
        return Err(RenderError::WrongId { found });
    }
    let version = Version(port.read(Register::Version));
    if version.major() != VERSION_MAJOR {
        return Err(RenderError::WrongVersion { major: version.major(), minor: version.minor() });
    }
    let screen = Screen(port.read(Register::Screen));
    if (u32::from(screen.width()), u32::from(screen.height())) != (WIDTH, HEIGHT) {
        return Err(RenderError::WrongScreen { width: screen.width(), height: screen.height() });
    }
    let capabilities = Capabilities(port.read(Register::Capabilities));
    let (fifo_depth, pixel_units) = (capabilities.fifo_depth(), capabilities.pixel_units());
    if usize::from(fifo_depth) < 2 * Packet::MAX_WORDS || pixel_units == 0 {
        return Err(RenderError::WrongCapabilities { fifo_depth, pixel_units });
    }
    Ok(capabilities)
}
