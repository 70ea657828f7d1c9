//! Ambient and directional light, a colour a face.

use fixed::types::{I2F30, I16F16};

use crate::matrix::{Matrix, Vector, dot, normalise};

/// Fraction bits of a face's normal and of the light's direction.
const DIRECTION_BITS: u32 = 14;
/// Fraction bits of their product.
const DOT_BITS: u32 = 2 * DIRECTION_BITS;

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
    /// Q4.28.
    ambient: i32,
}

impl FaceLight {
    /// Full light from everywhere: every face in its own colour.
    pub const FULL: Self = Self { direction: [0; 3], ambient: 1 << DOT_BITS };

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
        Self { direction, ambient: (clamp(light.ambient) << (DOT_BITS - 16)) as i32 }
    }

    /// Returns the intensity on a face, 0…256: ambient plus diffuse times the cosine between its
    /// normal and the light, negative cosines taken as 0, the sum cut at 256.
    #[inline(always)]
    pub fn intensity(&self, normal: [i16; 3]) -> u32 {
        let [x, y, z] = normal.map(i32::from);
        // Each product is below 2³⁰ and the vectors are of unit length, so the sum fits.
        let dot = (x.wrapping_mul(self.direction[0]))
            .wrapping_add(y.wrapping_mul(self.direction[1]))
            .wrapping_add(z.wrapping_mul(self.direction[2]));
        let sum = dot.max(0).saturating_add(self.ambient + (1 << (DOT_BITS - 9)));
        (sum >> (DOT_BITS - 8)).min(256) as u32
    }

    /// Returns a face's lit colour: each channel times the intensity, rounded half up.
    #[inline(always)]
    pub fn shade(&self, normal: [i16; 3], colour: [u8; 3]) -> [u8; 3] {
        let intensity = self.intensity(normal);
        // At most (255 · 256 + 128) / 256, so it is a byte.
        colour.map(|channel| ((u32::from(channel) * intensity + 128) >> 8) as u8)
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
            let seen = FaceLight::new(&light(0.7, 0.2), &model).intensity([0, 0, 1 << 14]);
            let exact = 256.0 * (0.2 + 0.7 * f64::from(step).to_radians().cos().max(0.0));
            assert!((f64::from(seen) - exact).abs() < 0.6, "{step} degrees: {seen}, exact {exact}");
        }
    }

    #[test]
    fn too_much_light_saturates_and_none_is_black() {
        assert_eq!(
            FaceLight::new(&light(9.0, 9.0), &Matrix::IDENTITY).shade([0, 0, 1 << 14], [255, 1, 0]),
            [255, 1, 0]
        );
        assert_eq!(FaceLight::new(&light(1.0, -1.0), &Matrix::IDENTITY).shade([0, 0, -(1 << 14)], [255; 3]), [0; 3]);
        assert_eq!(FaceLight::FULL.shade([i16::MIN; 3], [7, 8, 9]), [7, 8, 9]);
    }

    #[test]
    fn normals_of_any_bits_do_not_panic() {
        let lamp = FaceLight::new(&light(1.0, 1.0), &Matrix::IDENTITY);
        for normal in [[i16::MIN; 3], [i16::MAX; 3], [i16::MIN, i16::MAX, 0]] {
            assert!(lamp.intensity(normal) <= 256);
        }
    }
}
