//! Reads back what [`Rtl::record_wave`](crate::Rtl::record_wave) has written.

use std::ffi::{CStr, CString, c_char, c_void};
use std::path::Path;

unsafe extern "C" {
    fn halfspace_wave_changes(
        file: *const c_char,
        name: *const c_char,
        each: unsafe extern "C" fn(*mut c_void, u64, *const c_char),
        user: *mut c_void,
    ) -> i32;
}

/// A signal's change.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Change {
    /// When, in picoseconds from the simulation's start.
    pub time: u64,
    /// The value since then, in binary, its highest bit first.
    pub value: String,
}

/// Returns the changes of the first signal called `name`, its value at the wave's start among them.
///
/// # Errors
/// Says that the file is no wave in picoseconds, or has no such signal.
pub fn changes(file: &Path, name: &str) -> Result<Vec<Change>, String> {
    unsafe extern "C" fn each(user: *mut c_void, time: u64, value: *const c_char) {
        // Safety: `user` is the vector below, which lives through the call; `value` ends with a zero.
        let (changes, value) = unsafe { (&mut *user.cast::<Vec<Change>>(), CStr::from_ptr(value)) };
        changes.push(Change { time, value: value.to_string_lossy().into_owned() });
    }
    let shown = file.display();
    let path = CString::new(file.as_os_str().as_encoded_bytes()).map_err(|error| format!("{shown}: {error}"))?;
    let signal = CString::new(name).map_err(|error| format!("{name}: {error}"))?;
    let mut changes: Vec<Change> = Vec::new();
    // Safety: both names end with a zero and live through the call, as the vector does.
    let unit = unsafe { halfspace_wave_changes(path.as_ptr(), signal.as_ptr(), each, (&raw mut changes).cast()) };
    match unit {
        -12 => Ok(changes),
        2 => Err(format!("{shown} has no signal {name}")),
        1 => Err(format!("{shown} is no FST file")),
        _ => Err(format!("{shown} counts in 10^{unit} seconds, not in picoseconds")),
    }
}
