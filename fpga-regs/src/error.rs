//! What can go wrong between the driver and the FPGA, each with its remedy.

use core::fmt;

use crate::registers::{Errors, ID_HALF, VERSION_MAJOR};
use crate::screen::{HEIGHT, WIDTH};

/// The FPGA is not configured: its manager is not in user mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct NotConfigured {
    /// Mode field of the FPGA manager's STAT register, 0…7; 4 is user mode.
    pub mode: u8,
}

impl fmt::Display for NotConfigured {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            out,
            "FPGA not configured (FPGA manager mode {:#x}, user mode is 0x4): load the FPGA image, then start again",
            self.mode
        )
    }
}

/// An error of the [`Renderer`](crate::Renderer).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RenderError {
    /// The FPGA is not configured; no register was touched.
    NotConfigured(NotConfigured),
    /// ID does not read "HALF": another design is in the FPGA, or the bridge is closed.
    WrongId {
        /// What ID read.
        found: u32,
    },
    /// The FPGA was built to another major version of the contract.
    WrongVersion {
        /// Its major version.
        major: u16,
        /// Its minor version.
        minor: u16,
    },
    /// The FPGA's screen is not the one that this software was built for.
    WrongScreen {
        /// Its width in pixels.
        width: u16,
        /// Its height in pixels.
        height: u16,
    },
    /// CAPABILITIES names a FIFO that is too small to hold a packet, or no pixel unit.
    WrongCapabilities {
        /// Words of its FIFO.
        fifo_depth: u16,
        /// Its pixel units.
        pixel_units: u8,
    },
    /// CONTROL.reset did not go back to 0.
    ResetStuck {
        /// How long the driver waited, in microseconds.
        waited_us: u32,
    },
    /// The FIFO took no word for the whole time-out.
    FifoStuck {
        /// How long the driver waited without progress, in microseconds.
        waited_us: u32,
        /// Free words at the end.
        free: u16,
        /// Words that were still to be pushed.
        pending: usize,
    },
    /// A fence's tag did not come back.
    FenceTimeout {
        /// How long the driver waited, in microseconds.
        waited_us: u32,
        /// The tag that it waited for.
        expected: u32,
        /// The tag that FENCE held.
        found: u32,
    },
    /// The device raised an error flag.
    Device {
        /// The flags.
        errors: Errors,
        /// Bad packets since reset.
        bad_packets: u32,
    },
}

impl fmt::Display for RenderError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotConfigured(error) => error.fmt(out),
            Self::WrongId { found } => write!(
                out,
                "register ID reads {found:#010x}, not {ID_HALF:#010x} (\"HALF\"): another design is in the FPGA, load Halfspace's"
            ),
            Self::WrongVersion { major, minor } => write!(
                out,
                "FPGA has contract version {major}.{minor}, this software needs {VERSION_MAJOR}.x: load the FPGA image of the same release"
            ),
            Self::WrongScreen { width, height } => write!(
                out,
                "FPGA draws {width}x{height} pixels, this software {WIDTH}x{HEIGHT}: load the FPGA image of the same release"
            ),
            Self::WrongCapabilities { fifo_depth, pixel_units } => write!(
                out,
                "FPGA reports a FIFO of {fifo_depth} words and {pixel_units} pixel units: its build is broken, load another image"
            ),
            Self::ResetStuck { waited_us } => write!(
                out,
                "CONTROL.reset did not return to 0 in {waited_us} µs: is the FPGA's clock running? Reload its image"
            ),
            Self::FifoStuck { waited_us, free, pending } => write!(
                out,
                "FIFO took no word in {waited_us} µs ({free} free, {pending} words pending): reset the renderer; if it stays so, reload the FPGA image"
            ),
            Self::FenceTimeout { waited_us, expected, found } => write!(
                out,
                "fence {expected:#x} not passed in {waited_us} µs (FENCE holds {found:#x}): reset the renderer"
            ),
            Self::Device { errors, bad_packets } => {
                out.write_str("FPGA reports")?;
                if errors.bad_packet() {
                    write!(out, " a bad packet ({bad_packets} since reset)")?;
                }
                if errors.bad_packet() && errors.fifo_overflow() {
                    out.write_str(" and")?;
                }
                if errors.fifo_overflow() {
                    out.write_str(" a write to a full FIFO")?;
                }
                out.write_str(
                    ": reset the renderer; if it comes back, software and FPGA image are not of the same release",
                )
            }
        }
    }
}

impl core::error::Error for RenderError {}
impl core::error::Error for NotConfigured {}

impl From<NotConfigured> for RenderError {
    fn from(error: NotConfigured) -> Self {
        Self::NotConfigured(error)
    }
}
