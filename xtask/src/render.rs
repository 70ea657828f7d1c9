//! A model file to a picture: the board's geometry and the FPGA's software model, on this computer.

pub mod camera;
pub mod mvp;
mod smooth;

use anyhow::Context;
use firmware::style::Style;
use fixed::types::{I2F30, I16F16};
use fpga_regs::packet::{Clear, Packet, swap};
use fpga_regs::screen::{DEPTH_FAR, Rgb332};
use fpga_regs::{Renderer, Timeouts};
use geometry::pipeline::DrawStatistics;
use geometry::{
    Culling, DirectionalLight, Drawn, Matrix, ObjectLight, ScreenTransform, ScreenVertex, Sink, Transformed, Unlit,
};

use crate::model::Model;
use crate::picture::Picture;
use crate::software_fpga::{NoWait, SharedModel, with_model};

/// How a model is seen.
#[derive(Debug, Clone, Copy)]
pub struct View {
    /// Stored positions to clip space.
    pub model_to_clip: Matrix,
    /// Model to world space, for the light: turns only.
    pub model: Matrix,
    /// Which faces are drawn.
    pub culling: Culling,
    /// How they are drawn.
    pub style: Style,
}

/// A triangle as it was set up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SetUp {
    /// x, y in sixteenths of a pixel and depth 0…65,535 of each corner, counter-clockwise.
    pub corners: [[i32; 3]; 3],
    /// Red, green, blue, 0…255, lit; where it changes over the triangle, the corners' mean.
    pub colour: [u8; 3],
}

/// What drawing a model makes.
#[derive(Debug, Clone)]
pub struct Rendered {
    /// All words of the frame: clear, triangles, swap.
    pub words: Vec<u32>,
    /// The triangles of these words.
    pub triangles: Vec<SetUp>,
    /// What became of the faces.
    pub statistics: DrawStatistics,
    /// The framebuffer, 320×240.
    pub picture: Picture,
    /// The depth buffer, row 0 first.
    pub depth: Vec<u16>,
}

/// Draws a model that was made of `source`.
///
/// # Errors
/// When the model is malformed, cannot be drawn smooth, or the software model refuses the words: mistakes of this program.
pub fn render(source: &models::Model, model: &Model, view: &View) -> anyhow::Result<Rendered> {
    let mesh = model.mesh()?;
    let transform = ScreenTransform::new(&view.model_to_clip, &mesh);
    let light = ObjectLight::new(&light(), &view.model);
    let mut cache = vec![ScreenVertex::default(); mesh.positions().len()];
    let mut recorder = Recorder {
        room: [0; Packet::MAX_WORDS],
        words: Clear { colour: Rgb332::BLACK, depth: DEPTH_FAR }.encode().to_vec(),
        triangles: Vec::new(),
    };
    let transformed = Transformed::new(&mesh, &transform, &mut cache)?;
    let statistics = draw_styled(source, model, view, &transformed, &light, &mut recorder)?;
    let Recorder { mut words, triangles, .. } = recorder;
    words.extend(swap());
    let (picture, depth) = picture_of(&words)?;
    Ok(Rendered { words, triangles, statistics, picture, depth })
}

/// Draws in the view's style; a model of lines as lines.
fn draw_styled(
    source: &models::Model,
    model: &Model,
    view: &View,
    transformed: &Transformed<'_>,
    light: &ObjectLight,
    recorder: &mut Recorder,
) -> anyhow::Result<DrawStatistics> {
    let style = if model.is_wire() { Style::Wire } else { view.style };
    let lines = |recorder: &mut Recorder| transformed.draw_lines(model.edges(), &Style::LINES, recorder);
    Ok(match style {
        Style::Flat => transformed.draw(light, view.culling, recorder),
        Style::Smooth => smooth::draw(source, model.scale_log2, view, light, recorder)?,
        Style::Wire => lines(recorder),
        Style::HiddenLines => {
            let hiding = transformed.draw_unlit(Unlit::HIDING, view.culling, recorder);
            let lines = lines(recorder);
            DrawStatistics { drawn: hiding.drawn + lines.drawn, ..hiding }
        }
        Style::DepthGrey => transformed.draw_unlit(Unlit::DEPTH_GREY, view.culling, recorder),
    })
}

/// Sends words through the driver into the software model and returns what it shows.
fn picture_of(words: &[u32]) -> anyhow::Result<(Picture, Vec<u16>)> {
    with_model(|device| {
        let picture = {
            let model = SharedModel::new(device);
            let mut renderer = Renderer::new(model.clone(), NoWait, Timeouts::default())?;
            renderer.push(words)?;
            let fence = renderer.fence()?;
            renderer.wait_fence(fence)?;
            renderer.check_device().context("the software model refuses the words")?;
            model.picture()
        };
        Ok((picture, device.depth().to_vec()))
    })
}

/// The light, in world space: from above on the left, in front of the model.
fn light() -> DirectionalLight {
    // A unit vector.
    let direction = [I2F30::lit("-0.36"), I2F30::lit("0.8"), I2F30::lit("0.48")];
    DirectionalLight { direction, colour: [255; 3], diffuse: I16F16::lit("0.75"), ambient: I16F16::lit("0.25") }
}

/// Keeps triangles and their words.
struct Recorder {
    room: [u32; Packet::MAX_WORDS],
    words: Vec<u32>,
    triangles: Vec<SetUp>,
}

impl Sink for Recorder {
    fn room<const N: usize>(&mut self) -> Option<&mut [u32; N]> {
        self.room.first_chunk_mut()
    }

    fn take<const N: usize>(&mut self, drawn: Drawn<'_>) {
        self.words.extend(&self.room[..N]);
        let (corners, colour) = match drawn {
            Drawn::Flat { corners, colour } => (corners, colour),
            Drawn::Gouraud { corners, colours } => {
                let sum = |channel: usize| colours.iter().map(|colour| u32::from(colour[channel])).sum::<u32>();
                (corners, [0, 1, 2].map(|channel| ((sum(channel) + 1) / 3) as u8))
            }
            Drawn::Line { .. } => return,
        };
        self.triangles.push(SetUp { corners: corners.map(|corner| [corner.x, corner.y, corner.depth]), colour });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::camera::Fit;
    use std::path::Path;

    /// A tetrahedron, counter-clockwise seen from outside, far from the origin.
    const TETRAHEDRON: &str = "v 101 1 1\nv 101 -1 -1\nv 99 1 -1\nv 99 -1 1\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n";

    fn rendered(culling: Culling) -> Rendered {
        in_style(culling, Style::Flat)
    }

    fn in_style(culling: Culling, style: Style) -> Rendered {
        let obj = models::obj::parse_obj(TETRAHEDRON.as_bytes(), Path::new("t.obj"), |_| Ok(None)).expect("a model");
        let model = Model::new(&obj).expect("of a usual size");
        let fit = Fit::new(&obj.positions, [20.0, 30.0, 0.0]);
        let view = View {
            model_to_clip: camera::to_matrix(&fit.model_to_clip(), model.scale_log2),
            model: fit.rotation_matrix(),
            culling,
            style,
        };
        render(&obj, &model, &view).expect("it draws")
    }

    #[test]
    fn smooth_faces_have_the_colours_and_the_normals_of_their_file() {
        // A square in front of the eye, whose corners are red and whose normals lean away from the light.
        let square = "v -1 -1 0 C\nv 1 -1 0 C\nv 1 1 0 C\nv -1 1 0 C\nvn 0 0 1\nvn 0.6 -0.8 0\nf 1N 2N 3N 4N\n";
        let middle = |colour: &str, normal: &str| {
            let text = square.replace(" C", colour).replace('N', normal);
            let obj = models::obj::parse_obj(text.as_bytes(), Path::new("s.obj"), |_| Ok(None)).expect("a model");
            let model = Model::new(&obj).expect("of a usual size");
            let fit = Fit::new(&obj.positions, [0.0; 3]);
            let view = View {
                model_to_clip: camera::to_matrix(&fit.model_to_clip(), model.scale_log2),
                model: fit.rotation_matrix(),
                culling: Culling::BackFaces,
                style: Style::Smooth,
            };
            let rendered = render(&obj, &model, &view).expect("it draws");
            assert_eq!(rendered.statistics.submitted, 2);
            rendered.triangles[0].colour
        };
        let [plain, bright, dark] = [("", ""), (" 1 0 0", "//1"), (" 1 0 0", "//2")].map(|(c, n)| middle(c, n));
        assert!(plain[0] > 80 && plain[0] == plain[1], "{plain:?}");
        assert!(bright[0] > 100 && bright[1..] == [0, 0], "{bright:?}");
        // A quarter of the light comes from everywhere.
        assert!((60..70).contains(&dark[0]) && dark[1..] == [0, 0], "{dark:?}");
    }

    #[test]
    fn a_model_fills_the_picture_and_none_of_it_is_cut() {
        let rendered = rendered(Culling::BackFaces);
        let statistics = rendered.statistics;
        assert_eq!((statistics.submitted, statistics.clipped), (4, 0));
        assert!((1..4).contains(&statistics.drawn), "back faces are culled");
        assert_eq!(rendered.triangles.len(), statistics.drawn as usize);
        assert_eq!(rendered.words.len(), 2 + fpga_regs::packet::FlatTriangle::WORDS * rendered.triangles.len() + 1);
        let lit: Vec<usize> = rendered
            .picture
            .pixels()
            .enumerate()
            .filter(|(_, pixel)| *pixel != [0; 3])
            .map(|(index, _)| index)
            .collect();
        assert!(lit.len() > 5_000, "{} pixels", lit.len());
        let near = rendered.depth.iter().filter(|depth| **depth < DEPTH_FAR).count();
        assert_eq!(near, lit.len());
        let (columns, rows) = (lit.iter().map(|index| index % 320), lit.iter().map(|index| index / 320));
        assert!(columns.clone().min() > Some(0) && columns.max() < Some(319));
        assert!(rows.clone().min() > Some(0) && rows.max() < Some(239));
    }

    #[test]
    fn both_sides_of_a_closed_model_are_twice_the_triangles_and_the_same_picture() {
        let (one, both) = (rendered(Culling::BackFaces), rendered(Culling::None));
        assert_eq!(both.statistics.drawn, 4);
        assert_eq!(one.picture, both.picture);
    }

    #[test]
    fn every_style_draws_the_same_shape_in_its_own_way() {
        let covered =
            |rendered: &Rendered| -> Vec<bool> { rendered.picture.pixels().map(|pixel| pixel != [0; 3]).collect() };
        let of = |style| in_style(Culling::BackFaces, style);
        let flat = of(Style::Flat);
        assert_eq!(covered(&of(Style::Smooth)), covered(&flat));
        assert_eq!(covered(&of(Style::DepthGrey)), covered(&flat));
        let count = |style| covered(&of(style)).iter().filter(|is| **is).count();
        let (wire, hidden) = (count(Style::Wire), count(Style::HiddenLines));
        // Six edges, of which the far ones are hidden.
        assert!(wire > hidden && hidden > 300, "{wire} {hidden}");
        assert_eq!(of(Style::Wire).statistics.drawn, 6);
    }
}
