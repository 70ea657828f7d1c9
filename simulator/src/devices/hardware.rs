//! All blocks together, and the wires between them.

use super::board_io::BoardIo;
use super::bridges::{self, Agent, Gates};
use super::clock_manager::ClockManager;
use super::fpga_manager::FpgaManager;
use super::gic::Gic;
use super::global_timer::GlobalTimer;
use super::gpio::Gpio;
use super::l3::L3;
use super::l4_watchdog::L4Watchdog;
use super::map::{self, Block, Reset, Row};
use super::pl310::Pl310;
use super::private_timer::PrivateTimer;
use super::reset_manager::ResetManager;
use super::scu::Scu;
use super::system_manager::SystemManager;
use super::uart::Uart;
use super::usb::Usb;
use super::{Answer, ResetCause, no_register};
use crate::bus::Bus;
use crate::fpga::Fpga;
use crate::fpga::faulty::Faulty;
use crate::time::{BRIDGE_READ, Clocks, REGISTER_READ, REGISTER_WRITE};
use crate::violation::Access;

/// The levels of the board's pins at the three GPIO blocks: the HPS key is not pressed.
const BOARD_PINS: [u32; 3] = [0, 1 << HPS_KEY, 0];
/// Bit of GPIO1 with the HPS LED.
pub(super) const HPS_LED: u32 = 24;
/// Bit of GPIO1 with the HPS key, low while it is pressed.
const HPS_KEY: u32 = 25;

/// Interrupt numbers (hardware.md's source: Intel's `alt_int_device.h`).
mod interrupt {
    pub(super) const GLOBAL_TIMER: usize = 27;
    pub(super) const PRIVATE_TIMER: usize = 29;
    pub(super) const PRIVATE_WATCHDOG: usize = 30;
    pub(super) const FPGA: usize = fpga_regs::de1_soc::INTERRUPT as usize;
    pub(super) const USB1: usize = 160;
    pub(super) const UART0: usize = 194;
    pub(super) const GPIO0: usize = 196;
    pub(super) const L4_WATCHDOG0: usize = 203;
}

/// The blocks.
pub struct Hardware {
    /// The console's UART.
    pub uart0: Uart,
    /// The interrupt controller.
    pub gic: Gic,
    /// The FPGA manager.
    pub fpga_manager: FpgaManager,
    /// The reset manager.
    pub resets: ResetManager,
    /// The design in the FPGA; it runs while the FPGA is configured.
    pub fpga: Faulty,
    /// The board's own inputs and outputs, in the design too.
    pub board_io: BoardIo,
    /// The USB controller and what is plugged in.
    pub usb: Usb,
    /// The clock manager.
    pub clocks: ClockManager,
    system: SystemManager,
    l3: L3,
    scu: Scu,
    pl310: Pl310,
    global_timer: GlobalTimer,
    private_timer: PrivateTimer,
    l4_watchdogs: [L4Watchdog; 2],
    gpio: [Gpio; 3],
    reset: Option<ResetCause>,
    /// The processor waits for an answer that never comes.
    hung: bool,
}

impl Hardware {
    /// Returns the blocks as U-Boot leaves them after a power-on.
    pub fn as_uboot_leaves_it(fpga: Faulty, fpga_manager: FpgaManager) -> Self {
        Self {
            uart0: Uart::as_uboot_leaves_it(),
            gic: Gic::default(),
            fpga_manager,
            resets: ResetManager::as_uboot_leaves_it(),
            fpga,
            board_io: BoardIo::default(),
            usb: Usb::new(),
            clocks: ClockManager::default(),
            system: SystemManager::as_uboot_leaves_it(),
            l3: L3::default(),
            scu: Scu::default(),
            pl310: Pl310::as_uboot_leaves_it(),
            global_timer: GlobalTimer::default(),
            private_timer: PrivateTimer::default(),
            l4_watchdogs: Default::default(),
            gpio: BOARD_PINS.map(Gpio::new),
            reset: None,
            hung: false,
        }
    }

    /// Resets the processor's side, up to where U-Boot starts the program again. The FPGA stays
    /// configured and its design is reset; pins stay as they are.
    pub fn restart(&mut self, cause: ResetCause, now: Clocks, bus: &Bus) {
        self.uart0.restart();
        self.usb.reset(now, bus);
        self.resets = self.resets.after(cause);
        self.design_starts(now);
        self.fpga_manager.restart();
        self.gic = Gic::default();
        self.clocks = ClockManager::default();
        self.system = self.system.after(cause);
        self.l3 = L3::default();
        self.scu = Scu::default();
        self.pl310 = Pl310::as_uboot_leaves_it();
        self.global_timer = GlobalTimer::default();
        self.private_timer = PrivateTimer::default();
        self.l4_watchdogs = Default::default();
        self.gpio.iter_mut().for_each(Gpio::reset);
        self.reset = None;
        self.hung = false;
    }

    /// Starts the design afresh: the FPGA was configured.
    pub fn design_starts(&mut self, now: Clocks) {
        self.fpga.reset(now);
        self.board_io.reset();
    }

    /// Returns whether the processor waits for an answer that never comes.
    pub fn hung(&self) -> bool {
        self.hung
    }

    /// Returns whether the snoop control unit is on.
    pub fn scu_enabled(&self) -> bool {
        self.scu.enabled()
    }

    /// Returns whether the HPS LED is lit.
    pub fn hps_led(&self) -> bool {
        self.gpio[1].driven() >> HPS_LED & 1 != 0
    }

    /// Presses or releases the HPS key.
    pub fn set_hps_key(&mut self, pressed: bool) {
        self.gpio[1].set_outside(HPS_KEY, !pressed);
    }

    /// Returns the line to the core.
    pub fn interrupt(&self) -> bool {
        self.gic.output()
    }

    /// Returns whether the machine should look before the next instruction.
    pub fn attention(&self) -> bool {
        self.hung || self.reset.is_some() || self.resets.requests()
    }

    /// Takes the reset that is due.
    pub fn take_reset(&mut self) -> Option<ResetCause> {
        self.reset.take().or_else(|| self.resets.take_request())
    }

    /// Lets time pass, and wires follow.
    pub fn advance(&mut self, now: Clocks, bus: &Bus) {
        self.uart0.advance(now);
        self.global_timer.advance(now);
        if self.private_timer.advance(now) {
            self.reset = Some(ResetCause::PrivateWatchdog);
        }
        for (index, watchdog) in self.l4_watchdogs.iter_mut().enumerate() {
            if watchdog.advance(now) {
                self.reset = Some(ResetCause::L4Watchdog(index));
            }
        }
        if self.fpga_manager.configured() {
            self.fpga.advance(now);
        }
        if self.usb_runs() {
            self.usb.advance(now, bus);
        }
        self.wire(now);
    }

    /// Returns whether the USB controller is out of reset and clocked.
    pub fn usb_runs(&self) -> bool {
        !self.resets.holds_peripheral(map::USB1_RESET) && self.clocks.runs(map::USB_MP)
    }

    /// Sets the interrupt controller's inputs.
    fn wire(&mut self, now: Clocks) {
        let levels = [
            (interrupt::GLOBAL_TIMER, self.global_timer.interrupt()),
            (interrupt::PRIVATE_TIMER, self.private_timer.timer_interrupt()),
            (interrupt::PRIVATE_WATCHDOG, self.private_timer.watchdog_interrupt()),
            (interrupt::FPGA, self.fpga_manager.configured() && self.fpga.interrupt()),
            (interrupt::USB1, self.usb_runs() && self.usb.interrupt()),
            (interrupt::UART0, self.uart0.interrupt(now)),
        ];
        for (id, level) in levels {
            self.gic.set_level(id, level);
        }
        for (index, gpio) in self.gpio.iter().enumerate() {
            self.gic.set_level(interrupt::GPIO0 + index, gpio.interrupt());
        }
        for (index, watchdog) in self.l4_watchdogs.iter().enumerate() {
            self.gic.set_level(interrupt::L4_WATCHDOG0 + index, watchdog.interrupt());
        }
    }

    /// Returns when something happens by itself.
    pub fn next_event(&self, now: Clocks) -> Clocks {
        let usb = if self.usb_runs() { self.usb.next_event() } else { Clocks::MAX };
        let watchdogs = self.l4_watchdogs.iter().map(L4Watchdog::next_event).min().unwrap_or(Clocks::MAX);
        let fpga = if self.fpga_manager.configured() { self.fpga.next_event(now) } else { Clocks::MAX };
        [
            self.uart0.next_event(now),
            self.global_timer.next_event(now),
            self.private_timer.next_event(),
            watchdogs,
            fpga,
            usb,
        ]
        .into_iter()
        .min()
        .unwrap_or(Clocks::MAX)
    }

    /// Does an access to a register; returns what was read and how long it took.
    ///
    /// # Errors
    /// The block, and what the access lacked.
    pub fn access(
        &mut self,
        access: Access,
        address: u32,
        now: Clocks,
        bus: &Bus,
    ) -> Result<(u32, Clocks), (String, String)> {
        let Some(row) = map::row_of(address) else {
            return Err(("nothing".into(), "a block of registers, or memory".into()));
        };
        let done = self.ready(row).and_then(|block| {
            self.advance(now, bus);
            let configured = self.fpga_manager.configured();
            let done = self.dispatch(block, access, address - row.start, now, bus)?;
            if !configured && self.fpga_manager.configured() {
                self.design_starts(now);
            }
            self.wire(now);
            Ok(done)
        });
        done.map_err(|needed| (row.name.to_string(), needed))
    }

    /// Returns the block of a row that is modelled, out of reset and clocked.
    fn ready(&self, row: &Row) -> Answer<Block> {
        let Some(block) = row.block else { return Err("a model, which the simulator has not".into()) };
        if let Reset::Peripheral(bit) = row.reset
            && self.resets.holds_peripheral(bit)
        {
            return Err(format!("to be out of reset: clear bit {bit} of PERMODRST (0xffd05014)"));
        }
        if !self.clocks.runs(row.gate) {
            return Err(format!("its clock: {:?} of the clock manager's gates is closed", row.gate));
        }
        Ok(block)
    }

    fn dispatch(&mut self, block: Block, access: Access, offset: u32, now: Clocks, bus: &Bus) -> Answer<(u32, Clocks)> {
        let (bytes, value) = match access {
            Access::Write(bytes, value) => (bytes, Some(value)),
            Access::Read(bytes) => (bytes, None),
            _ => return Err("a read or a write".into()),
        };
        if bytes != 4 && !(block == Block::InterruptDistributor && bytes == 1) {
            return Err(format!("a 32-bit access: {bytes}-byte ones are not answered, or not in full"));
        }
        if matches!(block, Block::Bridge | Block::LightweightBridge) {
            return self.through_bridge(block, offset, value, now);
        }
        if let Some(value) = value {
            self.write(block, offset, bytes, value, now, bus)?;
            return Ok((0, REGISTER_WRITE));
        }
        Ok((self.read(block, offset, bytes, now, bus)?, REGISTER_READ))
    }

    fn read(&mut self, block: Block, offset: u32, bytes: u32, now: Clocks, bus: &Bus) -> Answer<u32> {
        match block {
            Block::FpgaManager => self.fpga_manager.read(offset),
            Block::FpgaManagerData => Err("it is written only".into()),
            Block::Gpio(index) => self.gpio[index].read(offset),
            Block::L3 => self.l3.read(offset),
            Block::Uart0 => self.uart0.read(offset, now),
            Block::L4Watchdog(index) => self.l4_watchdogs[index].read(offset, now),
            Block::ClockManager => self.clocks.read(offset),
            Block::ResetManager => self.resets.read(offset),
            Block::SystemManager => self.system.read(offset),
            Block::Scu => self.scu.read(offset),
            Block::InterruptInterface => self.gic.read_interface(offset),
            Block::GlobalTimer => self.global_timer.read(offset, now),
            Block::PrivateTimer => self.private_timer.read(offset, now),
            Block::InterruptDistributor => self.gic.read_distributor(offset, bytes),
            Block::Pl310 => self.pl310.read(offset),
            Block::Usb1 => Ok(self.usb.read(offset, bus)),
            Block::Bridge | Block::LightweightBridge => no_register(offset),
        }
    }

    fn write(&mut self, block: Block, offset: u32, bytes: u32, value: u32, now: Clocks, bus: &Bus) -> Answer<()> {
        match block {
            Block::FpgaManager => self.fpga_manager.write(offset, value),
            Block::FpgaManagerData => self.fpga_manager.write_data(value),
            Block::Gpio(index) => self.gpio[index].write(offset, value),
            Block::L3 => self.l3.write(offset, value),
            Block::Uart0 => self.uart0.write(offset, value, now),
            Block::L4Watchdog(index) => self.l4_watchdogs[index].write(offset, value, now),
            Block::ClockManager => self.clocks.write(offset, value),
            Block::ResetManager => self.write_resets(offset, value, now, bus),
            Block::SystemManager => self.system.write(offset, value),
            Block::Scu => self.scu.write(offset, value),
            Block::InterruptInterface => self.gic.write_interface(offset, value),
            Block::GlobalTimer => self.global_timer.write(offset, value, now),
            Block::PrivateTimer => self.private_timer.write(offset, value, now),
            Block::InterruptDistributor => self.gic.write_distributor(offset, bytes, value),
            Block::Pl310 => self.pl310.write(offset, value, bus),
            Block::Usb1 => {
                self.usb.write(offset, value, bus);
                Ok(())
            }
            Block::Bridge | Block::LightweightBridge => no_register(offset),
        }
    }

    /// Writes the reset manager; what goes into reset forgets its state.
    fn write_resets(&mut self, offset: u32, value: u32, now: Clocks, bus: &Bus) -> Answer<()> {
        let before = self.resets.peripherals();
        self.resets.write(offset, value)?;
        let into = self.resets.peripherals() & !before;
        for row in map::MAP {
            let Reset::Peripheral(bit) = row.reset else { continue };
            if into >> bit & 1 == 0 {
                continue;
            }
            match row.block {
                Some(Block::Gpio(index)) => self.gpio[index].reset(),
                Some(Block::Uart0) => self.uart0.reset(),
                Some(Block::Usb1) => self.usb.reset(now, bus),
                Some(Block::L4Watchdog(index)) => self.l4_watchdogs[index] = L4Watchdog::default(),
                _ => {}
            }
        }
        Ok(())
    }

    fn through_bridge(&mut self, bridge: Block, offset: u32, value: Option<u32>, now: Clocks) -> Answer<(u32, Clocks)> {
        let gates = Gates {
            l3: &self.l3,
            resets: &self.resets,
            system: &self.system,
            clocks: &self.clocks,
            fpga: &self.fpga_manager,
        };
        let (agent, offset) = bridges::agent(bridge, offset, &gates)?;
        if self.fpga.faults.hangs {
            self.hung = true;
            return Ok((0, 0));
        }
        match (agent, value) {
            (Agent::Registers, None) => Ok((self.fpga.read(offset, now), BRIDGE_READ)),
            (Agent::Registers, Some(value)) => {
                self.fpga.write(offset, value, now);
                Ok((0, REGISTER_WRITE))
            }
            (Agent::Fifo, Some(word)) => Ok((0, REGISTER_WRITE + self.fpga.push(word, now))),
            (Agent::Fifo, None) => Err("a write: the FIFO's aperture is not read".into()),
            (Agent::BoardIo, None) => Ok((self.board_io.read(offset)?, BRIDGE_READ)),
            (Agent::BoardIo, Some(value)) => {
                self.board_io.write(offset, value)?;
                Ok((0, REGISTER_WRITE))
            }
        }
    }
}
