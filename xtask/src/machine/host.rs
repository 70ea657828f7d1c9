//! The application in this process, on the software model.

use std::collections::VecDeque;
use std::marker::PhantomData;

use firmware::app::{Application, Memory, Prepared};
use firmware::board::Board;
use firmware::intake::Intake;
use fpga_regs::{Renderer, Timeouts};

use super::Machine;
use crate::picture::Picture;
use crate::software_fpga::{NoWait, SharedModel, with_model};

/// A board without hardware.
struct HostBoard<'a, 'memory> {
    of_model: PhantomData<SharedModel<'a, 'memory>>,
    incoming: VecDeque<u8>,
    outgoing: VecDeque<u8>,
    console: String,
    mesh: Option<&'static [u8]>,
}

impl<'a, 'memory> Board for HostBoard<'a, 'memory> {
    const NAME: &'static str = "host";
    const LACKS: &'static str = "no board at all";
    const TICKS_PER_SECOND: u32 = 1;
    type Console = String;
    type Port = SharedModel<'a, 'memory>;

    /// No time passes, so that a run repeats exactly.
    fn ticks(&self) -> u64 {
        0
    }

    fn console(&mut self) -> &mut String {
        &mut self.console
    }

    fn poll_controllers(&mut self, _: &mut Intake) -> u32 {
        0
    }

    fn read_link(&mut self, buffer: &mut [u8]) -> usize {
        let count = buffer.len().min(self.incoming.len());
        for (slot, byte) in buffer.iter_mut().zip(self.incoming.drain(..count)) {
            *slot = byte;
        }
        count
    }

    fn write_link(&mut self, bytes: &[u8]) {
        self.outgoing.extend(bytes);
    }

    fn picture_checksum(&mut self, model: &mut Self::Port) -> Option<u32> {
        Some(model.checksum())
    }

    fn mesh_file(&mut self) -> Option<&'static [u8]> {
        self.mesh.take()
    }

    fn pace(&mut self) {}

    fn heartbeat(&mut self, _: u32) {}

    fn sleep(&mut self) {}
}

/// The application and its model as a machine.
struct Host<'own, 'a, 'memory> {
    application: Application<'own, HostBoard<'a, 'memory>, NoWait>,
    model: SharedModel<'a, 'memory>,
}

impl Machine for Host<'_, '_, '_> {
    fn send(&mut self, bytes: &[u8]) -> anyhow::Result<()> {
        self.application.board().incoming.extend(bytes);
        Ok(())
    }

    fn receive(&mut self, what: &str) -> anyhow::Result<u8> {
        // It answers in the round that takes the last byte in or, when the message was lost, not at all.
        let mut more = true;
        while more && self.application.board().outgoing.is_empty() {
            more = !self.application.board().incoming.is_empty();
            self.application.run_once();
        }
        match self.application.board().outgoing.pop_front() {
            Some(byte) => Ok(byte),
            None => anyhow::bail!("no answer; waited for {what}; console: {}", self.application.board().console),
        }
    }

    fn screen(&mut self) -> anyhow::Result<(u32, Picture)> {
        Ok((self.model.checksum(), self.model.picture().doubled()))
    }
}

/// Starts the application on the software model, in this process, and lends it to `work`.
///
/// # Errors
/// When the application does not start, or `work`'s.
pub fn with_host<R>(work: impl FnOnce(&mut dyn Machine) -> anyhow::Result<R>) -> anyhow::Result<R> {
    with_model(|device| start(SharedModel::new(device), None, work))
}

/// Does the same with a mesh file in memory, which stays there until this program ends.
///
/// # Errors
/// As [`with_host`].
pub fn with_host_and_mesh<R>(
    mesh: Vec<u8>,
    work: impl FnOnce(&mut dyn Machine) -> anyhow::Result<R>,
) -> anyhow::Result<R> {
    with_model(|device| start(SharedModel::new(device), Some(mesh.leak()), work))
}

/// Does the same, with a mesh file or without one, and returns the packet words as well that `work` had drawn.
///
/// # Errors
/// As [`with_host`].
pub fn with_recording_host<R>(
    mesh: Option<Vec<u8>>,
    work: impl FnOnce(&mut dyn Machine) -> anyhow::Result<R>,
) -> anyhow::Result<(R, Vec<u32>)> {
    with_model(|device| {
        let model = SharedModel::recording(device);
        let result = start(model.clone(), mesh.map(|mesh| &*mesh.leak()), work)?;
        Ok((result, model.take_words()))
    })
}

fn start<R>(
    model: SharedModel<'_, '_>,
    mesh: Option<&'static [u8]>,
    work: impl FnOnce(&mut dyn Machine) -> anyhow::Result<R>,
) -> anyhow::Result<R> {
    let mut board = HostBoard {
        of_model: PhantomData,
        incoming: VecDeque::new(),
        outgoing: VecDeque::new(),
        console: String::new(),
        mesh,
    };
    let renderer = Renderer::new(model.clone(), NoWait, Timeouts::default())?;
    let mut memory = Box::<Memory>::default();
    let prepared = Prepared::new(&mut board, &mut memory)?;
    let application = Application::new(board, renderer, prepared);
    work(&mut Host { application, model })
}
