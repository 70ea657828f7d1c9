//! Time, as the waits need it.

/// A clock that never goes back.
pub trait Clock {
    /// Returns the time since some fixed moment, in microseconds.
    ///
    /// It need not advance between two calls within one [`poll`](crate::UsbInput::poll).
    fn now_us(&self) -> u64;
}

impl<C: Clock + ?Sized> Clock for &C {
    fn now_us(&self) -> u64 {
        (**self).now_us()
    }
}
