//! What every board shares: the 32-bit ARMv7-A architecture, of the Cortex-A9 and the Cortex-A7.
//!
//! | file | what it holds |
//! | --- | --- |
//! | `start` | from the first instruction to a core's own set-up |
//! | `mmu`, `translation_table` | the flat 1 MiB section table, and turning it on |
//! | `cache`, `cache_geometry` | L1 maintenance |
//! | `sleep` | sleeping until an interrupt |
//! | `exceptions`, `fault_status`, `fault_frame` | fault and panic reports |
//! | `semihosting` | leaving an emulator with an exit code |

#[cfg(target_arch = "arm")]
pub mod cache;
pub mod cache_geometry;
#[cfg(target_arch = "arm")]
pub mod exceptions;
pub mod fault_frame;
#[cfg(all(target_arch = "arm", feature = "fault-injection"))]
pub mod fault_injection;
pub mod fault_status;
#[cfg(target_arch = "arm")]
pub mod mmu;
#[cfg(target_arch = "arm")]
pub mod semihosting;
#[cfg(target_arch = "arm")]
pub mod sleep;
#[cfg(target_arch = "arm")]
pub mod start;
pub mod translation_table;
