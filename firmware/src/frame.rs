//! One frame: a stage's objects to packets, and these to the FPGA.

use core::ops::ControlFlow;

use fpga_regs::screen::{DEPTH_FAR, Rgb332};
use fpga_regs::{Port, RenderError, Renderer, Wait};
use geometry::{
    Culling, DirectionalLight, DrawStatistics, Drawn, LitColour, LitVertices, Matrix, ObjectLight, ScreenTransform,
    ScreenVertex, Sink, Transformed, Unlit,
};

use crate::link::FrameReport;
use crate::scene::found::BlockMemory;
use crate::scene::meshes::{MAX_VERTICES, Meshes, Model};
use crate::scene::stage::{Stage, Subject};
use crate::style::{Pass, Style};

/// Words that are gathered before they go to the FPGA: most frames whole.
const BUFFER_WORDS: usize = 32 * 1024;

/// Room for a frame in the making.
pub struct FrameMemory {
    vertices: [ScreenVertex; MAX_VERTICES],
    lit: [LitColour; MAX_VERTICES],
    block: BlockMemory,
    words: [u32; BUFFER_WORDS],
}

impl FrameMemory {
    /// Empty memory, for a static.
    pub const fn new() -> Self {
        let vertex = ScreenVertex { x: 0, y: 0, depth: 0, outside: 0 };
        Self {
            vertices: [vertex; MAX_VERTICES],
            lit: [LitColour::BLACK; MAX_VERTICES],
            block: BlockMemory::new(),
            words: [0; BUFFER_WORDS],
        }
    }
}

impl Default for FrameMemory {
    fn default() -> Self {
        Self::new()
    }
}

/// Draws a stage and waits until the FPGA has passed its swap.
///
/// `ticks` is a clock that counts up; the durations in the report are its differences, without
/// the time that pushing words to the FPGA takes.
///
/// # Errors
/// [`RenderError`] of the renderer; the frame is lost, and the renderer wants a reset.
pub fn draw_frame<P: Port, W: Wait>(
    meshes: &Meshes<'_>,
    stage: &Stage,
    memory: &mut FrameMemory,
    renderer: &mut Renderer<P, W>,
    mut ticks: impl FnMut() -> u64,
) -> Result<FrameReport, RenderError> {
    let words_before = renderer.words_pushed();
    renderer.clear(Rgb332::BLACK, DEPTH_FAR)?;

    let FrameMemory { vertices, lit, block, words } = memory;
    let writer = PacketWriter::new(words, renderer, &mut ticks);
    let mut painter = Painter { vertices, lit, writer, cost: Cost::default() };
    let world_to_clip = stage.camera.projection.times(&stage.camera.view);
    for (index, pass) in stage.style.passes().iter().enumerate() {
        for object in &stage.objects {
            let place = |model: Matrix, culling, extent| Place {
                model_to_clip: world_to_clip.times(&model),
                model,
                light: &stage.light,
                culling,
                extent,
                is_first_pass: index == 0,
            };
            let found = match object.subject {
                Subject::Shape(shape) => {
                    painter.draw(meshes.of(shape), *pass, &place(object.model, object.culling, None));
                    continue;
                }
                Subject::Found => meshes.found(),
            };
            let Some((found, pass)) = found.and_then(|found| found.pass(*pass).map(|pass| (found, pass))) else {
                continue;
            };
            let culling = if found.is_two_sided() { Culling::None } else { object.culling };
            let place = place(object.model.times(found.fit()), culling, Some(found.extent()));
            for part in found.blocks() {
                // Lines of a model that has faces as well; of one without, every pass is of lines.
                if part.corners.is_empty() && pass != Pass::Lines {
                    continue;
                }
                if let Some(model) = painter.timed(|| block.decode(found.header(), &part)) {
                    painter.draw(&model, pass, &place);
                }
            }
        }
    }
    let Painter { writer, cost, .. } = painter;
    writer.finish()?;

    renderer.swap()?;
    let fence = renderer.fence()?;
    renderer.wait_fence(fence)?;
    Ok(FrameReport {
        index: 0,
        vertices: cost.statistics.vertices,
        triangles_submitted: cost.statistics.submitted,
        triangles_clipped: cost.statistics.clipped,
        triangles_drawn: cost.statistics.drawn,
        // The triangles, a clear, a swap and a fence.
        packets: cost.statistics.drawn + 3,
        words: (renderer.words_pushed() - words_before) as u32,
        vertex_ticks: cost.vertex_ticks as u32,
        face_ticks: cost.face_ticks as u32,
        score: None,
        checksum: None,
    })
}

/// A mesh's place in a frame.
struct Place<'a> {
    model_to_clip: Matrix,
    model: Matrix,
    light: &'a DirectionalLight,
    culling: Culling,
    /// Of the whole mesh that this one is a part of.
    extent: Option<[u32; 3]>,
    is_first_pass: bool,
}

/// Draws meshes, and keeps what they cost.
struct Painter<'a, P, W, T> {
    vertices: &'a mut [ScreenVertex],
    lit: &'a mut [LitColour],
    writer: PacketWriter<'a, P, W, T>,
    cost: Cost,
}

impl<P: Port, W: Wait, T: FnMut() -> u64> Painter<'_, P, W, T> {
    /// Does work that is the vertices'.
    fn timed<R>(&mut self, work: impl FnOnce() -> R) -> R {
        let start = (self.writer.ticks)();
        let result = work();
        self.cost.vertex_ticks += (self.writer.ticks)() - start;
        result
    }

    /// Draws a mesh's part of a pass.
    fn draw(&mut self, model: &Model<'_>, pass: Pass, place: &Place<'_>) {
        let Self { vertices, lit, writer, cost } = self;
        let start = (writer.ticks)();
        let extent = place.extent.unwrap_or_else(|| model.mesh.extent());
        let transform = ScreenTransform::of_extent(&place.model_to_clip, extent);
        // The caches are as large as the largest mesh.
        let Ok(transformed) = Transformed::new(&model.mesh, &transform, vertices) else { return };
        let transformed_at = (writer.ticks)();
        let light = ObjectLight::new(place.light, &place.model);
        // Lighting a vertex is a vertex's cost; what turns the light is a mesh's, and so the faces'.
        let light_at = (writer.ticks)();
        let lit = match pass {
            // The memory is as large as the largest mesh, so there is never too little.
            Pass::Smooth => transformed.light_vertices(model.looks, &light, lit).ok(),
            _ => None,
        };
        let vertices_done = (writer.ticks)();
        let pushed_before = writer.pushing;
        let statistics = draw_pass(&transformed, model, (pass, place.culling), &light, lit, writer);
        let pushing = writer.pushing - pushed_before;
        cost.vertex_ticks += transformed_at - start + (vertices_done - light_at);
        cost.face_ticks += (light_at - transformed_at) + (writer.ticks)() - vertices_done - pushing;
        // What a later pass draws again counts as drawn, not as more to draw.
        cost.add(&statistics, place.is_first_pass);
    }
}

/// What a frame's objects took, all together.
#[derive(Debug, Default)]
struct Cost {
    statistics: DrawStatistics,
    vertex_ticks: u64,
    face_ticks: u64,
}

impl Cost {
    fn add(&mut self, more: &DrawStatistics, first_pass: bool) {
        let sum = &mut self.statistics;
        sum.drawn += more.drawn;
        if first_pass {
            sum.vertices += more.vertices;
            sum.submitted += more.submitted;
            sum.clipped += more.clipped;
        }
    }
}

/// Draws an object's part of a pass.
///
/// The flat one is what most frames are, and what costs are measured on: it comes first.
fn draw_pass(
    transformed: &Transformed<'_>,
    model: &Model<'_>,
    (pass, culling): (Pass, Culling),
    light: &ObjectLight,
    lit: Option<LitVertices<'_>>,
    sink: &mut impl Sink,
) -> DrawStatistics {
    if model.mesh.faces().is_empty() {
        // A model of lines alone has nothing else to show.
        return transformed.draw_lines(model.edges, &Style::LINES, sink);
    }
    match pass {
        Pass::Flat => transformed.draw(light, culling, sink),
        Pass::Smooth => lit.map_or_else(DrawStatistics::default, |lit| transformed.draw_smooth(&lit, culling, sink)),
        Pass::Hiding => transformed.draw_unlit(Unlit::HIDING, culling, sink),
        Pass::DepthGrey => transformed.draw_unlit(Unlit::DEPTH_GREY, culling, sink),
        Pass::Lines => transformed.draw_lines(model.edges, &Style::LINES, sink),
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
