//! The application: reads controllers, draws frames, talks to a PC.

use core::fmt::{self, Write};

use controls::Button;
use controls::serial::{Decoder, FRAME_SIZE_MAXIMUM, Typed, kind};
use fpga_regs::{RenderError, Renderer, Wait};
use geometry::MeshError;

use crate::board::Board;
use crate::frame::{FrameMemory, draw_frame};
use crate::hush::Hush;
use crate::inbox::Inbox;
use crate::intake::Intake;
use crate::legend;
use crate::link::{self, BoardMessage, FrameReport, HostMessage, Status};
use crate::scene::Scene;
use crate::scene::found::Found;
use crate::scene::meshes::{MeshMemory, Meshes};
use crate::style::{Manner, Style};
use crate::viewer::Viewer;

/// Bytes of the link that a round takes in: at 115,200 baud 192 come in a frame's time.
const LINK_BYTES: usize = 512;

/// Memory that the application works in; large, so a static.
#[derive(Default)]
pub struct Memory {
    meshes: MeshMemory,
    frame: FrameMemory,
}

impl Memory {
    /// Empty memory, for a static.
    pub const fn new() -> Self {
        Self { meshes: MeshMemory::new(), frame: FrameMemory::new() }
    }
}

/// Meshes that are ready to be drawn, and the scene to begin with.
pub struct Prepared<'a> {
    meshes: Meshes<'a>,
    frame: &'a mut FrameMemory,
    scene: Scene,
}

impl<'a> Prepared<'a> {
    /// Makes the built-in meshes, and checks a mesh file that was left in memory: the console is told of one, whatever
    /// it is, and it makes its scene the first. All of it is read, which takes a while for a large one.
    ///
    /// # Errors
    /// [`MeshError`] if a built-in mesh is malformed.
    pub fn new(board: &mut impl Board, memory: &'a mut Memory) -> Result<Self, MeshError> {
        let mut meshes = Meshes::new(&mut memory.meshes)?;
        let scene = take_mesh_file(board, &mut meshes);
        Ok(Self { meshes, frame: &mut memory.frame, scene })
    }
}

/// The viewer on one board.
pub struct Application<'a, B: Board, W> {
    board: B,
    renderer: Renderer<B::Port, W>,
    meshes: Meshes<'a>,
    frame_memory: &'a mut FrameMemory,
    intake: Intake,
    viewer: Viewer,
    decoder: Decoder,
    inbox: Inbox,
    hush: Hush,
    /// Until the line has carried a frame's first byte.
    typed: Option<Typed>,
    frame: u32,
    /// When a frame ended last, in ticks, and the longest time between two since a PC asked.
    frame_end: u64,
    slowest_frame: u64,
    /// Draws only when a PC says so.
    stepping: bool,
}

impl<'a, B: Board, W: Wait> Application<'a, B, W> {
    /// Returns the application on a board and its renderer, at the beginning of the first scene.
    pub fn new(board: B, renderer: Renderer<B::Port, W>, prepared: Prepared<'a>) -> Self {
        let Prepared { meshes, frame, scene } = prepared;
        Self {
            board,
            renderer,
            meshes,
            frame_memory: frame,
            intake: Intake::new(),
            viewer: Viewer::new(scene),
            decoder: Decoder::new(),
            inbox: Inbox::default(),
            hush: Hush::new(B::TICKS_PER_SECOND.into()),
            typed: Some(Typed::new()),
            frame: 0,
            frame_end: 0,
            slowest_frame: 0,
            stepping: false,
        }
    }

    /// Says on the console what runs, and on what.
    pub fn greet(&mut self) {
        let capabilities = self.renderer.capabilities();
        // A console that takes nothing leaves nobody to tell.
        let _ = writeln!(
            self.board.console(),
            "Halfspace {} on {}: {} pixel units, FIFO of {} words; {}",
            env!("CARGO_PKG_VERSION"),
            B::NAME,
            capabilities.pixel_units(),
            capabilities.fifo_depth(),
            B::LACKS
        );
        let _ = legend::tell(self.viewer.scene(), self.board.console());
    }

    /// Takes in what controllers and the PC have said, and draws a frame unless a PC steps them.
    ///
    /// A frame that fails is reported and the renderer reset, so that the next one may succeed.
    pub fn run_once(&mut self) {
        let unreadable = self.board.poll_controllers(&mut self.intake);
        if unreadable > 0 {
            self.complain(format_args!("{unreadable} controller reports could not be read"));
        }
        self.poll_link();
        if let Some(count) = self.hush.kept_back(self.board.ticks()) {
            let _ = writeln!(self.board.console(), "{count} more complaints of the link or the controllers");
        }
        if self.stepping {
            self.board.sleep();
        } else {
            if let Err(error) = self.draw() {
                self.recover(error);
            }
            self.board.pace();
        }
    }

    /// Draws the next frame from what the controllers have said.
    ///
    /// # Errors
    /// [`RenderError`] of the renderer, which then wants a reset.
    pub fn draw(&mut self) -> Result<FrameReport, RenderError> {
        let state = self.intake.state();
        let before = (self.viewer.scene(), self.viewer.manner(), self.viewer.mode());
        self.viewer.update(&state);
        self.intake.end_frame();
        self.tell_changes(before, state.pressed.contains(Button::Ps));
        let Self { board, viewer, .. } = self;
        // A console that takes nothing leaves nobody to tell.
        let _ = viewer.tell(board.console());
        let score = viewer.score();
        board.show_score(score);
        let stage = self.viewer.stage(&state);
        let Self { board, renderer, meshes, frame_memory, .. } = self;
        let report = draw_frame(meshes, &stage, frame_memory, renderer, || board.ticks())?;
        let checksum = if self.stepping { self.board.picture_checksum(self.renderer.port()) } else { None };
        let report = FrameReport { index: self.frame, score, checksum, ..report };
        self.frame = self.frame.wrapping_add(1);
        self.board.heartbeat(self.frame);
        let now = self.board.ticks();
        if self.frame > 1 {
            self.slowest_frame = self.slowest_frame.max(now.wrapping_sub(self.frame_end));
        }
        self.frame_end = now;
        Ok(report)
    }

    /// Handles one message of a PC.
    pub fn handle(&mut self, message: HostMessage) {
        match message {
            HostMessage::Identify => {
                let (ticks_per_second, scenes) = (B::TICKS_PER_SECOND, Scene::ALL.len() as u8);
                self.send(&BoardMessage::Hello { ticks_per_second, scenes });
            }
            HostMessage::Begin { scene } => {
                self.intake = Intake::new();
                self.viewer = Viewer::new(Scene::from_index(scene.into()));
                self.frame = 0;
                self.stepping = true;
                self.send(&BoardMessage::Begun { scene: self.viewer.scene().index() as u8 });
            }
            HostMessage::Step => match self.draw() {
                Ok(report) => self.send(&BoardMessage::Frame(report)),
                Err(error) => {
                    self.recover(error);
                    self.send(&BoardMessage::Failed);
                }
            },
            HostMessage::Show { scene, style } => self.show(scene, style),
            HostMessage::Run => self.stepping = false,
            HostMessage::Ask => {
                let slowest_frame_ticks = u32::try_from(self.slowest_frame).unwrap_or(u32::MAX);
                let (ticks, frames, tally) = (self.board.ticks(), self.frame, self.intake.tally());
                self.send(&BoardMessage::Status(Status { ticks, frames, slowest_frame_ticks, tally }));
                self.slowest_frame = 0;
            }
            #[cfg(all(target_arch = "arm", feature = "fault-injection"))]
            HostMessage::Fault(fault) => crate::armv7a::fault_injection::inject(fault),
            #[cfg(not(all(target_arch = "arm", feature = "fault-injection")))]
            HostMessage::Fault(_) => {
                let _ = writeln!(self.board.console(), "link: this firmware commits no faults");
            }
        }
    }

    /// Returns the board.
    pub fn board(&mut self) -> &mut B {
        &mut self.board
    }

    /// Returns the board and the renderer, for what the application does not do.
    pub fn parts(&mut self) -> (&mut B, &mut Renderer<B::Port, W>) {
        (&mut self.board, &mut self.renderer)
    }

    /// Says on the console what the last update has changed, and the legend if that was asked for.
    fn tell_changes(&mut self, (scene, manner, mode): (Scene, Manner, Option<&'static str>), wants_legend: bool) {
        let Self { board, viewer, .. } = self;
        let (now, console) = (viewer.manner(), board.console());
        // A console that takes nothing leaves nobody to tell.
        let _ = match (wants_legend, viewer.scene() != scene) {
            (true, _) => legend::tell(viewer.scene(), console),
            (false, true) => legend::tell_scene(viewer.scene(), console),
            _ => Ok(()),
        };
        if now.style != manner.style {
            let _ = writeln!(console, "style: {}", now.style.name());
        }
        if now.projection != manner.projection {
            let _ = writeln!(console, "projection: {}", now.projection.name());
        }
        if viewer.scene() == scene
            && let Some(now) = viewer.mode().filter(|now| mode != Some(*now))
        {
            let _ = writeln!(console, "mode: {now}");
        }
    }

    /// Shows another scene, or in another style, as a PC wants it.
    fn show(&mut self, scene: Option<u8>, style: Option<u8>) {
        let known_scene = scene.map(|scene| Scene::ALL.get(usize::from(scene)).copied());
        let known_style = style.map(|style| Style::from_index(style.into()));
        if let (Some(None), _) | (_, Some(None)) = (known_scene, known_style) {
            let (scenes, styles) = (Scene::ALL.len() - 1, Style::ALL.len() - 1);
            let _ = writeln!(
                self.board.console(),
                "link: scene {scene:?} in style {style:?} is not there: scenes are 0 to {scenes}, styles 0 to {styles}"
            );
            return;
        }
        let before = (self.viewer.scene(), self.viewer.manner(), self.viewer.mode());
        if let Some(scene) = known_scene.flatten() {
            self.viewer = Viewer::new(scene);
        }
        if let Some(style) = known_style.flatten() {
            self.viewer.set_style(style);
        }
        self.tell_changes(before, false);
    }

    /// Takes in what the link has brought, as far as a round may: the main loop has to come round, whatever comes.
    fn poll_link(&mut self) {
        for _ in 0..LINK_BYTES {
            let board = &mut self.board;
            let Some(byte) = self.inbox.next(|bytes| board.read_link(bytes)) else { return };
            let frames = self.frame;
            self.link_byte(byte);
            if self.frame != frames {
                return;
            }
        }
    }

    fn link_byte(&mut self, byte: u8) {
        match &mut self.typed {
            Some(_) if byte == 0 => self.typed = None,
            Some(typed) => {
                if let Some(usage) = typed.feed(byte) {
                    self.intake.type_key(usage);
                }
                return;
            }
            None => {}
        }
        let message = match self.decoder.feed(byte) {
            None => return,
            Some(Ok(frame)) if frame.kind < kind::APPLICATION => {
                if let Err(error) = self.intake.accept_frame(frame.kind, frame.payload) {
                    self.complain(format_args!("link: {error}"));
                }
                return;
            }
            Some(Ok(frame)) if frame.kind == link::HOST_MESSAGE => link::decode(frame.payload),
            Some(Ok(_)) => None,
            Some(Err(error)) => return self.complain(format_args!("link: {error}")),
        };
        match message {
            Some(message) => self.handle(message),
            None => self.complain(format_args!("link: a message that this version does not know")),
        }
    }

    /// Says on the console what came in wrong, unless it has just complained: a line takes as long as half a frame, and
    /// noise can bring thousands a second.
    fn complain(&mut self, what: fmt::Arguments<'_>) {
        let Some(before) = self.hush.speak(self.board.ticks()) else { return };
        let _ = match before {
            0 => writeln!(self.board.console(), "{what}"),
            _ => writeln!(self.board.console(), "{what} ({before} more before)"),
        };
    }

    fn send(&mut self, message: &BoardMessage) {
        let mut buffer = [0; FRAME_SIZE_MAXIMUM];
        if let Ok(bytes) = link::encode(link::BOARD_MESSAGE, message, &mut buffer) {
            self.board.write_link(bytes);
        }
    }

    fn recover(&mut self, error: RenderError) {
        let _ = writeln!(self.board.console(), "renderer: {error}");
        self.board.show_fault();
        if let Err(error) = self.renderer.restart() {
            let _ = writeln!(self.board.console(), "renderer: {error}");
        }
    }
}

/// Looks for a mesh file that was left in memory, and returns the scene to begin with.
fn take_mesh_file<'a, B: Board>(board: &mut B, meshes: &mut Meshes<'a>) -> Scene {
    let Some(bytes) = board.mesh_file() else { return Scene::Plate };
    match Found::new(bytes) {
        Ok(found) => {
            let header = found.header();
            let _ = writeln!(
                board.console(),
                "mesh in memory: {} triangles, {} edges, {} vertices in {} blocks; scene `{}` shows it",
                header.faces,
                header.edges,
                header.vertices,
                header.blocks,
                Scene::Model.name()
            );
            meshes.set_found(found);
            Scene::Model
        }
        Err(error) => {
            let _ = writeln!(board.console(), "mesh in memory: {error}; the one that is built in stays");
            board.show_fault();
            Scene::Plate
        }
    }
}
