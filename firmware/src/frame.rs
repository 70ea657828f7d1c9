//! One frame: a scene's mesh to packets, and these to the FPGA.

use fpga_regs::packet::{Clear, FlatTriangle};
use fpga_regs::screen::{DEPTH_FAR, Rgb332};
use fpga_regs::{Port, RenderError, Renderer, Wait};
use geometry::{DrawError, FaceLight, ScreenTransform, ScreenVertex, Sink, Transformed};

use crate::link::FrameReport;
use crate::scene::{MAX_VERTICES, Meshes, Scene};
use crate::viewer::View;

/// Words that are gathered before they go to the FPGA: most frames whole.
const BUFFER_WORDS: usize = 32 * 1024;

/// Room for a frame in the making.
pub struct FrameMemory {
    vertices: [ScreenVertex; MAX_VERTICES],
    words: [u32; BUFFER_WORDS],
}

impl FrameMemory {
    /// Empty memory, for a static.
    pub const fn new() -> Self {
        let vertex = ScreenVertex { x: 0, y: 0, depth: 0, outside: 0 };
        Self { vertices: [vertex; MAX_VERTICES], words: [0; BUFFER_WORDS] }
    }
}

impl Default for FrameMemory {
    fn default() -> Self {
        Self::new()
    }
}

/// Draws a scene and waits until the FPGA has passed its swap.
///
/// `ticks` is a clock that counts up; the durations in the report are its differences, without
/// the time that pushing words to the FPGA takes.
///
/// # Errors
/// [`RenderError`] of the renderer; the frame is lost, and the renderer wants a reset.
pub fn draw_frame<P: Port, W: Wait>(
    (meshes, scene): (&Meshes<'_>, Scene),
    view: &View,
    memory: &mut FrameMemory,
    renderer: &mut Renderer<P, W>,
    mut ticks: impl FnMut() -> u64,
) -> Result<FrameReport, RenderError> {
    let words_before = renderer.words_pushed();
    renderer.push(&Clear { colour: Rgb332::BLACK, depth: DEPTH_FAR }.encode())?;

    let mesh = meshes.of(scene);
    let start = ticks();
    let transform = ScreenTransform::new(&view.model_to_clip, mesh);
    let transformed = match Transformed::new(mesh, &transform, &mut memory.vertices) {
        Ok(transformed) => transformed,
        Err(error) => return render_error(error).map(|()| FrameReport::default()),
    };
    let vertices_done = ticks();
    let light = FaceLight::new(&view.light, &view.model);
    let mut writer = PacketWriter { buffer: &mut memory.words, used: 0, renderer, ticks: &mut ticks, pushing: 0 };
    let drawn = transformed.draw(&light, scene.culling(), &mut writer);
    let pushing_inside = writer.pushing;
    let faces_done = (writer.ticks)();
    writer.flush()?;
    let statistics = match drawn {
        Ok(statistics) => statistics,
        Err(error) => return render_error(error).map(|()| FrameReport::default()),
    };

    renderer.swap()?;
    let fence = renderer.fence()?;
    renderer.wait_fence(fence)?;
    Ok(FrameReport {
        index: 0,
        vertices: statistics.vertices,
        triangles_submitted: statistics.submitted,
        triangles_clipped: statistics.clipped,
        triangles_drawn: statistics.drawn,
        // The triangles, a clear, a swap and a fence.
        packets: statistics.drawn + 3,
        words: (renderer.words_pushed() - words_before) as u32,
        vertex_ticks: (vertices_done - start) as u32,
        face_ticks: (faces_done - vertices_done - pushing_inside) as u32,
        checksum: None,
    })
}

/// The cache is as large as the largest scene's mesh, so what is left is the renderer's error.
fn render_error(error: DrawError<RenderError>) -> Result<(), RenderError> {
    match error {
        DrawError::Sink(error) => Err(error),
        DrawError::CacheTooSmall { .. } => Ok(()),
    }
}

/// Gathers packets and pushes them in long bursts.
struct PacketWriter<'a, P, W, T> {
    buffer: &'a mut [u32; BUFFER_WORDS],
    used: usize,
    renderer: &'a mut Renderer<P, W>,
    ticks: &'a mut T,
    /// Ticks spent pushing.
    pushing: u64,
}

impl<P: Port, W: Wait, T: FnMut() -> u64> PacketWriter<'_, P, W, T> {
    fn flush(&mut self) -> Result<(), RenderError> {
        let words = &self.buffer[..self.used];
        self.used = 0;
        self.renderer.push(words)
    }

    /// Pushes what is there in the midst of a mesh.
    #[cold]
    #[inline(never)]
    fn make_room(&mut self) -> Result<(), RenderError> {
        let start = (self.ticks)();
        let result = self.flush();
        self.pushing += (self.ticks)() - start;
        result
    }
}

impl<P: Port, W: Wait, T: FnMut() -> u64> Sink for PacketWriter<'_, P, W, T> {
    type Error = RenderError;

    #[inline(always)]
    fn triangle(&mut self, triangle: &FlatTriangle, _: [&ScreenVertex; 3], _: [u8; 3]) -> Result<(), RenderError> {
        if self.used > BUFFER_WORDS - FlatTriangle::WORDS {
            self.make_room()?;
        }
        if let Some(room) = self.buffer[self.used..].first_chunk_mut() {
            *room = triangle.encode();
            self.used += FlatTriangle::WORDS;
        }
        Ok(())
    }
}
