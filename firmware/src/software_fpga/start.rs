//! The application on a board without an FPGA.

use core::fmt;

use embedded_hal::delay::DelayNs;
use fpga_regs::{RenderError, Renderer, Timeouts, Wait};

use super::display::Display;
use super::model_port::{ModelMemory, ModelPort};
use crate::app::{Application, Memory, Prepared};
use crate::board::Board;

/// Returns the application on `board`, with the software model on `display`.
///
/// # Errors
/// What did not start.
pub fn application<B, D, T>(
    mut board: B,
    display: D,
    delay: T,
    model_memory: &'static mut ModelMemory,
    memory: &'static mut Memory,
) -> Result<Application<'static, B, ClockWait<T>>, StartError>
where
    B: Board<Port = ModelPort<D>>,
    D: Display,
    T: DelayNs,
{
    let port = ModelPort::new(model_memory, display).map_err(StartError::Model)?;
    let renderer = Renderer::new(port, ClockWait(delay), Timeouts::default()).map_err(StartError::Renderer)?;
    let prepared = Prepared::new(&mut board, memory).map_err(StartError::Mesh)?;
    Ok(Application::new(board, renderer, prepared))
}

/// Why the application did not start.
#[derive(Debug)]
pub enum StartError {
    /// The software model did not take its memory.
    Model(raster_model::SizeError),
    /// The renderer did not find its device as it should be.
    Renderer(RenderError),
    /// A built-in mesh is malformed.
    Mesh(geometry::MeshError),
}

impl fmt::Display for StartError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Model(error) => error.fmt(out),
            Self::Renderer(error) => error.fmt(out),
            Self::Mesh(error) => error.fmt(out),
        }
    }
}

impl core::error::Error for StartError {}

/// Waits by a clock: the model has no interrupt.
pub struct ClockWait<T>(T);

impl<T: DelayNs> Wait for ClockWait<T> {
    const INTERRUPT: bool = false;

    fn wait(&mut self, micros: u32) -> u32 {
        self.0.delay_us(micros);
        micros
    }
}
