//! A pipe: transfers to one endpoint of one device.

use core::marker::PhantomData;

use embassy_usb_driver::host::{PipeError, TimeoutConfig, UsbPipe, pipe};

use crate::{Dwc2, TransferError};

/// Transfers to one endpoint. Dropping it aborts what is under way and gives its place back.
pub struct Pipe<'d, T: pipe::Type, D: pipe::Direction> {
    #[expect(dead_code)]
    driver: &'d Dwc2<'d>,
    _kind: PhantomData<(T, D)>,
}

impl<T: pipe::Type, D: pipe::Direction> Pipe<'_, T, D> {
    /// How the last transfer failed; `None` after one that did not.
    pub fn last_error(&self) -> Option<TransferError> {
        None
    }
}

impl<T: pipe::Type, D: pipe::Direction> UsbPipe<T, D> for Pipe<'_, T, D> {
    async fn control_in(&mut self, _setup: &[u8; 8], _buffer: &mut [u8]) -> Result<usize, PipeError>
    where
        T: pipe::IsControl,
        D: pipe::IsIn,
    {
        Err(PipeError::Disconnected)
    }

    async fn control_out(&mut self, _setup: &[u8; 8], _bytes: &[u8]) -> Result<(), PipeError>
    where
        T: pipe::IsControl,
        D: pipe::IsOut,
    {
        Err(PipeError::Disconnected)
    }

    async fn request_in(&mut self, _buffer: &mut [u8]) -> Result<usize, PipeError>
    where
        D: pipe::IsIn,
    {
        Err(PipeError::Disconnected)
    }

    async fn request_out(&mut self, _bytes: &[u8], _ensure_transaction_end: bool) -> Result<(), PipeError>
    where
        D: pipe::IsOut,
    {
        Err(PipeError::Disconnected)
    }

    fn set_timeout(&mut self, _timeout: TimeoutConfig)
    where
        T: pipe::IsControl,
    {
    }

    fn reset_data_toggle(&mut self)
    where
        T: pipe::IsBulkOrInterrupt,
    {
    }
}
