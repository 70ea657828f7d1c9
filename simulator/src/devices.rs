//! Everything on the buses that is not memory: where it lies, what it needs to answer, and what
//! wires run between the blocks.

pub mod board_io;
pub mod bridges;
pub mod clock_manager;
pub mod fpga_manager;
pub mod gic;
pub mod global_timer;
pub mod gpio;
pub mod l3;
pub mod l4_watchdog;
pub mod map;
pub mod pl310;
pub mod private_timer;
pub mod reset_manager;
pub mod scu;
pub mod system_manager;
pub mod uart;
pub mod usb;

mod hardware;
mod reset_cause;

pub use hardware::Hardware;
pub use reset_cause::ResetCause;

/// What a register answers, or why it does not.
pub type Answer<T> = Result<T, String>;

/// Says that a block has no register at an offset.
fn no_register<T>(offset: u32) -> Answer<T> {
    Err(format!("no register is modelled at offset {offset:#x}"))
}

/// Says that a register cannot be written.
fn read_only<T>(name: &str) -> Answer<T> {
    Err(format!("{name} is read only"))
}
