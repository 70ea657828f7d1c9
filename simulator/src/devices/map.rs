//! The address map, and what each block needs before it answers (hardware.md's sources: Intel's HPS
//! headers and U-Boot's `base_addr_ac5.h`; clock gates as in Linux' `socfpga.dtsi`).

/// A block of registers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Block {
    /// Wide bridge to the FPGA.
    Bridge,
    /// Lightweight bridge to the FPGA.
    LightweightBridge,
    /// FPGA manager.
    FpgaManager,
    /// Where the FPGA manager takes a bitstream.
    FpgaManagerData,
    /// GPIO block 0, 1 or 2.
    Gpio(usize),
    /// Interconnect's remap register.
    L3,
    /// USB controller 1.
    Usb1,
    /// UART0.
    Uart0,
    /// Watchdog 0 or 1 on the peripherals' bus.
    L4Watchdog(usize),
    /// Clock manager.
    ClockManager,
    /// Reset manager.
    ResetManager,
    /// System manager.
    SystemManager,
    /// Snoop control unit.
    Scu,
    /// The core's interrupt interface.
    InterruptInterface,
    /// Global timer.
    GlobalTimer,
    /// The core's timer and watchdog.
    PrivateTimer,
    /// Interrupt distributor.
    InterruptDistributor,
    /// L2 cache controller.
    Pl310,
}

/// A module reset of the reset manager.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reset {
    /// A bit of PERMODRST.
    Peripheral(u32),
    /// None: the block answers while the processor runs.
    None,
}

/// A clock gate of the clock manager.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Gate {
    /// A bit of the main PLL's EN.
    Main(u32),
    /// A bit of the peripheral PLL's EN.
    Peripheral(u32),
    /// None: the clock cannot be turned off by itself.
    None,
}

/// A row of the address map.
#[derive(Debug, Clone, Copy)]
pub struct Row {
    /// As the documents name it.
    pub name: &'static str,
    /// First address.
    pub start: u32,
    /// Length.
    pub bytes: u32,
    /// What answers, or `None` where the simulator has no model.
    pub block: Option<Block>,
    /// What must be out of reset.
    pub reset: Reset,
    /// What clock must run.
    pub gate: Gate,
}

/// l4_main, l4_mp, l4_sp and the peripheral PLL's gates, by bit.
const L4_MAIN: Gate = Gate::Main(0);
const L4_MP: Gate = Gate::Main(2);
const L4_SP: Gate = Gate::Main(3);
const CONFIGURATION: Gate = Gate::Main(8);
/// The USB controllers' clock.
pub(super) const USB_MP: Gate = Gate::Peripheral(2);

const fn modelled(name: &'static str, start: u32, bytes: u32, block: Block) -> Row {
    Row { name, start, bytes, block: Some(block), reset: Reset::None, gate: Gate::None }
}

const fn unmodelled(name: &'static str, start: u32, bytes: u32) -> Row {
    Row { name, start, bytes, block: None, reset: Reset::None, gate: Gate::None }
}

impl Row {
    const fn reset(self, bit: u32) -> Self {
        Self { reset: Reset::Peripheral(bit), ..self }
    }

    const fn gate(self, gate: Gate) -> Self {
        Self { gate, ..self }
    }
}

/// Bit of PERMODRST.
pub(super) const USB1_RESET: u32 = 3;

const KIB: u32 = 1 << 10;
const MIB: u32 = 1 << 20;

/// All blocks, by rising address.
pub static MAP: &[Row] = &[
    modelled("HPS-to-FPGA bridge", 0xC000_0000, 960 * MIB, Block::Bridge).gate(L4_MAIN),
    unmodelled("STM", 0xFC00_0000, 48 * MIB),
    unmodelled("DAP", 0xFF00_0000, 2 * MIB),
    modelled("lightweight HPS-to-FPGA bridge", 0xFF20_0000, 2 * MIB, Block::LightweightBridge).gate(L4_MAIN),
    unmodelled("bridges' configuration ports", 0xFF40_0000, 3 * MIB),
    unmodelled("EMAC0", 0xFF70_0000, 8 * KIB).reset(0),
    unmodelled("EMAC1", 0xFF70_2000, 8 * KIB).reset(1),
    unmodelled("SDMMC", 0xFF70_4000, 4 * KIB).reset(22),
    unmodelled("QSPI", 0xFF70_5000, 4 * KIB).reset(5),
    modelled("FPGA manager", 0xFF70_6000, 4 * KIB, Block::FpgaManager).gate(L4_MP),
    unmodelled("ACP ID mapper", 0xFF70_7000, 4 * KIB),
    modelled("GPIO0", 0xFF70_8000, 4 * KIB, Block::Gpio(0)).reset(25).gate(L4_MP),
    modelled("GPIO1", 0xFF70_9000, 4 * KIB, Block::Gpio(1)).reset(26).gate(L4_MP),
    modelled("GPIO2", 0xFF70_A000, 4 * KIB, Block::Gpio(2)).reset(27).gate(L4_MP),
    modelled("L3 interconnect", 0xFF80_0000, MIB, Block::L3),
    unmodelled("NAND data", 0xFF90_0000, MIB),
    unmodelled("QSPI data", 0xFFA0_0000, MIB),
    unmodelled("USB0", 0xFFB0_0000, 256 * KIB).reset(2),
    modelled("USB1", 0xFFB4_0000, 256 * KIB, Block::Usb1).reset(USB1_RESET).gate(USB_MP),
    unmodelled("NAND", 0xFFB8_0000, 64 * KIB).reset(4),
    modelled("FPGA manager's data", 0xFFB9_0000, 4 * KIB, Block::FpgaManagerData).gate(CONFIGURATION),
    unmodelled("CAN0", 0xFFC0_0000, 4 * KIB).reset(24),
    unmodelled("CAN1", 0xFFC0_1000, 4 * KIB).reset(25),
    modelled("UART0", 0xFFC0_2000, 4 * KIB, Block::Uart0).reset(16).gate(L4_SP),
    unmodelled("UART1", 0xFFC0_3000, 4 * KIB).reset(17),
    unmodelled("I2C0 to I2C3", 0xFFC0_4000, 16 * KIB),
    unmodelled("SP timers", 0xFFC0_8000, 8 * KIB),
    unmodelled("SDRAM controller", 0xFFC2_0000, 128 * KIB),
    unmodelled("OSC1 timers", 0xFFD0_0000, 8 * KIB),
    modelled("L4 watchdog 0", 0xFFD0_2000, 4 * KIB, Block::L4Watchdog(0)).reset(6),
    modelled("L4 watchdog 1", 0xFFD0_3000, 4 * KIB, Block::L4Watchdog(1)).reset(7),
    modelled("clock manager", 0xFFD0_4000, 4 * KIB, Block::ClockManager),
    modelled("reset manager", 0xFFD0_5000, 4 * KIB, Block::ResetManager),
    modelled("system manager", 0xFFD0_8000, 16 * KIB, Block::SystemManager),
    unmodelled("DMA controller", 0xFFE0_0000, 8 * KIB),
    unmodelled("SPI slaves", 0xFFE0_2000, 8 * KIB),
    unmodelled("SPI masters", 0xFFF0_0000, 8 * KIB),
    unmodelled("scan manager", 0xFFF0_2000, 4 * KIB),
    unmodelled("boot ROM", 0xFFFD_0000, 64 * KIB),
    modelled("snoop control unit", 0xFFFE_C000, 0x100, Block::Scu),
    modelled("interrupt interface", 0xFFFE_C100, 0x100, Block::InterruptInterface),
    modelled("global timer", 0xFFFE_C200, 0x100, Block::GlobalTimer),
    modelled("private timer and watchdog", 0xFFFE_C600, 0x100, Block::PrivateTimer),
    modelled("interrupt distributor", 0xFFFE_D000, 4 * KIB, Block::InterruptDistributor),
    modelled("L2 cache controller", 0xFFFE_F000, 4 * KIB, Block::Pl310),
];

/// Returns the row of an address.
pub fn row_of(address: u32) -> Option<&'static Row> {
    let after = MAP.partition_point(|row| row.start <= address);
    MAP[..after].last().filter(|row| address - row.start < row.bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_rise_and_do_not_overlap() {
        for pair in MAP.windows(2) {
            assert!(pair[0].start + (pair[0].bytes - 1) < pair[1].start, "{} and {}", pair[0].name, pair[1].name);
        }
    }

    #[test]
    fn an_address_finds_its_block() {
        assert_eq!(row_of(0xFF20_2004).and_then(|row| row.block), Some(Block::LightweightBridge));
        assert_eq!(row_of(0xFFFE_C620).and_then(|row| row.block), Some(Block::PrivateTimer));
        assert!(row_of(0xFFC0_4000).is_some_and(|row| row.block.is_none()));
        assert!(row_of(0xFFFE_C300).is_none(), "between the global and the private timer");
        assert!(row_of(0x8000_0000).is_none());
    }
}
