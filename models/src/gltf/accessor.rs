//! Numbers in the binary part.

use ::gltf::Accessor;
use ::gltf::accessor::{DataType, Dimensions};
use ::gltf::buffer::Source;

use super::GltfProblem;

/// Numbers of an accessor, of which each element has `WIDTH` that count.
pub(super) struct Elements<'a, const WIDTH: usize> {
    bytes: &'a [u8],
    stride: usize,
    count: usize,
    kind: DataType,
    normalized: bool,
}

impl<'a, const WIDTH: usize> Elements<'a, WIDTH> {
    /// Checks that an accessor's elements have one of `dimensions` and one of `kinds`, and lie in the file.
    ///
    /// `dimensions` have at least `WIDTH` numbers; `wanted` says both in words.
    pub(super) fn new(
        accessor: &Accessor<'_>,
        blob: &'a [u8],
        (dimensions, kinds): (&[Dimensions], &[DataType]),
        wanted: &'static str,
    ) -> Result<Self, GltfProblem> {
        let index = accessor.index();
        let kind = accessor.data_type();
        if accessor.sparse().is_some() {
            return Err(GltfProblem::Sparse { accessor: index });
        }
        let is_wanted = dimensions.contains(&accessor.dimensions()) && kinds.contains(&kind);
        let Some(view) = accessor.view().filter(|_| is_wanted) else {
            return Err(GltfProblem::WrongType { accessor: index, wanted });
        };
        if let Source::Uri(_) = view.buffer().source() {
            return Err(GltfProblem::ExternalBuffer { buffer: view.buffer().index() });
        }
        let element = kind.size() * accessor.dimensions().multiplicity();
        let stride = view.stride().unwrap_or(element).max(element);
        // In 128 bits, as any of them may be anything.
        let [offset, length, inner, count] =
            [view.offset(), view.length(), accessor.offset(), accessor.count()].map(|number| number as u128);
        let within_view =
            inner + count.saturating_sub(1) * stride as u128 + if count > 0 { element as u128 } else { 0 };
        let end = offset + within_view.max(inner);
        if within_view > length || end > blob.len() as u128 {
            let end = u64::try_from(end).unwrap_or(u64::MAX);
            let bytes = blob.len().min(usize::try_from(offset + length).unwrap_or(usize::MAX));
            return Err(GltfProblem::OutOfBuffer { accessor: index, end, bytes });
        }
        let start = (offset + inner) as usize;
        Ok(Self {
            bytes: &blob[start..end as usize],
            stride,
            count: accessor.count(),
            kind,
            normalized: accessor.normalized(),
        })
    }

    /// Returns how many elements there are.
    pub(super) fn len(&self) -> usize {
        self.count
    }

    /// Returns an element's numbers; integers that stand for 0…1 as that.
    pub(super) fn get(&self, index: usize) -> [f64; WIDTH] {
        let element = &self.bytes[index * self.stride..];
        std::array::from_fn(|part| {
            let at = &element[part * self.kind.size()..];
            let (value, most) = match self.kind {
                DataType::U8 => (f64::from(at[0]), f64::from(u8::MAX)),
                DataType::U16 => (f64::from(u16::from_le_bytes([at[0], at[1]])), f64::from(u16::MAX)),
                DataType::U32 => (f64::from(u32::from_le_bytes([at[0], at[1], at[2], at[3]])), f64::from(u32::MAX)),
                DataType::F32 => (f64::from(f32::from_le_bytes([at[0], at[1], at[2], at[3]])), 1.0),
                DataType::I8 => (f64::from(at[0] as i8), f64::from(i8::MAX)),
                DataType::I16 => (f64::from(i16::from_le_bytes([at[0], at[1]])), f64::from(i16::MAX)),
            };
            if self.normalized { value / most } else { value }
        })
    }
}
