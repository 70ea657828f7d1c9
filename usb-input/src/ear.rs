//! Listening to an interrupt endpoint, and what to do when it fails.

use crate::descriptor::Endpoint;
use crate::link::{Link, Next};
use crate::mailbox::{Outcome, TransferError};
use crate::setup::Setup;
use crate::timing::{READ_ERRORS_MAXIMUM, Wait};
use crate::{Fault, Memory, Step};

/// An endpoint that is listened to.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ear {
    pub(crate) endpoint: Endpoint,
    /// What listening is for.
    doing: Step,
    /// Failures in a row.
    errors: u8,
    stage: Stage,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Stage {
    Listening,
    Failed(TransferError),
    /// After a failure; the endpoint has halted, or not.
    Paused {
        halted: bool,
    },
    ClearingHalt,
}

impl Ear {
    pub(crate) const fn new(endpoint: Endpoint, doing: Step) -> Self {
        Self { endpoint, doing, errors: 0, stage: Stage::Listening }
    }

    /// Takes what arrived; returns the length of the packet if it is one.
    pub(crate) fn hear(&mut self, arrival: Outcome) -> Option<usize> {
        match (arrival, self.stage) {
            (Ok(length), _) => {
                self.errors = 0;
                Some(length)
            }
            (Err(error), Stage::Listening) => {
                self.stage = Stage::Failed(error);
                None
            }
            (Err(_), _) => None,
        }
    }

    /// Recovers from a failure, step by step; `None` while there is nothing to recover from.
    ///
    /// # Errors
    /// The failure, if it is one too many.
    pub(crate) fn next(&mut self, link: &mut Link, memory: &Memory) -> Result<Option<Next>, Fault> {
        match self.stage {
            Stage::Listening | Stage::ClearingHalt => Ok(None),
            Stage::Failed(error) => {
                if self.errors >= READ_ERRORS_MAXIMUM || error == TransferError::NoPipe {
                    link.doing = self.doing;
                    return Err(link.fault(error));
                }
                let pause = Wait::READ_PAUSE.times(1 << self.errors);
                self.errors += 1;
                self.stage = Stage::Paused { halted: error == TransferError::STALL };
                Ok(Some(link.wait(memory, pause)))
            }
            Stage::Paused { halted: false } => {
                self.stage = Stage::Listening;
                link.mailbox(memory).go_on(false);
                Ok(None)
            }
            Stage::Paused { halted: true } => {
                self.stage = Stage::ClearingHalt;
                let setup = Setup::clear_halt(0x80 | self.endpoint.number);
                Ok(Some(link.order(memory, self.doing, setup)))
            }
        }
    }

    /// Takes an answer if it is to a request of its own; tells whether it was.
    pub(crate) fn answered(&mut self, link: &Link, memory: &Memory, answer: Outcome) -> Result<bool, Fault> {
        let mine = self.stage == Stage::ClearingHalt;
        if mine {
            link.succeeded(answer)?;
            self.stage = Stage::Listening;
            link.mailbox(memory).go_on(true);
        }
        Ok(mine)
    }
}
