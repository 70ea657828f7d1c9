//! The line in both directions, with its receive interrupt.

use super::line::{Config, Line, Offset, RECEIVE_INTERRUPTS, ReceivedWord, SerialError};
use crate::mmio::Registers;
use embedded_io::{ErrorType, Read, ReadReady, Write};
use heapless::spsc::{Consumer, Producer};

/// A line in both directions. What comes in is queued by its interrupt, so that nothing is lost
/// while a frame is drawn. When the queue is full, bytes wait in the UART, and QEMU's sender with
/// them; a real sender's are then lost, and counted.
pub struct Link {
    line: Line,
    received: Consumer<'static, u8>,
}

/// The link's side in the interrupt handler.
pub struct LinkInterrupt {
    line: Line,
    queue: Producer<'static, u8>,
    damaged: u32,
}

impl Link {
    /// Sets a PL011 up for both directions. Received bytes come through the queue whose two ends
    /// are given.
    ///
    /// # Safety
    /// A PL011 answers at `address`, and no other driver writes to it. `queue` and `received` are
    /// two ends of one queue.
    #[must_use]
    pub unsafe fn new(
        address: usize,
        config: &Config,
        (queue, received): (Producer<'static, u8>, Consumer<'static, u8>),
    ) -> (Self, LinkInterrupt) {
        // SAFETY: the caller's promise is the same.
        let line = Line::new(unsafe { Registers::at(address) });
        line.configure(config);
        line.registers.write(Offset::InterruptMask, RECEIVE_INTERRUPTS);
        (Self { line, received }, LinkInterrupt { line, queue, damaged: 0 })
    }
}

impl ErrorType for Link {
    type Error = SerialError;
}

impl Read for Link {
    /// Returns what has come in, at once; 0 means nothing yet, not the end.
    fn read(&mut self, buffer: &mut [u8]) -> Result<usize, SerialError> {
        let mut count = 0;
        for slot in buffer {
            let Some(byte) = self.received.dequeue() else { break };
            *slot = byte;
            count += 1;
        }
        if count > 0 {
            // There is room again: undo what the handler did when the queue was full.
            self.line.registers.write(Offset::InterruptMask, RECEIVE_INTERRUPTS);
        }
        Ok(count)
    }
}

impl ReadReady for Link {
    fn read_ready(&mut self) -> Result<bool, SerialError> {
        Ok(self.received.ready())
    }
}

impl Write for Link {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, SerialError> {
        self.line.write(bytes)
    }

    fn flush(&mut self) -> Result<(), SerialError> {
        self.line.flush()
    }
}

impl LinkInterrupt {
    /// Takes what has come in. Reading the FIFO empty also drops the interrupt; nothing else does.
    pub fn serve(&mut self) {
        while self.queue.ready() {
            match self.line.receive() {
                None => return,
                Some(ReceivedWord::Byte(byte)) => {
                    // `ready` said that there is room.
                    let _ = self.queue.enqueue(byte);
                }
                Some(ReceivedWord::Damaged) => self.damaged = self.damaged.saturating_add(1),
            }
        }
        self.line.registers.write(Offset::InterruptMask, 0);
    }

    /// Returns how many bytes came in broken, or after others were lost.
    #[must_use]
    pub fn damaged(&self) -> u32 {
        self.damaged
    }
}
