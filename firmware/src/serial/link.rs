//! A line in both directions, with its receive interrupt.

use super::{ReceivedWord, SerialError, Transmitter, Uart};
use embedded_io::{ErrorType, Read, ReadReady, Write};
use heapless::spsc::{Consumer, Producer};

/// A line in both directions. What comes in is queued by its interrupt, so that nothing is lost
/// while a frame is drawn. When the queue is full, bytes wait in the UART, and QEMU's sender with
/// them; a real sender's are then lost, and counted.
pub struct Link<U> {
    uart: U,
    out: Transmitter<U>,
    received: Consumer<'static, u8>,
}

/// The link's side in the interrupt handler.
pub struct LinkInterrupt<U> {
    uart: U,
    queue: Producer<'static, u8>,
    damaged: u32,
}

impl<U: Uart> Link<U> {
    /// Returns the link of a UART that is set up, and the part that the interrupt handler holds.
    /// Received bytes come through the queue whose two ends are given.
    #[must_use]
    pub fn new(uart: U, (queue, received): (Producer<'static, u8>, Consumer<'static, u8>)) -> (Self, LinkInterrupt<U>) {
        uart.listen(true);
        let link = Self { uart: uart.clone(), out: Transmitter::new(uart.clone()), received };
        (link, LinkInterrupt { uart, queue, damaged: 0 })
    }
}

impl<U> ErrorType for Link<U> {
    type Error = SerialError;
}

impl<U: Uart> Read for Link<U> {
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
            self.uart.listen(true);
        }
        Ok(count)
    }
}

impl<U: Uart> ReadReady for Link<U> {
    fn read_ready(&mut self) -> Result<bool, SerialError> {
        Ok(self.received.ready())
    }
}

impl<U: Uart> Write for Link<U> {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, SerialError> {
        self.out.write(bytes)
    }

    fn flush(&mut self) -> Result<(), SerialError> {
        self.out.flush()
    }
}

impl<U: Uart> LinkInterrupt<U> {
    /// Takes what has come in. Reading the FIFO empty also drops the interrupt; nothing else does.
    pub fn serve(&mut self) {
        while self.queue.ready() {
            match self.uart.receive() {
                None => return,
                Some(ReceivedWord::Byte(byte)) => {
                    // `ready` said that there is room.
                    let _ = self.queue.enqueue(byte);
                }
                Some(ReceivedWord::Damaged) => self.damaged = self.damaged.saturating_add(1),
            }
        }
        self.uart.listen(false);
    }

    /// Returns how many bytes came in broken, or after others were lost.
    #[must_use]
    pub fn damaged(&self) -> u32 {
        self.damaged
    }
}
