//! What every board with a Cortex-A9 MPCore shares. Addresses come from the board.
//!
//! | file | what it holds |
//! | --- | --- |
//! | `start` | from the first instruction to MMU and caches on |
//! | `mmu`, `translation_table` | the flat 1 MiB section table, and turning it on |
//! | `cache`, `cache_geometry`, `l2c310` | L1 maintenance, the L2 cache controller |
//! | `gic` | interrupt controller |
//! | `private_timer`, `global_timer` | periodic interrupt; 64-bit time and delays |
//! | `sleep` | sleeping until an interrupt |
//! | `exceptions`, `fault_status` | fault and panic reports |
//! | `semihosting` | leaving an emulator with an exit code |

#[cfg(target_arch = "arm")]
pub mod cache;
pub mod cache_geometry;
#[cfg(target_arch = "arm")]
pub mod exceptions;
#[cfg(all(target_arch = "arm", feature = "fault-injection"))]
pub mod fault_injection;
pub mod fault_status;
pub mod gic;
pub mod global_timer;
pub mod l2c310;
#[cfg(target_arch = "arm")]
pub mod mmu;
pub mod private_timer;
#[cfg(target_arch = "arm")]
pub mod semihosting;
#[cfg(target_arch = "arm")]
pub mod sleep;
#[cfg(target_arch = "arm")]
pub mod start;
pub mod translation_table;

/// Where a board's processor cluster lies, and its clock.
///
/// Offsets inside the private region are fixed (ARM DDI 0407, §1.5: SCU 0x0000, GIC interface
/// 0x0100, global timer 0x0200, private timer 0x0600, GIC distributor 0x1000).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Cluster {
    /// Start of the private memory region, 8 KiB long (CP15's CBAR names it too).
    pub private_region: usize,
    /// Start of the PL310's registers, 4 KiB long.
    pub l2_cache_controller: usize,
    /// Rate at which global and private timers count (PERIPHCLK), in hertz.
    pub timer_hertz: u32,
}

impl Cluster {
    /// Address of the snoop control unit.
    #[must_use]
    pub const fn snoop_control_unit(&self) -> usize {
        self.private_region
    }

    /// Address of this core's interrupt interface.
    #[must_use]
    pub const fn interrupt_interface(&self) -> usize {
        self.private_region + 0x0100
    }

    /// Address of the global timer.
    #[must_use]
    pub const fn global_timer(&self) -> usize {
        self.private_region + 0x0200
    }

    /// Address of this core's private timer.
    #[must_use]
    pub const fn private_timer(&self) -> usize {
        self.private_region + 0x0600
    }

    /// Address of the interrupt distributor.
    #[must_use]
    pub const fn interrupt_distributor(&self) -> usize {
        self.private_region + 0x1000
    }
}
