//! Typed access to the core, and the DMA memory's division among pipes.

use crate::registers::Hprt;
use crate::word::Register;
use crate::{Board, LINE_BYTES, PIPE_BUFFER_BYTES};

/// Bytes between one channel's registers and the next one's.
const CHANNEL_STRIDE: u32 = 0x20;

/// The core as the driver sees it.
pub(crate) struct Core<'d> {
    board: &'d mut (dyn Board + Send),
}

/// Which of a pipe's two buffers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Buffer {
    /// The SETUP packet.
    Setup,
    /// Data, from this many bytes on.
    Data(usize),
}

impl Buffer {
    /// Bytes from the start of the DMA memory.
    fn offset(self, pipe: usize) -> usize {
        let start = pipe * (LINE_BYTES + PIPE_BUFFER_BYTES);
        match self {
            Self::Setup => start,
            Self::Data(at) => start + LINE_BYTES + at,
        }
    }
}

/// The whole cache lines that hold `length` bytes from `offset`.
fn lines(offset: usize, length: usize) -> (usize, usize) {
    let first = offset / LINE_BYTES * LINE_BYTES;
    (first, (offset + length).next_multiple_of(LINE_BYTES) - first)
}

impl<'d> Core<'d> {
    pub(crate) fn new(board: &'d mut (dyn Board + Send)) -> Self {
        Self { board }
    }

    pub(crate) fn now(&self) -> u64 {
        self.board.now_us()
    }

    /// Not inlined, as `write_at`: they are called in a hundred places.
    #[inline(never)]
    fn read_at(&mut self, offset: u32) -> u32 {
        self.board.read_register(offset)
    }

    #[inline(never)]
    fn write_at(&mut self, offset: u32, bits: u32) {
        self.board.write_register(offset, bits);
    }

    pub(crate) fn read<R: Register>(&mut self) -> R {
        R::from_bits(self.read_at(R::OFFSET))
    }

    pub(crate) fn write<R: Register>(&mut self, register: R) {
        self.write_at(R::OFFSET, register.bits());
    }

    pub(crate) fn modify<R: Register>(&mut self, change: impl FnOnce(R) -> R) {
        let register = change(self.read());
        self.write(register);
    }

    pub(crate) fn read_channel<R: Register>(&mut self, channel: u8) -> R {
        R::from_bits(self.read_at(R::OFFSET + CHANNEL_STRIDE * u32::from(channel)))
    }

    pub(crate) fn write_channel<R: Register>(&mut self, channel: u8, register: R) {
        self.write_at(R::OFFSET + CHANNEL_STRIDE * u32::from(channel), register.bits());
    }

    #[inline(never)]
    fn port(&mut self) -> Hprt {
        self.read::<Hprt>().kept()
    }

    /// Changes the port and clears none of its write-one-to-clear bits by accident.
    pub(crate) fn modify_port(&mut self, change: impl FnOnce(Hprt) -> Hprt) {
        let port = change(self.port());
        self.write(port);
    }

    /// Length in bytes and bus address of the DMA memory.
    pub(crate) fn memory(&self) -> (usize, u32) {
        (self.board.length(), self.board.bus_address())
    }

    pub(crate) fn bus_address(&self, pipe: usize, buffer: Buffer) -> u32 {
        self.board.bus_address() + buffer.offset(pipe) as u32
    }

    pub(crate) fn copy_in(&mut self, pipe: usize, buffer: Buffer, bytes: &[u8]) {
        self.board.copy_in(buffer.offset(pipe), bytes);
    }

    pub(crate) fn copy_out(&mut self, pipe: usize, buffer: Buffer, bytes: &mut [u8]) {
        self.board.copy_out(buffer.offset(pipe), bytes);
    }

    /// Before the core reads.
    pub(crate) fn clean(&mut self, pipe: usize, buffer: Buffer, length: usize) {
        let (first, length) = lines(buffer.offset(pipe), length);
        self.board.clean(first, length);
    }

    /// Before the core writes, and again before the processor reads what it wrote.
    pub(crate) fn invalidate(&mut self, pipe: usize, buffer: Buffer, length: usize) {
        let (first, length) = lines(buffer.offset(pipe), length);
        self.board.invalidate(first, length);
    }
}
