//! Ambient and directional light.

use fixed::types::{I2F30, I16F16};

use fpga_regs::screen::Rgb332;

use crate::matrix::{Matrix, Vector, dot, normalise};

mod uneven;

pub(crate) use uneven::UnevenLight;

/// Fraction bits of a face's normal and of the light's direction.
const DIRECTION_BITS: u32 = 14;
/// Fraction bits of their product.
const DOT_BITS: u32 = 2 * DIRECTION_BITS;
/// Half of an intensity's unit.
const HALF: i32 = 1 << (DOT_BITS - 9);

/// A light infinitely far away, and the light that is everywhere.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DirectionalLight {
    /// Unit vector from the scene towards the light, in world space.
    pub direction: [I2F30; 3],
    /// Its colour: red, green, blue, 0…255. The ambient light is white.
    pub colour: [u8; 3],
    /// Intensity on a surface that looks straight at the light, beside the ambient one; 0…1.
    pub diffuse: I16F16,
    /// Intensity on every surface; 0…1.
    pub ambient: I16F16,
}

/// A light as the surface of one object sees it: in the object's own space.
///
/// Turning the light once spares turning every normal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ObjectLight {
    /// Towards the light, Q18.14, times the diffuse intensity.
    direction: [i32; 3],
    /// Q4.28, and half a 256th, so that the sum's floor rounds.
    ambient: i32,
    /// What takes longer: colour, or an object scaled by different factors along its axes.
    pub(crate) uneven: Option<UnevenLight>,
}

impl ObjectLight {
    /// Full light from everywhere: everything in its own colour.
    pub const FULL: Self = Self { direction: [0; 3], ambient: (1 << DOT_BITS) + HALF, uneven: None };

    /// Returns `light` in the space of an object with the given model matrix.
    ///
    /// The matrix may turn, move and scale; scaled unevenly or mirrored, it costs more a face or
    /// vertex, as does a coloured light. Intensities saturate to 0…1.
    pub fn new(light: &DirectionalLight, model: &Matrix) -> Self {
        let world: Vector = light.direction.map(Into::into);
        // The inverse of a rotation is its transpose; scale drops out by normalising.
        let column = |axis: usize| [model.rows[0][axis], model.rows[1][axis], model.rows[2][axis]];
        let local = normalise([0, 1, 2].map(|axis| dot(column(axis), world))).unwrap_or_default();
        let clamp = |value: I16F16| i64::from(value.clamp(I16F16::ZERO, I16F16::ONE).to_bits());
        let diffuse = clamp(light.diffuse);
        // Q32.32 · Q16.16 is Q48; the unit vectors keep it in range.
        let times_diffuse =
            |vector: Vector| vector.map(|part| (((part.to_bits() >> 16) * diffuse + (1 << 17)) >> 18) as i32);
        let ambient = (clamp(light.ambient) << (DOT_BITS - 16)) as i32 + HALF;
        let uneven = UnevenLight::new(light.colour, times_diffuse(local), times_diffuse(world), ambient, model);
        Self { direction: times_diffuse(local), ambient, uneven }
    }

    /// Returns the intensity on a surface, but for what is uneven: ambient plus diffuse times the
    /// cosine between its normal (Q2.14) and the light, negative cosines taken as 0, the sum cut
    /// at 1.
    #[inline(always)]
    pub fn intensity(&self, normal: [i16; 3]) -> Intensity {
        let [x, y, z] = normal.map(i32::from);
        // At most 3 · 2¹⁵ · 2¹⁴, even for a normal that is none; with the ambient below 2³¹.
        let dot = x * self.direction[0] + y * self.direction[1] + z * self.direction[2];
        // Cut before it is shifted: that way round it takes an instruction less.
        Intensity(((dot.max(0) + self.ambient).min(1 << DOT_BITS) >> (DOT_BITS - 8)) as u32)
    }

    /// Returns a lit colour: each channel times the intensity of the light's, rounded half up.
    pub fn lit(&self, normal: [i16; 3], colour: [u8; 3]) -> [u8; 3] {
        match &self.uneven {
            None => self.intensity(normal).colour(colour),
            Some(light) => light.lit(normal, colour),
        }
    }
}

/// How brightly a surface is lit, 0…256.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Intensity(u32);

impl Intensity {
    /// Returns the intensity in 256ths.
    pub fn to_bits(self) -> u32 {
        self.0
    }

    /// Returns a lit colour: each channel times the intensity, rounded half up.
    #[inline(always)]
    pub fn colour(self, colour: [u8; 3]) -> [u8; 3] {
        colour.map(|channel| ((u32::from(channel) * self.0 + 128) >> 8) as u8)
    }

    /// Returns the framebuffer colour nearest to the lit colour, as [`Rgb332::nearest`] but rounded
    /// once: the product is
    /// not rounded to a byte in between. Within 0.03 of a step it may take the neighbour.
    #[inline(always)]
    pub fn framebuffer_colour(self, [red, green, blue]: [u8; 3]) -> Rgb332 {
        // A full product is 255 · 256, taken for 2¹⁶. A step's half is added before it is
        // multiplied: 7 · 4,681 and 3 · 10,923 are 2¹⁵, but for one.
        let of_8 = |channel: u8| ((u32::from(channel) * self.0 + 4_681) * 7) >> 16;
        let of_4 = |channel: u8| ((u32::from(channel) * self.0 + 10_922) * 3) >> 16;
        Rgb332((of_8(red) << 5 | of_8(green) << 2 | of_4(blue)) as u8)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::angle::Angle;

    fn light(diffuse: f64, ambient: f64) -> DirectionalLight {
        DirectionalLight {
            direction: [I2F30::ZERO, I2F30::ZERO, I2F30::ONE],
            colour: [255; 3],
            diffuse: I16F16::from_num(diffuse),
            ambient: I16F16::from_num(ambient),
        }
    }

    #[test]
    fn intensity_follows_the_cosine_in_world_space() {
        for step in 0..360u32 {
            let angle = Angle::from_degrees(I16F16::from_num(step));
            let model = Matrix::rotation_y(angle).times(&Matrix::scaling([fixed::types::I32F32::from_num(0.01); 3]));
            let seen = ObjectLight::new(&light(0.7, 0.2), &model).intensity([0, 0, 1 << 14]).to_bits();
            let exact = 256.0 * (0.2 + 0.7 * f64::from(step).to_radians().cos().max(0.0));
            assert!((f64::from(seen) - exact).abs() < 0.6, "{step} degrees: {seen}, exact {exact}");
        }
    }

    /// Against floating point: the inverse's transpose by solving, for turned, stretched and mirrored
    /// objects and coloured light.
    #[test]
    fn normals_turn_with_an_unevenly_scaled_object() {
        let mut worst = 0.0f64;
        for step in 0..4_000u32 {
            let random = |salt: u32| f64::from((step * 7 + salt).wrapping_mul(2_654_435_761) >> 8) / f64::from(1 << 24);
            let factors = [0, 1, 2].map(|axis| {
                let factor = 0.05 + 4.0 * random(axis) * random(axis);
                if random(axis + 20) < 0.2 { -factor } else { factor }
            });
            let angle = |salt: u32| Angle::from_bits((random(salt) * 4_294_967_296.0) as u32);
            let model = Matrix::rotation_y(angle(3))
                .times(&Matrix::rotation_x(angle(4)))
                .times(&Matrix::scaling(factors.map(fixed::types::I32F32::from_num)));
            let normal = [5, 6, 7].map(|salt| ((random(salt) - 0.5) * 28_000.0) as i16);
            let lamp = DirectionalLight { colour: [255, 128, 0], ..light(0.8, 0.1) };
            let seen = ObjectLight::new(&lamp, &model).lit(normal, [255, 200, 100]);

            // A model of M = R·S has the inverse transpose R·S⁻¹.
            let turned = [0, 1, 2].map(|row| {
                (0..3)
                    .map(|axis| {
                        let rotation = model.rows[row][axis].to_num::<f64>() / factors[axis];
                        rotation / factors[axis] * f64::from(normal[axis])
                    })
                    .sum::<f64>()
            });
            let length = turned.iter().map(|part| part * part).sum::<f64>().sqrt();
            let cosine = if length > 0.0 { (turned[2] / length).max(0.0) } else { 0.0 };
            for (channel, (own, lamp)) in [(255.0, 1.0), (200.0, 128.0 / 255.0), (100.0, 0.0)].into_iter().enumerate() {
                let exact = own * f64::min(0.1 + 0.8 * cosine * lamp, 1.0);
                worst = worst.max((f64::from(seen[channel]) - exact).abs());
            }
        }
        assert!(worst < 1.2, "off by {worst} of 255");
    }

    #[test]
    fn an_even_matrix_takes_the_short_way() {
        let turned =
            Matrix::rotation_y(Angle::from_bits(123_456_789)).times(&Matrix::rotation_x(Angle::from_bits(1 << 29)));
        let scaled = |factors: [f64; 3]| turned.times(&Matrix::scaling(factors.map(fixed::types::I32F32::from_num)));
        let is_uneven = |model: &Matrix| ObjectLight::new(&light(1.0, 0.0), model).uneven.is_some();
        assert!(!is_uneven(&turned) && !is_uneven(&scaled([0.01; 3])) && !is_uneven(&scaled([100.0; 3])));
        assert!(is_uneven(&scaled([1.0, 1.0, 1.01])) && is_uneven(&scaled([1.0, -1.0, 1.0])));
        let coloured = DirectionalLight { colour: [255, 255, 254], ..light(1.0, 0.0) };
        assert!(ObjectLight::new(&coloured, &turned).uneven.is_some());
    }

    #[test]
    fn a_matrix_of_zeros_gives_ambient_light() {
        let zeros = Matrix::scaling([fixed::types::I32F32::ZERO; 3]);
        assert_eq!(ObjectLight::new(&light(1.0, 0.5), &zeros).lit([0, 0, 1 << 14], [200; 3]), [100; 3]);
    }

    #[test]
    fn too_much_light_saturates_and_none_is_black() {
        assert_eq!(
            ObjectLight::new(&light(9.0, 9.0), &Matrix::IDENTITY).intensity([0, 0, 1 << 14]).colour([255, 1, 0]),
            [255, 1, 0]
        );
        assert_eq!(
            ObjectLight::new(&light(1.0, -1.0), &Matrix::IDENTITY).intensity([0, 0, -(1 << 14)]).colour([255; 3]),
            [0; 3]
        );
        assert_eq!(ObjectLight::FULL.intensity([i16::MIN; 3]).colour([7, 8, 9]), [7, 8, 9]);
    }

    #[test]
    fn normals_of_any_bits_do_not_panic() {
        let lamp = ObjectLight::new(&light(1.0, 1.0), &Matrix::IDENTITY);
        for normal in [[i16::MIN; 3], [i16::MAX; 3], [i16::MIN, i16::MAX, 0]] {
            assert!(lamp.intensity(normal).to_bits() <= 256);
        }
    }

    #[test]
    fn the_framebuffer_colour_is_the_nearest_to_the_unrounded_product() {
        for channel in 0..=255u8 {
            for intensity in 0..=256 {
                let exact = f64::from(channel) * f64::from(intensity) / 256.0;
                let Rgb332(bits) = Intensity(intensity).framebuffer_colour([channel; 3]);
                for (level, of) in [(bits >> 5, 7.0), (bits >> 2 & 7, 7.0), (bits & 3, 3.0)] {
                    let distance = (f64::from(level) - exact * of / 255.0).abs();
                    assert!(distance < 0.53, "{channel} at {intensity}: level {level} of {of}");
                }
            }
        }
    }
}
