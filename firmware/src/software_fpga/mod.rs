//! The FPGA of a board that has none: the software model, shown on the board's own display.
//!
//! | file | what it holds |
//! | --- | --- |
//! | `display` | what the model asks of a display |
//! | `model_port` | the model as a [`Port`](fpga_regs::Port) |
//! | `start` | the application on such a board |

mod display;
mod model_port;
mod start;

pub use display::{DISPLAY_HEIGHT, DISPLAY_WIDTH, Display};
pub use model_port::{ModelMemory, ModelPort};
pub use start::{ClockWait, StartError, application};
