//! What somebody left in memory before the program started: on QEMU, `-device loader`.

use core::ops::Range;

/// Returns a window of memory, unless it starts with a word of zeros, which is how QEMU leaves what nobody wrote.
///
/// # Safety
/// The window is mapped, and nobody writes to it from now on.
#[must_use]
pub unsafe fn window(window: Range<usize>) -> Option<&'static [u8]> {
    // SAFETY: the caller's promise.
    let bytes: &'static [u8] =
        unsafe { core::slice::from_raw_parts(core::ptr::with_exposed_provenance(window.start), window.len()) };
    (bytes.first_chunk() != Some(&[0; 4])).then_some(bytes)
}
