//! What a frame takes in.

use core::fmt::Write;

use usb_input::Merge;

use super::service::News;
use super::words::tell;
use crate::intake::Intake;

/// What was taken in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Taken {
    /// Reports that could not be read.
    pub unreadable: u32,
    /// Failures of the controller.
    pub faults: u32,
}

/// Takes in all that has happened: reports go to the controls, the rest to the console.
pub fn take_in(
    mut next: impl FnMut() -> Option<News>,
    merge: &mut Merge,
    intake: &mut Intake,
    console: &mut impl Write,
) -> Taken {
    let mut taken = Taken::default();
    while let Some(news) = next() {
        match &news {
            News::Device(event) => {
                if let Some(report) = merge.report(event) {
                    taken.unreadable += u32::from(intake.accept(report).is_err());
                }
            }
            News::Controller(_) => taken.faults += 1,
            News::FullSpeed => {}
        }
        // A console that fails has nobody to be told over.
        let _ = tell(&news, console);
    }
    taken
}
