//! Room for a value that stays.

use core::cell::{Cell, UnsafeCell};
use core::mem::MaybeUninit;
use critical_section::Mutex;

/// Room for one value of any type, in a static: a future's type has no name, so it has no static of
/// its own.
#[repr(C, align(16))]
pub struct Forever<const BYTES: usize> {
    room: UnsafeCell<MaybeUninit<[u8; BYTES]>>,
    taken: Mutex<Cell<bool>>,
}

// SAFETY: the room is lent once, which `taken` guards.
unsafe impl<const BYTES: usize> Sync for Forever<BYTES> {}

impl<const BYTES: usize> Forever<BYTES> {
    /// Returns empty room.
    #[must_use]
    pub const fn new() -> Self {
        Self { room: UnsafeCell::new(MaybeUninit::uninit()), taken: Mutex::new(Cell::new(false)) }
    }

    /// Puts a value in, once; `None` at every later call. One that is too large does not compile.
    pub fn put<T: 'static>(&'static self, value: T) -> Option<&'static mut T> {
        const { assert!(size_of::<T>() <= BYTES && align_of::<T>() <= 16, "the room is too small") };
        if critical_section::with(|section| self.taken.borrow(section).replace(true)) {
            return None;
        }
        let place = self.room.get().cast::<T>();
        // SAFETY: the room is large enough and aligned, by the assertion above, and lent to nobody
        // else, as `taken` was not set.
        unsafe {
            place.write(value);
            Some(&mut *place)
        }
    }
}

impl<const BYTES: usize> Default for Forever<BYTES> {
    fn default() -> Self {
        Self::new()
    }
}
