//! What a vertex looks like: its normal and colour, for smooth shading.

use crate::light::ObjectLight;
use crate::mesh::Mesh;

/// A vertex's normal and colour, packed so that lighting it reads three words.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(C)]
pub struct VertexLook {
    /// The normal's x in the lower half, y in the upper.
    x_y: u32,
    /// The normal's z in the lower half, green in the upper.
    z_green: u32,
    /// Red in bits 7…0, blue in 23…16.
    red_blue: u32,
}

impl VertexLook {
    /// Returns the look of a unit normal in model space, Q2.14, and a colour in full light: red,
    /// green, blue, 0…255.
    pub const fn new([x, y, z]: [i16; 3], [red, green, blue]: [u8; 3]) -> Self {
        Self {
            x_y: x as u16 as u32 | (y as u16 as u32) << 16,
            z_green: z as u16 as u32 | (green as u32) << 16,
            red_blue: red as u32 | (blue as u32) << 16,
        }
    }

    /// Returns the normal.
    #[inline(always)]
    pub const fn normal(self) -> [i16; 3] {
        [self.x_y as i16, (self.x_y >> 16) as i16, self.z_green as i16]
    }

    /// Returns the colour.
    #[inline(always)]
    pub const fn colour(self) -> [u8; 3] {
        [self.red_blue as u8, (self.z_green >> 16) as u8, (self.red_blue >> 16) as u8]
    }
}

/// A vertex's lit colour: red in the lowest byte, then green, then blue.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(transparent)]
pub struct LitColour(u32);

impl LitColour {
    /// Black.
    pub const BLACK: Self = Self(0);

    /// Returns red, green and blue.
    #[inline(always)]
    pub const fn to_rgb888(self) -> [u8; 3] {
        [self.0 as u8, (self.0 >> 8) as u8, (self.0 >> 16) as u8]
    }

    const fn new([red, green, blue]: [u8; 3]) -> Self {
        Self(red as u32 | (green as u32) << 8 | (blue as u32) << 16)
    }
}

/// Lights every vertex.
#[inline(never)]
pub(crate) fn light_vertices(looks: &[VertexLook], light: &ObjectLight, lit: &mut [LitColour]) {
    if let Some(uneven) = &light.uneven {
        for (lit, look) in lit.iter_mut().zip(looks) {
            *lit = LitColour::new(uneven.lit(look.normal(), look.colour()));
        }
        return;
    }
    for (lit, look) in lit.iter_mut().zip(looks) {
        let intensity = light.intensity(look.normal()).to_bits();
        // As `Intensity::colour`, two channels in one product: neither carries into the other.
        let red_blue = (look.red_blue * intensity + 0x0080_0080) >> 8 & 0x00ff_00ff;
        let green = ((look.z_green >> 16) * intensity + 0x80) & 0xff00;
        *lit = LitColour(red_blue | green);
    }
}

/// Works out looks from the faces: at each vertex the mean of the normals and of the colours of
/// the faces around it. `counts` is scratch; both buffers hold one for each vertex. Returns the
/// looks, or `None` if a buffer is too small.
///
/// A vertex that no face has, or whose normals cancel out, takes no directional light. Of a vertex
/// with more than 16 faces the normal may be off, with more than 257 the colour.
pub fn looks_of_faces<'a>(
    mesh: &Mesh<'_>,
    looks: &'a mut [VertexLook],
    counts: &mut [u16],
) -> Option<&'a [VertexLook]> {
    /// A sixteenth of each normal, so that sixteen fit.
    const SHARE_BITS: u32 = 4;
    let vertices = mesh.positions().len();
    let (looks, counts) = (looks.get_mut(..vertices)?, counts.get_mut(..vertices)?);
    looks.fill(VertexLook::default());
    counts.fill(0);
    for face in mesh.faces() {
        for corner in face.corners.map(|corner| corner as usize) {
            looks[corner].add(face.normal.map(|part| part >> SHARE_BITS), face.colour);
            counts[corner] = counts[corner].saturating_add(1);
        }
    }
    for (look, count) in looks.iter_mut().zip(counts) {
        let normal = look.normal();
        let square: i64 = normal.iter().map(|part| i64::from(*part) * i64::from(*part)).sum();
        let length = square.isqrt().max(1);
        let unit = normal.map(|part| (i64::from(part) * (1 << 14) / length) as i16);
        let sums = [look.red_blue as u16, (look.z_green >> 16) as u16, (look.red_blue >> 16) as u16];
        *look = VertexLook::new(unit, sums.map(|sum| (sum / (*count).max(1)) as u8));
    }
    Some(looks)
}

impl VertexLook {
    /// Adds a normal and a colour, whose sums have 16 bits each and saturate.
    fn add(&mut self, normal: [i16; 3], colour: [u8; 3]) {
        let signed = |half: u32, part: i16| u32::from((half as i16).saturating_add(part) as u16);
        let unsigned = |half: u32, part: u8| u32::from((half as u16).saturating_add(part.into()));
        self.x_y = signed(self.x_y, normal[0]) | signed(self.x_y >> 16, normal[1]) << 16;
        self.z_green = signed(self.z_green, normal[2]) | unsigned(self.z_green >> 16, colour[1]) << 16;
        self.red_blue = unsigned(self.red_blue, colour[0]) | unsigned(self.red_blue >> 16, colour[2]) << 16;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::DirectionalLight;
    use crate::matrix::Matrix;
    use crate::mesh::{Face, Winding};
    use fixed::types::{I2F30, I4F28, I16F16};

    #[test]
    fn a_look_keeps_its_normal_and_colour() {
        for (normal, colour) in [([1, -2, i16::MIN], [255, 0, 7]), ([i16::MAX, -1, 0], [0, 255, 255])] {
            let look = VertexLook::new(normal, colour);
            assert_eq!((look.normal(), look.colour()), (normal, colour));
        }
    }

    #[test]
    fn a_vertex_looks_like_the_mean_of_its_faces() {
        let one = I4F28::ONE;
        let positions = [[-one, -one, -one], [one, -one, -one], [-one, one, -one], [-one, -one, one], [one; 3]];
        let half = 1 << 14;
        let faces = [
            Face { corners: [0, 2, 1], normal: [0, 0, -half], colour: [255, 0, 10] },
            Face { corners: [0, 1, 3], normal: [0, -half, 0], colour: [255, 100, 20] },
            Face { corners: [0, 3, 2], normal: [-half, 0, 0], colour: [255, 200, 60] },
        ];
        let mesh = Mesh::new(&positions, &faces, Winding::CounterClockwise).expect("a mesh");
        let mut looks = [VertexLook::default(); 5];
        let looks = looks_of_faces(&mesh, &mut looks, &mut [0; 5]).expect("as many as vertices");
        // 2¹⁴ over the square root of 3 is 9,459.
        assert!(looks[0].normal().iter().all(|part| (part + 9_459).abs() <= 20), "{:?}", looks[0].normal());
        assert_eq!(
            (looks[0].colour(), looks[1].colour(), looks[3].colour()),
            ([255, 100, 30], [255, 50, 15], [255, 150, 40])
        );
        assert_eq!((looks[4].normal(), looks[4].colour()), ([0; 3], [0; 3]), "no face has it");
        assert!(looks_of_faces(&mesh, &mut [VertexLook::default(); 4], &mut [0; 5]).is_none());
    }

    #[test]
    fn two_channels_at_once_are_the_same_as_one_by_one() {
        let light = DirectionalLight {
            direction: [I2F30::ZERO, I2F30::ZERO, I2F30::ONE],
            colour: [255; 3],
            diffuse: I16F16::ONE,
            ambient: I16F16::ZERO,
        };
        let light = ObjectLight::new(&light, &Matrix::IDENTITY);
        for z in (0..=1 << 14).step_by(61) {
            for channel in 0..=255u8 {
                let look = VertexLook::new([3, -7, z], [channel, 255 - channel, channel ^ 0x5a]);
                let mut lit = [LitColour::default()];
                light_vertices(&[look], &light, &mut lit);
                assert_eq!(lit[0].to_rgb888(), light.lit(look.normal(), look.colour()), "{channel} at {z}");
            }
        }
    }
}
