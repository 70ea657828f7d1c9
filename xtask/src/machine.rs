//! Something that runs the application and can be stepped frame by frame: QEMU, the DE1-SoC's simulator,
//! or this process.

mod emulated;
mod host;
mod simulated;

use anyhow::bail;
use controls::serial::{self, Decoder, FRAME_SIZE_MAXIMUM, kind};
use firmware::link::{self, BoardMessage, Fault, FrameReport, HostMessage, Status};
use firmware::scene::Scene;
use firmware::style::Style;

use crate::picture::Picture;
use crate::qemu::ICOUNT_SHIFT;

pub use emulated::Emulated;
pub use host::{with_host, with_host_and_mesh, with_recording_host};
pub use simulated::Simulated;

/// A board's end of the link, and its screen.
pub trait Machine {
    /// Sends bytes over the link.
    ///
    /// # Errors
    /// When the board does not take them in time.
    fn send(&mut self, bytes: &[u8]) -> anyhow::Result<()>;

    /// Returns the next byte of the link; `what` names what is waited for.
    ///
    /// # Errors
    /// When no byte comes in time, with what the board's console said last.
    fn receive(&mut self, what: &str) -> anyhow::Result<u8>;

    /// Returns the checksum of what the machine's screen shows, and if wanted the picture: 640×480.
    ///
    /// # Errors
    /// When the screen cannot be read, or shows what no framebuffer can hold.
    fn screen(&mut self) -> anyhow::Result<(u32, Picture)>;

    /// Returns how long an instruction takes, in nanoseconds of the machine's time: QEMU's, unless it is another.
    fn nanoseconds_per_instruction(&self) -> f64 {
        f64::from(1_u32 << ICOUNT_SHIFT)
    }

    /// Ends the machine.
    ///
    /// # Errors
    /// When it does not end.
    fn end(self: Box<Self>) -> anyhow::Result<()> {
        Ok(())
    }
}

/// Who is at the other end of the link.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Identity {
    /// Ticks of a report's durations in a second.
    pub ticks_per_second: u32,
    /// How many scenes there are.
    pub scenes: u8,
    /// How long an instruction takes.
    pub nanoseconds_per_instruction: f64,
}

/// The PC's end of the link.
pub struct Link<'a, M: ?Sized> {
    machine: &'a mut M,
    decoder: Decoder,
}

impl<'a, M: Machine + ?Sized> Link<'a, M> {
    /// Returns the PC's end of a machine's link.
    pub fn new(machine: &'a mut M) -> Self {
        Self { machine, decoder: Decoder::new() }
    }

    /// Asks who is there.
    ///
    /// # Errors
    /// When nobody answers in time, or in another protocol.
    pub fn identify(&mut self) -> anyhow::Result<Identity> {
        match self.ask(HostMessage::Identify, "the firmware's answer")? {
            BoardMessage::Hello { ticks_per_second, scenes } => {
                let nanoseconds_per_instruction = self.machine.nanoseconds_per_instruction();
                Ok(Identity { ticks_per_second, scenes, nanoseconds_per_instruction })
            }
            other => bail!("the firmware answers {other:?} when asked who it is: build both from the same source"),
        }
    }

    /// Starts a scene afresh; from here on frames come only by [`step`](Self::step).
    ///
    /// # Errors
    /// As [`identify`](Self::identify), and when there is no such scene.
    pub fn begin(&mut self, scene: u8) -> anyhow::Result<()> {
        match self.ask(HostMessage::Begin { scene }, "the scene to begin")? {
            BoardMessage::Begun { scene: begun } if begun == scene => Ok(()),
            other => bail!("the firmware answers {other:?} when scene {scene} should begin"),
        }
    }

    /// Hands a controller's report to the machine.
    ///
    /// # Errors
    /// When the board does not take it in time.
    pub fn report(&mut self, kind: u8, payload: &[u8]) -> anyhow::Result<()> {
        let mut buffer = [0; FRAME_SIZE_MAXIMUM];
        let bytes = serial::encode(kind, payload, &mut buffer).map_err(|error| anyhow::anyhow!("{error}"))?;
        self.machine.send(bytes)
    }

    /// Hands a DualShock 3's report to the machine.
    ///
    /// # Errors
    /// As [`report`](Self::report).
    pub fn dualshock3(&mut self, report: &[u8]) -> anyhow::Result<()> {
        self.report(kind::DUALSHOCK3, report)
    }

    /// Sends bytes as they are, for tests of a bad line.
    ///
    /// # Errors
    /// When the board does not take them in time.
    pub fn send_raw(&mut self, bytes: &[u8]) -> anyhow::Result<()> {
        self.machine.send(bytes)
    }

    /// Orders a fault; the firmware ends with a report on its console.
    ///
    /// # Errors
    /// When the board does not take the message in time.
    pub fn fault(&mut self, fault: Fault) -> anyhow::Result<()> {
        self.tell(HostMessage::Fault(fault))
    }

    /// Asks how it goes.
    ///
    /// # Errors
    /// When no answer comes in time.
    pub fn status(&mut self) -> anyhow::Result<Status> {
        match self.ask(HostMessage::Ask, "how it goes")? {
            BoardMessage::Status(status) => Ok(status),
            other => bail!("the firmware answers {other:?} when asked how it goes"),
        }
    }

    /// Lets the machine draw frames by itself again.
    ///
    /// # Errors
    /// When the board does not take the message in time.
    pub fn run_freely(&mut self) -> anyhow::Result<()> {
        self.tell(HostMessage::Run)
    }

    /// Has the machine show another scene, or draw in another style.
    ///
    /// # Errors
    /// When the board does not take the message in time.
    pub fn show(&mut self, scene: Option<Scene>, style: Option<Style>) -> anyhow::Result<()> {
        let (scene, style) = (scene.map(|scene| scene.index() as u8), style.map(|style| style.index() as u8));
        self.tell(HostMessage::Show { scene, style })
    }

    /// Draws a frame and returns the board's report of it.
    ///
    /// # Errors
    /// When no report comes in time, or the board could not draw.
    pub fn step(&mut self) -> anyhow::Result<FrameReport> {
        match self.ask(HostMessage::Step, "a frame")? {
            BoardMessage::Frame(report) => Ok(report),
            BoardMessage::Failed => bail!("the board could not draw the frame; its console says why"),
            other => bail!("the firmware answers {other:?} when a frame should be drawn"),
        }
    }

    /// Returns the machine's screen, as [`Machine::screen`].
    ///
    /// # Errors
    /// As [`Machine::screen`].
    pub fn screen(&mut self) -> anyhow::Result<(u32, Picture)> {
        self.machine.screen()
    }

    fn tell(&mut self, message: HostMessage) -> anyhow::Result<()> {
        let mut buffer = [0; FRAME_SIZE_MAXIMUM];
        let bytes =
            link::encode(link::HOST_MESSAGE, &message, &mut buffer).map_err(|error| anyhow::anyhow!("{error}"))?;
        self.machine.send(bytes)
    }

    fn ask(&mut self, message: HostMessage, what: &str) -> anyhow::Result<BoardMessage> {
        self.tell(message)?;
        loop {
            let byte = self.machine.receive(what)?;
            // A damaged frame is as good as none: the answer that it was does not come.
            if let Some(Ok(frame)) = self.decoder.feed(byte)
                && frame.kind == link::BOARD_MESSAGE
                && let Some(message) = link::decode(frame.payload)
            {
                return Ok(message);
            }
        }
    }
}
