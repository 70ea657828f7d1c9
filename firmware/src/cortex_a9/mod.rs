//! What every board with a Cortex-A9 MPCore shares. Addresses come from the board.
//!
//! | file | what it holds |
//! | --- | --- |
//! | `start` | snoop control unit, L2 cache, MMU and L1 caches, in their order |
//! | `l2c310` | the L2 cache controller |
//! | `gic` | interrupt controller |
//! | `private_timer`, `global_timer` | periodic interrupt; 64-bit time and delays |

pub mod gic;
pub mod global_timer;
pub mod l2c310;
pub mod private_timer;
#[cfg(target_arch = "arm")]
pub mod start;

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
