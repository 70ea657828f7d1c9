//! What to do when an interrupt endpoint fails.

use embassy_usb_driver::host::PipeError;

use crate::descriptor::Endpoint;
use crate::link::Link;
use crate::mailbox::ListenError;
use crate::setup::Setup;
use crate::timing::{READ_ERRORS_MAXIMUM, READ_PAUSE_US};
use crate::{Fault, Step};

/// How much longer an endpoint's failures are borne.
#[derive(Default)]
pub(crate) struct Patience {
    /// Failures in a row.
    errors: u32,
}

impl Patience {
    /// Pauses, clears a halt if that is what it is, and lets the endpoint be asked again.
    ///
    /// # Errors
    /// The failure itself, if it is one too many; or that of clearing the halt.
    pub(crate) async fn recover(
        &mut self,
        link: &Link<'_>,
        doing: Step,
        endpoint: Endpoint,
        error: ListenError,
    ) -> Result<(), Fault> {
        if self.errors >= READ_ERRORS_MAXIMUM || error == ListenError::NoPipe {
            return Err(error.fault(doing));
        }
        link.memory.sleep(READ_PAUSE_US << self.errors).await;
        self.errors += 1;
        let halted = error == ListenError::Pipe(PipeError::Stall);
        if halted {
            link.write(doing, Setup::clear_halt(0x80 | endpoint.number), &[]).await?;
        }
        link.mailbox().resume(halted);
        Ok(())
    }
}
