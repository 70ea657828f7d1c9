//! Ambient and directional light, a colour a face.

use fixed::types::{I2F30, I16F16};

use fpga_regs::screen::Rgb332;

use crate::matrix::{Matrix, Vector, dot, normalise};

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
    /// Intensity on a face that looks straight at the light, beside the ambient one; 0…1.
    pub diffuse: I16F16,
    /// Intensity on every face; 0…1.
    pub ambient: I16F16,
}

/// A light as the faces of one object see it: in the object's own space.
///
/// Turning the light once spares turning every normal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FaceLight {
    /// Towards the light, Q18.14, times the diffuse intensity.
    direction: [i32; 3],
    /// Q4.28, and half a 256th, so that the sum's floor rounds.
    ambient: i32,
}

impl FaceLight {
    /// Full light from everywhere: every face in its own colour.
    pub const FULL: Self = Self { direction: [0; 3], ambient: (1 << DOT_BITS) + HALF };

    /// Returns `light` in the space of an object with the given model matrix.
    ///
    /// The matrix may turn, move, and scale all axes alike. Intensities saturate to 0…1.
    pub fn new(light: &DirectionalLight, model: &Matrix) -> Self {
        let world: Vector = light.direction.map(Into::into);
        // The inverse of a rotation is its transpose; scale drops out by normalising.
        let column = |axis: usize| [model.rows[0][axis], model.rows[1][axis], model.rows[2][axis]];
        let local = normalise([0, 1, 2].map(|axis| dot(column(axis), world))).unwrap_or_default();
        let clamp = |value: I16F16| i64::from(value.clamp(I16F16::ZERO, I16F16::ONE).to_bits());
        let diffuse = clamp(light.diffuse);
        // Q32.32 · Q16.16 is Q48; the unit vector keeps it in range.
        let direction = local.map(|part| (((part.to_bits() >> 16) * diffuse + (1 << 17)) >> 18) as i32);
        Self { direction, ambient: (clamp(light.ambient) << (DOT_BITS - 16)) as i32 + HALF }
    }

    /// Returns the intensity on a face: ambient plus diffuse times the cosine between its normal
    /// and the light, negative cosines taken as 0, the sum cut at 1.
    #[inline(always)]
    pub fn intensity(&self, normal: [i16; 3]) -> Intensity {
        let [x, y, z] = normal.map(i32::from);
        // At most 3 · 2¹⁵ · 2¹⁴, even for a normal that is none; with the ambient below 2³¹.
        let dot = x * self.direction[0] + y * self.direction[1] + z * self.direction[2];
        Intensity(((dot.max(0) + self.ambient) >> (DOT_BITS - 8)).min(256) as u32)
    }
}

/// How brightly a face is lit, 0…256.
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
            diffuse: I16F16::from_num(diffuse),
            ambient: I16F16::from_num(ambient),
        }
    }

    #[test]
    fn intensity_follows_the_cosine_in_world_space() {
        for step in 0..360u32 {
            let angle = Angle::from_degrees(I16F16::from_num(step));
            let model = Matrix::rotation_y(angle).times(&Matrix::scaling([fixed::types::I32F32::from_num(0.01); 3]));
            let seen = FaceLight::new(&light(0.7, 0.2), &model).intensity([0, 0, 1 << 14]).to_bits();
            let exact = 256.0 * (0.2 + 0.7 * f64::from(step).to_radians().cos().max(0.0));
            assert!((f64::from(seen) - exact).abs() < 0.6, "{step} degrees: {seen}, exact {exact}");
        }
    }

    #[test]
    fn too_much_light_saturates_and_none_is_black() {
        assert_eq!(
            FaceLight::new(&light(9.0, 9.0), &Matrix::IDENTITY).intensity([0, 0, 1 << 14]).colour([255, 1, 0]),
            [255, 1, 0]
        );
        assert_eq!(
            FaceLight::new(&light(1.0, -1.0), &Matrix::IDENTITY).intensity([0, 0, -(1 << 14)]).colour([255; 3]),
            [0; 3]
        );
        assert_eq!(FaceLight::FULL.intensity([i16::MIN; 3]).colour([7, 8, 9]), [7, 8, 9]);
    }

    #[test]
    fn normals_of_any_bits_do_not_panic() {
        let lamp = FaceLight::new(&light(1.0, 1.0), &Matrix::IDENTITY);
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
