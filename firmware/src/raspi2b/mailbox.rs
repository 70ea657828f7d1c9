//! The mailbox to the GPU, and its property channel (Raspberry Pi firmware wiki, "Mailbox property
//! interface").
//!
//! A message is an array of words in memory that both see: its size in bytes, 0 (and in the answer
//! 0x8000_0000), tags, 0. A tag is its number, the bytes of its value's room, 0 (and in the answer
//! 0x8000_0000 and the value's length), the value.

use crate::mmio::{Register, Registers, poll};
use core::fmt;
use core::ptr::NonNull;

/// Reads of the status before the GPU is given up: it answers within milliseconds, and a read takes
/// at least 50 ns.
const ANSWER_POLLS: u32 = 10_000_000;
/// Words of the longest message.
const MESSAGE_WORDS: usize = 64;
/// The channel of property messages.
const PROPERTY_CHANNEL: u32 = 8;
const CHANNEL_MASK: u32 = 0xF;
/// How the GPU sees the processor's memory without its own cache in between.
const UNCACHED_BY_GPU: u32 = 0xC000_0000;
const STATUS_FULL: u32 = 1 << 31;
const STATUS_EMPTY: u32 = 1 << 30;
/// What a message and a tag that were understood carry.
const ANSWERED: u32 = 1 << 31;

#[derive(Clone, Copy)]
enum Offset {
    Read = 0x00,
    ReadStatus = 0x18,
    Write = 0x20,
    WriteStatus = 0x38,
}

impl Register for Offset {
    fn offset(self) -> usize {
        self as usize
    }
}

/// Why a message had no answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum MailboxError {
    /// The GPU takes no message, or gives no answer.
    Stuck,
    /// It could not read the message.
    Refused {
        /// What stands where 0x8000_0000 should.
        code: u32,
    },
    /// It does not know the tag, or its value is shorter than wanted.
    NoValue {
        /// The tag.
        tag: u32,
    },
}

impl fmt::Display for MailboxError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Stuck => write!(formatter, "the GPU does not answer its mailbox"),
            Self::Refused { code } => write!(formatter, "the GPU refused a mailbox message: code {code:#010x}"),
            Self::NoValue { tag } => write!(formatter, "the GPU gave no value for mailbox tag {tag:#010x}"),
        }
    }
}

impl core::error::Error for MailboxError {}

/// The property channel.
pub struct Mailbox {
    registers: Registers<Offset>,
    message: NonNull<[u32; MESSAGE_WORDS]>,
}

// SAFETY: the mailbox owns its memory and its device.
unsafe impl Send for Mailbox {}

impl Mailbox {
    /// Returns the driver of the mailbox at `address`, which writes its messages at `message`.
    ///
    /// # Safety
    /// - A BCM2835 mailbox answers at `address`, and no other driver uses it.
    /// - At `message`, 256 bytes of RAM lie that nothing else uses, mapped uncached.
    ///
    /// # Panics
    /// When `message` is 0 or no multiple of 16.
    #[must_use]
    pub unsafe fn at(address: usize, message: usize) -> Self {
        assert!(message.is_multiple_of(16), "the mailbox carries the upper 28 bits of an address");
        let message = NonNull::new(core::ptr::with_exposed_provenance_mut(message));
        // SAFETY: the caller's promise is the same.
        let registers = unsafe { Registers::at(address) };
        Self { registers, message: message.expect("a message is not at address 0") }
    }

    /// Sends tags with their values, each with its answer in place of the value.
    ///
    /// # Errors
    /// [`MailboxError`]; the values are then what they were, or what the GPU answered so far.
    ///
    /// # Panics
    /// When the tags are longer than 61 words.
    pub fn exchange<const N: usize>(&mut self, tags: [(u32, &mut [u32]); N]) -> Result<(), MailboxError> {
        let mut words = [0; MESSAGE_WORDS];
        let mut used = 2;
        for (tag, value) in &tags {
            words[used] = *tag;
            words[used + 1] = 4 * value.len() as u32;
            words[used + 3..][..value.len()].copy_from_slice(value);
            used += 3 + value.len();
        }
        // The end tag is 0.
        words[0] = 4 * (used as u32 + 1);
        self.send(&mut words)?;
        if words[1] != ANSWERED {
            return Err(MailboxError::Refused { code: words[1] });
        }
        let mut at = 2;
        for (tag, value) in tags {
            let answered = words[at + 2];
            if answered & ANSWERED == 0 || ((answered & !ANSWERED) as usize) < 4 * value.len() {
                return Err(MailboxError::NoValue { tag });
            }
            value.copy_from_slice(&words[at + 3..][..value.len()]);
            at += 3 + value.len();
        }
        Ok(())
    }

    fn send(&mut self, words: &mut [u32; MESSAGE_WORDS]) -> Result<(), MailboxError> {
        // SAFETY: `at`'s caller gave the memory to this mailbox alone, and the GPU holds no message.
        unsafe { self.message.write_volatile(*words) };
        // The message is Normal memory, the register is Device memory: order the two.
        core::sync::atomic::fence(core::sync::atomic::Ordering::SeqCst);
        let letter = self.message.addr().get() as u32 | UNCACHED_BY_GPU | PROPERTY_CHANNEL;
        self.wait(Offset::WriteStatus, STATUS_FULL)?;
        self.registers.write(Offset::Write, letter);
        // Another channel's letter would be nobody's.
        let answered = poll(4, || {
            self.wait(Offset::ReadStatus, STATUS_EMPTY).is_ok()
                && self.registers.read(Offset::Read) & CHANNEL_MASK == PROPERTY_CHANNEL
        });
        if !answered {
            return Err(MailboxError::Stuck);
        }
        core::sync::atomic::fence(core::sync::atomic::Ordering::SeqCst);
        // SAFETY: the GPU has answered, and touches the memory no more.
        *words = unsafe { self.message.read_volatile() };
        Ok(())
    }

    /// Waits for a status register's bit to clear.
    fn wait(&self, status: Offset, busy: u32) -> Result<(), MailboxError> {
        if poll(ANSWER_POLLS, || self.registers.read(status) & busy == 0) { Ok(()) } else { Err(MailboxError::Stuck) }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::boxed::Box;

    #[repr(align(16))]
    struct Message([u32; MESSAGE_WORDS]);

    /// A mailbox in plain memory, with what its registers read, and its message.
    fn mailbox(read: u32, status: u32) -> (Mailbox, *const [u32; MESSAGE_WORDS]) {
        let mut registers = [0; 16];
        registers[0] = read;
        registers[6] = status;
        registers[14] = status;
        let registers = (&raw mut *Box::leak(Box::new(registers))).expose_provenance();
        let message = &raw mut Box::leak(Box::new(Message([0xAAAA_AAAA; MESSAGE_WORDS]))).0;
        // SAFETY: plain memory stands in for the device and lives for ever. A pointer of the host
        // does not fit the letter's 32 bits; nobody reads it.
        (unsafe { Mailbox::at(registers, message.expose_provenance()) }, message)
    }

    /// The layout, spelled out from the wiki. Plain memory answers nothing: code 0.
    #[test]
    fn a_message_has_the_firmware_s_layout() {
        let (mut mailbox, message) = mailbox(PROPERTY_CHANNEL, 0);
        let (mut size, mut depth) = ([640, 480], [32]);
        let error = mailbox.exchange([(0x4_8003, &mut size), (0x4_8005, &mut depth)]);
        assert_eq!(error, Err(MailboxError::Refused { code: 0 }));
        // SAFETY: the memory is alive; the driver accesses it by raw pointers alone.
        let words = unsafe { message.read_volatile() };
        assert_eq!(words[..12], [48, 0, 0x4_8003, 8, 0, 640, 480, 0x4_8005, 4, 0, 32, 0]);
    }

    #[test]
    fn a_gpu_that_is_silent_or_writes_to_others_is_given_up() {
        for (read, status) in [(0, STATUS_EMPTY | STATUS_FULL), (1, 0)] {
            let (mut mailbox, _) = mailbox(read, status);
            assert_eq!(mailbox.exchange([(0x4_8005, &mut [32])]), Err(MailboxError::Stuck));
        }
    }
}
