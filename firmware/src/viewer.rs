//! From what the controllers say to matrices.

use controls::{Button, ControllerState};
use fixed::types::{I2F14, I2F30, I16F16, I32F32};
use geometry::{Angle, DirectionalLight, Matrix};

use crate::scene::{Scene, TORUS_RADIUS};
use crate::style::Style;

/// How the scene is seen in one frame.
#[derive(Debug, Clone, Copy)]
pub struct View {
    /// Model to world space.
    pub model: Matrix,
    /// Model to clip space.
    pub model_to_clip: Matrix,
    /// The light, in world space.
    pub light: DirectionalLight,
    /// How the mesh is drawn.
    pub style: Style,
}

/// How space becomes flat.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Projection {
    /// The farther, the smaller.
    #[default]
    Perspective,
    /// Parallel.
    Orthographic,
}

/// How near and far zooming goes, as multiples of the scene's own distance.
const ZOOM_RANGE: (I16F16, I16F16) = (I16F16::lit("0.5"), I16F16::lit("1.8"));
/// What a fully pushed stick changes the zoom by in a frame.
const ZOOM_RATE: I16F16 = I16F16::lit("0.02");
/// What a fully pushed stick moves the model by in a frame, in world units.
const PAN_RATE: I16F16 = I16F16::lit("0.04");
/// How far the model can be moved from the middle.
const PAN_LIMIT: I16F16 = I16F16::lit("2.5");
/// What a fully pushed stick turns by in a frame: 3°.
const TURN_RATE: u32 = (3u64 * (1 << 32) / 360) as u32;

/// The viewer's pose: which scene, and how far turned, moved and zoomed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Viewer {
    scene: Scene,
    /// Turns by itself in some scenes.
    travel: Angle,
    spin: Angle,
    zoom: I16F16,
    pan: [I16F16; 2],
    style: Style,
    projection: Projection,
}

impl Viewer {
    /// Returns the viewer at the beginning of a scene.
    pub fn new(scene: Scene) -> Self {
        Self {
            scene,
            travel: Angle::ZERO,
            spin: Angle::ZERO,
            zoom: I16F16::ONE,
            pan: [I16F16::ZERO; 2],
            style: Style::default(),
            projection: Projection::default(),
        }
    }

    /// Returns the scene that is shown.
    pub fn scene(&self) -> Scene {
        self.scene
    }

    /// Returns how meshes are drawn.
    pub fn style(&self) -> Style {
        self.style
    }

    /// Takes in a frame's controls. Start and Select change the scene, Triangle the style, Square
    /// the projection; while the pose is frozen nothing moves.
    pub fn update(&mut self, state: &ControllerState) {
        let count = Scene::ALL.len();
        let step = usize::from(state.pressed.contains(Button::Start))
            + (count - 1) * usize::from(state.pressed.contains(Button::Select));
        if !step.is_multiple_of(count) {
            *self = self.at_start_of(Scene::from_index((self.scene.index() + step) % count));
            return;
        }
        if state.pressed.contains(Button::Triangle) {
            self.style = self.style.next();
        }
        if state.pressed.contains(Button::Square) {
            self.projection = match self.projection {
                Projection::Perspective => Projection::Orthographic,
                Projection::Orthographic => Projection::Perspective,
            };
        }
        if state.pressed.contains(Button::L3) || state.pressed.contains(Button::R3) {
            *self = Self { travel: self.travel, ..self.at_start_of(self.scene) };
        }
        if state.frozen {
            return;
        }
        self.travel = self.travel.plus(Angle::from_bits(self.travel_rate()));
        self.spin = self.spin.plus(turned_by(state.turn()));
        let rate = |stick: I2F14, rate: I16F16| I16F16::from_num(stick).saturating_mul(rate);
        self.zoom = (self.zoom - rate(state.zoom(), ZOOM_RATE)).clamp(ZOOM_RANGE.0, ZOOM_RANGE.1);
        for (pan, stick) in self.pan.iter_mut().zip([state.pan().x, state.pan().y]) {
            *pan = (*pan + rate(stick, PAN_RATE)).clamp(-PAN_LIMIT, PAN_LIMIT);
        }
    }

    /// The beginning of a scene, drawn in the same way.
    fn at_start_of(&self, scene: Scene) -> Self {
        Self { style: self.style, projection: self.projection, ..Self::new(scene) }
    }

    /// What the scene moves by itself in a frame, in 2⁻³² turns.
    fn travel_rate(&self) -> u32 {
        match self.scene {
            Scene::Plate => 0,
            Scene::Torus => (1 << 31) / 90,
            Scene::Tunnel => (1 << 31) / 180,
        }
    }

    /// Returns how the scene is seen now, with the controller's tilt.
    pub fn view(&self, state: &ControllerState) -> View {
        let roll = Matrix::rotation_z(Angle::from_degrees(state.tilt.roll));
        let pitch = Matrix::rotation_x(Angle::from_degrees(state.tilt.pitch));
        let (model, view, projection) = match self.scene {
            Scene::Plate => {
                let model = pitch.times(&roll).times(&Matrix::rotation_y(self.spin));
                (
                    model,
                    self.orbit(const { I16F16::lit("3.4") }, const { I16F16::lit("30") }),
                    self.lens(const { I16F16::lit("3.4") }),
                )
            }
            Scene::Torus => {
                let turning = Matrix::rotation_y(self.spin.plus(self.travel));
                let model = pitch.times(&roll).times(&turning);
                (
                    model,
                    self.orbit(const { I16F16::lit("4") }, const { I16F16::lit("38") }),
                    self.lens(const { I16F16::lit("4") }),
                )
            }
            Scene::Tunnel => {
                let view = Matrix::rotation_z(Angle::from_degrees(state.tilt.roll).negated());
                let view = view.times(&Matrix::rotation_x(Angle::from_degrees(state.tilt.pitch).negated()));
                let view = view.times(&Matrix::rotation_y(self.spin)).times(&self.ride());
                (
                    Matrix::IDENTITY,
                    view,
                    perspective(const { I16F16::lit("75") }, I32F32::from_num(0.1), I32F32::from_num(4)),
                )
            }
        };
        View {
            model,
            model_to_clip: projection.times(&view).times(&model),
            light: light(self.scene, &view),
            style: self.style,
        }
    }

    /// The camera above the model, looking down on its middle by `elevation` degrees.
    fn orbit(&self, distance: I16F16, elevation: I16F16) -> Matrix {
        let [x, y] = self.pan.map(I32F32::from);
        let distance = I32F32::from(distance.saturating_mul(self.zoom));
        Matrix::translation([x, y, -distance]).times(&Matrix::rotation_x(Angle::from_degrees(elevation)))
    }

    /// The projection of a model that the camera orbits at a distance.
    fn lens(&self, distance: I16F16) -> Matrix {
        let distance = I32F32::from(distance.saturating_mul(self.zoom));
        let (near, far) = match self.style {
            // As many levels of grey as can be: the model, which is about as large, and little more.
            Style::DepthGrey => {
                let reach = I32F32::from_num(1.6);
                ((distance - reach).max(I32F32::from_num(0.1)), distance + reach)
            }
            _ => (I32F32::ONE, I32F32::from_num(10)),
        };
        match self.projection {
            Projection::Perspective => perspective(const { I16F16::lit("45") }, near, far),
            Projection::Orthographic => {
                // As large as in perspective, at the orbit's middle: tan 22.5° is 0.4142.
                let half = distance * I32F32::from_num(0.4142);
                let wide = half * 4 / 3;
                Matrix::orthographic((-wide, wide), (-half, half), (near, far))
            }
        }
    }

    /// The camera inside the tube, looking along it.
    fn ride(&self) -> Matrix {
        let moved = |axis: usize| I32F32::from(self.pan[axis]) / 10;
        // The tube turns round the eye, which stays on the z axis looking along −x.
        Matrix::rotation_y(Angle::QUARTER.negated())
            .times(&Matrix::translation([I32F32::ZERO, -moved(1), -I32F32::from(TORUS_RADIUS) - moved(0)]))
            .times(&Matrix::rotation_y(self.travel))
    }
}

/// OpenGL's perspective for the 4:3 screen; the parameters are in degrees and world units.
fn perspective(field_of_view: I16F16, near: I32F32, far: I32F32) -> Matrix {
    let angle = Angle::from_degrees(field_of_view);
    Matrix::perspective(angle, I32F32::from_num(4) / 3, near, far)
}

/// The angle that a stick turns by in a frame.
fn turned_by(stick: I2F14) -> Angle {
    Angle::from_bits(((i64::from(stick.to_bits()) * i64::from(TURN_RATE)) >> 14) as u32)
}

/// The scene's light: from above on the left, or in the tunnel from the eye.
fn light(scene: Scene, view: &Matrix) -> DirectionalLight {
    match scene {
        Scene::Plate | Scene::Torus => DirectionalLight {
            // A unit vector.
            direction: [const { I2F30::lit("-0.36") }, const { I2F30::lit("0.8") }, const { I2F30::lit("0.48") }],
            colour: [255; 3],
            diffuse: const { I16F16::lit("0.75") },
            ambient: const { I16F16::lit("0.25") },
        },
        Scene::Tunnel => {
            // The view's third row: backwards, in world space.
            let [x, y, z, _] = view.rows[2];
            let direction = [x, y, z].map(I2F30::saturating_from_num);
            DirectionalLight {
                direction,
                colour: [255; 3],
                diffuse: const { I16F16::lit("0.7") },
                ambient: const { I16F16::lit("0.4") },
            }
        }
    }
}
