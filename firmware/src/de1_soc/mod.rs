//! The DE1-SoC: a Cyclone V with a Cortex-A9, started by U-Boot's `go`.
//!
//! | file | what it holds |
//! | --- | --- |
//! | `run` | the program's life: from the first instruction to frames, and back when the FPGA goes |
//! | `board` | the drivers, set up and handed over once; what happens after a fault |
//! | `viewer` | the board as the application wants it |
//! | `connect` | waiting for the FPGA, and for a person |
//! | `interrupts`, `interrupt_wait` | which interrupt does what; waiting for the FPGA, asleep |
//! | `fpga` | FPGA manager, bridges and watchdog in their order |
//! | `fpga_manager`, `bridges`, `watchdog` | each of them |
//! | `bridge_port` | registers and FIFO, for the renderer |
//! | `front_panel`, `readout` | the FPGA's keys, switches, LEDs and displays, and what they show |
//! | `reset_manager`, `reset_cause`, `system_manager`, `history` | why the last run ended, and what follows |
//! | `arguments` | what U-Boot's `go` tells |
//! | `gpio`, `blink` | the HPS LED and key, and what the LED tells |
//! | `uart16550` | console and link |
//! | `memory_map` | where everything is |
//!
//! UART0 is console and link in one: text lies between the link's frames. A frame begins and ends with a zero,
//! which no text has.

pub mod arguments;
pub mod blink;
#[cfg(all(target_arch = "arm", feature = "de1-soc"))]
mod board;
#[cfg(all(target_arch = "arm", feature = "de1-soc"))]
mod bridge_port;
pub mod bridges;
#[cfg(all(target_arch = "arm", feature = "de1-soc"))]
mod connect;
pub mod fpga;
pub mod fpga_manager;
pub mod front_panel;
pub mod gpio;
pub mod history;
#[cfg(all(target_arch = "arm", feature = "de1-soc"))]
mod interrupt_wait;
#[cfg(all(target_arch = "arm", feature = "de1-soc"))]
mod interrupts;
pub mod memory_map;
pub mod readout;
pub mod reset_cause;
pub mod reset_manager;
#[cfg(all(target_arch = "arm", feature = "de1-soc"))]
mod run;
pub mod system_manager;
pub mod uart16550;
#[cfg(all(target_arch = "arm", feature = "de1-soc"))]
mod viewer;
pub mod watchdog;

#[cfg(all(target_arch = "arm", feature = "de1-soc"))]
pub use run::run;
