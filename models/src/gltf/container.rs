//! A binary file's two parts: JSON, and bytes.
//!
//! Our own, for the crate's stops with a panic at some wrong lengths.

use super::GltfProblem;

/// Bytes of the file's header: name, version, length.
const HEADER: usize = 12;
/// Bytes of a part's header: length, type.
const CHUNK_HEADER: usize = 8;

/// Returns the JSON and the bytes; a file may have no bytes. Parts of other types that follow are passed over.
pub(super) fn parts(file: &[u8]) -> Result<(&[u8], &[u8]), GltfProblem> {
    let failed = |reason: String| Err(GltfProblem::Container { reason });
    let word = |at: usize| -> Option<u32> { Some(u32::from_le_bytes(file.get(at..at + 4)?.try_into().ok()?)) };
    let (Some(version), Some(stated)) = (word(4), word(8)) else {
        return failed(format!("{} bytes, fewer than the header's {HEADER}", file.len()));
    };
    if version != 2 {
        return failed(format!("binary glTF of version {version}, 2 is read"));
    }
    let Some(file) = file.get(..stated as usize) else {
        return failed(format!("{} bytes of {stated} that the header states", file.len()));
    };
    let Some((json, rest)) = chunk(file, HEADER, *b"JSON")? else {
        return failed("no JSON behind the header".into());
    };
    let binary = chunk(file, file.len() - rest.len(), *b"BIN\0")?.map_or(&[][..], |(binary, _)| binary);
    Ok((json, binary))
}

/// A part, and what follows it.
type Cut<'a> = (&'a [u8], &'a [u8]);

/// Cuts the part at `at` off, if there is one of this type; returns it with what follows.
fn chunk(file: &[u8], at: usize, wanted: [u8; 4]) -> Result<Option<Cut<'_>>, GltfProblem> {
    let Some((header, rest)) = file.get(at..).and_then(|rest| rest.split_first_chunk::<CHUNK_HEADER>()) else {
        return Ok(None);
    };
    let [a, b, c, d, name @ ..] = *header;
    if name != wanted {
        return Ok(None);
    }
    let length = u32::from_le_bytes([a, b, c, d]);
    rest.split_at_checked(length as usize).map(Some).ok_or_else(|| GltfProblem::Container {
        reason: format!("the part at byte {at} states {length} bytes, {} are left", rest.len()),
    })
}
