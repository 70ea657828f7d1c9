//! One frame: a scene's mesh to packets, and these to the FPGA.

use core::ops::ControlFlow;

use fpga_regs::screen::{DEPTH_FAR, Rgb332};
use fpga_regs::{Port, RenderError, Renderer, Wait};
use geometry::{
    Culling, DrawStatistics, Drawn, LitColour, ObjectLight, ScreenTransform, ScreenVertex, Sink, Transformed, Unlit,
};

use crate::link::FrameReport;
use crate::scene::{MAX_VERTICES, Meshes, Model, Scene};
use crate::style::Style;
use crate::viewer::View;

/// Words that are gathered before they go to the FPGA: most frames whole.
const BUFFER_WORDS: usize = 32 * 1024;

/// Room for a frame in the making.
pub struct FrameMemory {
    vertices: [ScreenVertex; MAX_VERTICES],
    lit: [LitColour; MAX_VERTICES],
    words: [u32; BUFFER_WORDS],
}

impl FrameMemory {
    /// Empty memory, for a static.
    pub const fn new() -> Self {
        let vertex = ScreenVertex { x: 0, y: 0, depth: 0, outside: 0 };
        Self { vertices: [vertex; MAX_VERTICES], lit: [LitColour::BLACK; MAX_VERTICES], words: [0; BUFFER_WORDS] }
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
    renderer.clear(Rgb332::BLACK, DEPTH_FAR)?;

    let model = meshes.of(scene);
    let mesh = &model.mesh;
    let start = ticks();
    let transform = ScreenTransform::new(&view.model_to_clip, mesh);
    let Ok(transformed) = Transformed::new(mesh, &transform, &mut memory.vertices) else {
        // The cache is as large as the largest scene's mesh.
        return Ok(FrameReport::default());
    };
    let vertices_done = ticks();
    let light = ObjectLight::new(&view.light, &view.model);
    let mut writer = PacketWriter::new(&mut memory.words, renderer, &mut ticks);
    let statistics =
        draw_styled(&transformed, model, (view.style, scene.culling()), &light, &mut memory.lit, &mut writer);
    let faces_done = (writer.ticks)();
    let pushing = writer.pushing;
    writer.finish()?;

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
        face_ticks: (faces_done - vertices_done - pushing) as u32,
        checksum: None,
    })
}

/// Draws a model in a style.
///
/// The flat style is what most frames are, and what costs are measured on: it comes first.
fn draw_styled(
    transformed: &Transformed<'_>,
    model: &Model<'_>,
    (style, culling): (Style, Culling),
    light: &ObjectLight,
    lit: &mut [LitColour],
    sink: &mut impl Sink,
) -> DrawStatistics {
    match style {
        Style::Flat => transformed.draw(light, culling, sink),
        // The memory is as large as the largest scene's mesh, so there is never too little.
        Style::Smooth => transformed.draw_smooth(model.looks, light, lit, culling, sink).unwrap_or_default(),
        Style::Wire => transformed.draw_lines(model.edges, &Style::LINES, sink),
        Style::HiddenLines => {
            let hiding = transformed.draw_unlit(Unlit::HIDING, culling, sink);
            let lines = transformed.draw_lines(model.edges, &Style::LINES, sink);
            DrawStatistics { drawn: hiding.drawn + lines.drawn, ..hiding }
        }
        Style::DepthGrey => transformed.draw_unlit(Unlit::DEPTH_GREY, culling, sink),
    }
}

/// Gathers packets and pushes them in long bursts.
struct PacketWriter<'a, P, W, T> {
    buffer: &'a mut [u32; BUFFER_WORDS],
    used: usize,
    renderer: &'a mut Renderer<P, W>,
    ticks: &'a mut T,
    /// Ticks spent pushing in the midst of a mesh.
    pushing: u64,
    error: Option<RenderError>,
}

impl<'a, P: Port, W: Wait, T: FnMut() -> u64> PacketWriter<'a, P, W, T> {
    fn new(buffer: &'a mut [u32; BUFFER_WORDS], renderer: &'a mut Renderer<P, W>, ticks: &'a mut T) -> Self {
        Self { buffer, used: 0, renderer, ticks, pushing: 0, error: None }
    }

    /// Pushes what is left.
    fn finish(mut self) -> Result<(), RenderError> {
        self.push();
        self.error.map_or(Ok(()), Err)
    }

    fn push(&mut self) {
        if self.error.is_none() {
            self.error = self.renderer.push(&self.buffer[..self.used]).err();
        }
        self.used = 0;
    }

    #[cold]
    #[inline(never)]
    fn make_room(&mut self) -> ControlFlow<()> {
        let start = (self.ticks)();
        self.push();
        self.pushing += (self.ticks)() - start;
        if self.error.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

impl<P: Port, W: Wait, T: FnMut() -> u64> Sink for PacketWriter<'_, P, W, T> {
    #[inline(always)]
    fn room<const N: usize>(&mut self) -> Option<&mut [u32; N]> {
        if self.used > BUFFER_WORDS - N && self.make_room().is_break() {
            return None;
        }
        self.buffer[self.used..].first_chunk_mut()
    }

    #[inline(always)]
    fn take<const N: usize>(&mut self, _: Drawn<'_>) {
        self.used += N;
    }
}
