//! What can go wrong, by name.

use core::fmt;

use embassy_usb_driver::host::PipeError;

/// A failure of the core or of the root port. All transfers under way end with [`TransferError::Disconnected`];
/// the driver starts the core anew by itself after a pause, from the soft reset on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Fault {
    /// GSNPSID is not a DWC2's. Nothing was written to the core.
    WrongCore {
        /// What GSNPSID reads.
        id: u32,
    },
    /// The core has no internal DMA (GHWCFG2.ARCH is not 2).
    NoInternalDma {
        /// What GHWCFG2 reads.
        hardware: u32,
    },
    /// The core's FIFO memory is too small.
    FifoTooSmall {
        /// Words that the driver needs.
        needed: u16,
        /// Words that the core has.
        present: u16,
    },
    /// The board's DMA memory is too short or not on a cache line.
    BadDmaMemory {
        /// Its length in bytes.
        length: usize,
        /// Its bus address.
        address: u32,
    },
    /// The AHB master never went idle.
    NeverIdle,
    /// The soft reset never ended: usually the PHY gives no clock.
    ResetStuck,
    /// The core never entered host mode.
    NotHost,
    /// A FIFO flush never ended.
    FlushStuck,
    /// The port did not come up after a reset of the bus.
    PortNotEnabled,
    /// The core disabled the port (a device babbled over the end of a frame).
    PortDisabled,
    /// Over-current on the port: its power was turned off.
    OverCurrent,
    /// A channel did not halt when told to.
    ChannelStuck {
        /// Which.
        channel: u8,
    },
    /// The core's DMA met a bus error.
    DmaError {
        /// Channel that met it.
        channel: u8,
    },
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::WrongCore { id } => {
                write!(f, "no DWC2 core: GSNPSID reads {id:#010x}, not 0x4f54....; is it out of reset and clocked?")
            }
            Self::NoInternalDma { hardware } => {
                write!(f, "DWC2 core without internal DMA (GHWCFG2 {hardware:#010x}); this driver needs it")
            }
            Self::FifoTooSmall { needed, present } => {
                write!(f, "DWC2 FIFO memory of {present} words, {needed} needed")
            }
            Self::BadDmaMemory { length, address } => write!(
                f,
                "USB DMA memory of {length} bytes at {address:#010x}; {} bytes on a multiple of {} needed",
                crate::DMA_BYTES,
                crate::LINE_BYTES
            ),
            Self::NeverIdle => write!(f, "DWC2 core's bus master does not go idle"),
            Self::ResetStuck => write!(f, "DWC2 soft reset does not end; does the PHY have its clock?"),
            Self::NotHost => write!(f, "DWC2 core does not enter host mode"),
            Self::FlushStuck => write!(f, "DWC2 FIFO flush does not end"),
            Self::PortNotEnabled => write!(f, "USB root port does not come up after a reset; replug the device"),
            Self::PortDisabled => write!(f, "USB root port was disabled by the core; the device spoke past its turn"),
            Self::OverCurrent => write!(f, "USB root port draws too much current; its power was turned off"),
            Self::ChannelStuck { channel } => write!(f, "DWC2 channel {channel} does not halt"),
            Self::DmaError { channel } => write!(f, "DWC2 channel {channel} met a bus error at its DMA address"),
        }
    }
}

impl core::error::Error for Fault {}

/// How a transfer failed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum TransferError {
    /// The device answered STALL.
    Stall,
    /// Three times in a row no answer, or a broken one (USB 2.0 §8.5.1's three strikes).
    NoAnswer,
    /// The device sent more than the packet may hold.
    Babble,
    /// The device sent more than the caller's buffer holds.
    BufferOverflow,
    /// The device went on answering NAK until the time-out.
    Timeout,
    /// The device is gone, or the port was reset since the pipe was allocated.
    Disconnected,
}

impl From<TransferError> for PipeError {
    fn from(error: TransferError) -> Self {
        match error {
            TransferError::Stall => Self::Stall,
            TransferError::NoAnswer => Self::BadResponse,
            TransferError::Babble => Self::Babble,
            TransferError::BufferOverflow => Self::BufferOverflow,
            TransferError::Timeout => Self::Timeout,
            TransferError::Disconnected => Self::Disconnected,
        }
    }
}
