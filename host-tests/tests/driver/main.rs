//! The driver against the mock: what it does, access by access.

mod flow;
mod recovery;
mod start;

use fpga_regs::mock::{Access, Behaviour, Mock, Polled};
use fpga_regs::packet::Fence;
use fpga_regs::registers::Register;
use fpga_regs::{RenderError, Renderer, Timeouts};

/// What is written to INTERRUPTS before a look: a one for each of the four.
const EVERY_INTERRUPT: u32 = 0b1111;

fn started(behaviour: Behaviour) -> (Mock, Renderer<Mock, Mock>) {
    let mock = Mock::new(behaviour);
    let renderer =
        Renderer::new(mock.clone(), mock.clone(), Timeouts::default()).expect("the device is as it should be");
    mock.take_journal();
    (mock, renderer)
}

fn polled(behaviour: Behaviour) -> (Mock, Renderer<Mock, Polled>) {
    let mock = Mock::new(behaviour);
    let wait = Polled(mock.clone());
    let renderer = Renderer::new(mock.clone(), wait, Timeouts::default()).expect("the device is as it should be");
    mock.take_journal();
    (mock, renderer)
}

fn refused(mock: &Mock) -> RenderError {
    Renderer::new(mock.clone(), mock.clone(), Timeouts::default()).expect_err("the device is not as it should be")
}

/// Fence packets with tags that tell their place in the stream.
fn fences(count: u32) -> Vec<u32> {
    (0..count).flat_map(|tag| Fence { tag }.encode()).collect()
}

fn status_reads(journal: &[Access]) -> usize {
    journal.iter().filter(|access| matches!(access, Access::Read(Register::Status, _))).count()
}

fn waited_us(journal: &[Access]) -> u32 {
    journal.iter().map(|access| if let Access::Wait(micros) = access { *micros } else { 0 }).sum()
}
