//! The FPGA as the board's program holds it: never touched unless it runs, and never without the
//! watchdog, which alone can end an access that has no answer.

use fpga_regs::error::NotConfigured;

use super::bridges::Bridges;
use super::fpga_manager::{FpgaManager, Status};
use super::history::{Note, Stage};
use super::system_manager::SystemManager;
use super::watchdog::Watchdog;
use crate::mmio::{Bus, Mmio};

/// The FPGA, the way to it, and the watchdog over both.
pub struct Fpga<B = Mmio> {
    /// What the FPGA does, and its configuration.
    pub manager: FpgaManager<B>,
    bridges: Bridges<B>,
    watchdog: Watchdog<B>,
    system: SystemManager<B>,
    failures: u8,
    open: bool,
}

impl<B: Bus> Fpga<B> {
    /// Returns the FPGA with its bridges closed and the watchdog off. `failures` runs before this
    /// one failed in a row.
    #[must_use]
    pub fn new(
        manager: FpgaManager<B>,
        bridges: Bridges<B>,
        watchdog: Watchdog<B>,
        system: SystemManager<B>,
        failures: u8,
    ) -> Self {
        let mut fpga = Self { manager, bridges, watchdog, system, failures, open: false };
        fpga.system.pause_watchdog_in_debug();
        fpga.close();
        fpga
    }

    /// Reads what the FPGA does.
    #[must_use]
    pub fn status(&self) -> Status {
        self.manager.status()
    }

    /// Opens the bridges, if the FPGA runs. From now on the watchdog wants to be fed.
    ///
    /// # Errors
    /// [`NotConfigured`], and nothing was touched.
    pub fn open(&mut self) -> Result<(), NotConfigured> {
        self.status().check()?;
        self.leave_note(Stage::Bridge);
        self.watchdog.start();
        self.bridges.open();
        self.open = true;
        Ok(())
    }

    /// Says that what is behind the bridges answers, and is what it should be.
    pub fn found(&mut self) {
        self.leave_note(Stage::Running);
    }

    /// Says that the run is a good one: failures before it count no more.
    pub fn forgive(&mut self) {
        if self.failures > 0 {
            self.failures = 0;
            self.leave_note(Stage::Running);
        }
    }

    /// Closes the bridges and stops the watchdog.
    pub fn close(&mut self) {
        self.bridges.close();
        self.watchdog.stop();
        self.open = false;
        self.leave_note(Stage::Idle);
    }

    /// Returns whether the bridges are open and the FPGA still runs.
    #[must_use]
    pub fn is_usable(&self) -> bool {
        self.open && self.status().check().is_ok()
    }

    /// Keeps the watchdog quiet; for a main loop that advances. Does nothing while the bridges are closed.
    pub fn advance(&mut self) {
        if self.open {
            self.watchdog.feed();
        }
    }

    fn leave_note(&self, stage: Stage) {
        self.system.leave_note(Note { stage, failures: self.failures }.to_word());
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::super::reset_manager::ResetManager;
    use super::*;
    use crate::mmio::Registers;
    use crate::mmio::mock::MockBus;
    use std::collections::BTreeMap;

    type TestBus = MockBus<BTreeMap<usize, u32>>;

    fn fpga(mode: u32, pins: u32) -> (Fpga<TestBus>, TestBus) {
        let bus = MockBus::new(BTreeMap::from([(0xFF70_6000, mode), (0xFF70_6850, pins)]));
        let resets = ResetManager::new(Registers::on(bus.clone(), 0xFFD0_5000));
        let system = SystemManager::new(Registers::on(bus.clone(), 0xFFD0_8000));
        let fpga = Fpga::new(
            FpgaManager::new(Registers::on(bus.clone(), 0xFF70_6000)),
            Bridges::new(Registers::on(bus.clone(), 0xFF80_0000), resets.clone(), system.clone()),
            Watchdog::new(Registers::on(bus.clone(), 0xFFD0_2000), resets),
            system,
            2,
        );
        (fpga, bus)
    }

    fn note(bus: &TestBus) -> Option<Note> {
        Note::from_word(SystemManager::new(Registers::on(bus.clone(), 0xFFD0_8000)).note()?)
    }

    #[test]
    fn it_begins_closed_and_without_a_watchdog() {
        let (fpga, bus) = fpga(4, 0b111);
        assert!(!fpga.is_usable());
        bus.devices(|memory| {
            assert_eq!(memory[&0xFF80_0000], 0x01);
            assert_eq!(memory[&0xFFD0_501C], 0x7);
            assert_eq!(memory[&0xFFD0_5014], 1 << 6);
        });
        assert_eq!(note(&bus), Some(Note { stage: Stage::Idle, failures: 2 }));
    }

    #[test]
    fn an_fpga_that_does_not_run_is_left_alone() {
        for (mode, pins) in [(0, 0), (2, 0b001), (3, 0b011), (4, 0b011), (5, 0b111)] {
            let (mut fpga, bus) = fpga(mode, pins);
            bus.take_journal();
            assert_eq!(fpga.open(), Err(NotConfigured { mode: mode as u8 }));
            assert_eq!(bus.take_writes(), []);
            assert!(!fpga.is_usable());
        }
    }

    /// First the note and the watchdog, then the bridges: an access that hangs is told about.
    #[test]
    fn opening_is_noted_and_watched_before_a_bridge_shows() {
        let (mut fpga, bus) = fpga(4, 0b111);
        bus.take_journal();
        assert_eq!(fpga.open(), Ok(()));
        let writes = bus.take_writes();
        let at = |wanted: (usize, u32)| writes.iter().position(|write| *write == wanted).expect("it is written");
        let note_word = Note { stage: Stage::Bridge, failures: 2 }.to_word();
        assert!(at((0xFFD0_8098, note_word)) < at((0xFFD0_2000, 1)));
        assert!(at((0xFFD0_200C, 0x76)) < at((0xFF80_0000, 0x19)));
        assert!(fpga.is_usable());
        fpga.found();
        assert_eq!(note(&bus), Some(Note { stage: Stage::Running, failures: 2 }));
        fpga.forgive();
        assert_eq!(note(&bus), Some(Note { stage: Stage::Running, failures: 0 }));
    }

    #[test]
    fn the_watchdog_is_fed_only_while_the_bridges_are_open() {
        let (mut fpga, bus) = fpga(4, 0b111);
        bus.take_journal();
        fpga.advance();
        assert_eq!(bus.take_writes(), []);
        fpga.open().unwrap();
        bus.take_journal();
        fpga.advance();
        assert_eq!(bus.take_writes(), [(0xFFD0_200C, 0x76)]);
        bus.devices(|memory| memory.insert(0xFF70_6000, 2));
        assert!(!fpga.is_usable());
        fpga.close();
        bus.take_journal();
        fpga.advance();
        assert_eq!(bus.take_writes(), []);
    }
}
