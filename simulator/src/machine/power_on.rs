//! What a board is made with.

use std::sync::Arc;

use super::Machine;
use super::uboot::Go;
use crate::bus::Bus;
use crate::cpu::Cpu;
use crate::cpu::rsemu::Interpreter;
use crate::devices::Hardware;
use crate::devices::fpga_manager::FpgaManager;
use crate::fpga::Fpga;
use crate::fpga::faulty::Faulty;
use crate::fpga::model::Model;
use crate::image::{Image, LOAD_ADDRESS};

/// The board before power-on.
pub struct PowerOn {
    card: Image,
    design: Box<dyn Fpga + Send>,
    configured: bool,
    msel: u32,
    bitstream: Option<Vec<u8>>,
    go: Go,
    memory: Vec<(u32, Vec<u8>)>,
}

impl PowerOn {
    /// Returns a board with a program on its card, `raster-model` as its FPGA's design, configured
    /// when the program starts, and the MSEL switch at 0b01010: the processor may configure.
    pub fn new(card: Image) -> Self {
        Self {
            card,
            design: Box::new(Model::default()),
            configured: true,
            msel: 0b01010,
            bitstream: None,
            go: Go { words: vec![format!("{LOAD_ADDRESS:#010x}")], caches_off: false },
            memory: Vec::new(),
        }
    }

    /// Adds words behind U-Boot's `go ADDRESS`.
    #[must_use]
    pub fn arguments(mut self, words: &[&str]) -> Self {
        self.go.words.extend(words.iter().map(ToString::to_string));
        self
    }

    /// Has U-Boot clean its caches and turn them off before it starts the program, as the card's script does.
    #[must_use]
    pub fn caches_off(mut self) -> Self {
        self.go.caches_off = true;
        self
    }

    /// Has U-Boot `load` bytes to an address before it starts the program.
    #[must_use]
    pub fn loaded(mut self, address: u32, bytes: &[u8]) -> Self {
        self.memory.push((address, bytes.to_vec()));
        self
    }

    /// Puts another design into the FPGA.
    #[must_use]
    pub fn design(self, design: Box<dyn Fpga + Send>) -> Self {
        Self { design, ..self }
    }

    /// Leaves the FPGA unconfigured.
    #[must_use]
    pub fn unconfigured(self) -> Self {
        Self { configured: false, ..self }
    }

    /// Turns the MSEL switch.
    #[must_use]
    pub fn msel(self, msel: u32) -> Self {
        Self { msel, ..self }
    }

    /// Says which bitstream makes the design.
    #[must_use]
    pub fn bitstream(self, bitstream: &[u8]) -> Self {
        Self { bitstream: Some(bitstream.to_vec()), ..self }
    }

    /// Turns the power on: U-Boot has loaded the program and jumps to it.
    pub fn start(self) -> Machine {
        let mut manager = FpgaManager::new(self.configured, self.msel);
        if let Some(bitstream) = &self.bitstream {
            manager.expects(bitstream);
        }
        let hardware = Hardware::as_uboot_leaves_it(Faulty::new(self.design), manager);
        let bus = Arc::new(Bus::new(hardware));
        let cpu = Interpreter::new(Arc::clone(&bus));
        let mut card = self.card;
        card.parts.extend(self.memory);
        let mut machine = Machine { bus, cpu, card, go: self.go, console: Vec::new() };
        machine.load();
        machine
    }
}
