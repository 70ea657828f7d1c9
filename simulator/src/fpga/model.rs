//! The FPGA as `raster-model`, with VGA's vertical blank added: the model itself has no clock.
//!
//! Packets are done as soon as they come. A swap waits for the blank, and what follows it waits in
//! the FIFO; when that is full, the bus is held until the blank, as on the board.

use std::collections::VecDeque;

use fpga_regs::packet::{Header, Kind};
use fpga_regs::registers::{Control, Interrupts, Register, Status};
use fpga_regs::screen::PIXELS;
use raster_model::{Device, Memory};
use self_cell::{MutBorrow, self_cell};

use super::vga::{Beam, next_blank};
use super::{Fpga, Screen};
use crate::time::Clocks;

/// Words of the FIFO, as the design has them.
const FIFO_WORDS: usize = 1024;

/// What the device draws in.
struct Buffers {
    colours: [Vec<u8>; 2],
    depths: Vec<u16>,
    fifo: Vec<u32>,
}

self_cell! {
    struct Owned {
        owner: MutBorrow<Buffers>,
        #[covariant]
        dependent: Device,
    }
}

/// Returns a device with memory of its own, as after reset.
fn device() -> Owned {
    let buffers =
        Buffers { colours: [vec![0; PIXELS], vec![0; PIXELS]], depths: vec![0; PIXELS], fifo: vec![0; FIFO_WORDS] };
    Owned::new(MutBorrow::new(buffers), |buffers| {
        let Buffers { colours: [first, second], depths, fifo } = buffers.borrow_mut();
        let memory = Memory::new([first, second], depths).expect("the buffers have the screen's size");
        Device::new(memory, fifo).expect("the FIFO's depth is in range").with_interrupt(true)
    })
}

/// The design, in software.
pub struct Model {
    device: Owned,
    /// Words that wait behind a swap.
    waiting: VecDeque<u32>,
    /// When the swap that waits takes place.
    swap_at: Option<Clocks>,
    /// The blank in which the last swap took place.
    last_swap: Option<u64>,
    /// The level fell to the mark while words waited; the device itself does not see that.
    low_water: bool,
    shown: u64,
}

impl Default for Model {
    fn default() -> Self {
        Self { device: device(), waiting: VecDeque::new(), swap_at: None, last_swap: None, low_water: false, shown: 0 }
    }
}

impl Model {
    fn register(&self, register: Register) -> u32 {
        self.device.borrow_dependent().read(register)
    }

    fn control(&self) -> Control {
        Control(self.register(Register::Control))
    }

    fn raw_push(&mut self, words: &[u32]) {
        self.device.with_dependent_mut(|_, device| device.push(words));
    }

    /// Returns whether a word, taken now, is a swap that must wait for the blank.
    fn is_swap(&self, word: u32) -> bool {
        let device = self.device.borrow_dependent();
        device.mid_packet().is_none() && Header(word).check() == Ok(Kind::Swap)
    }

    /// Hands a word to the device, or begins to wait with it.
    fn take(&mut self, word: u32, now: Clocks) {
        if self.control().enable() && self.is_swap(word) {
            self.swap_at = Some(next_blank(now, self.last_swap));
            self.waiting.push_front(word);
            // Swapping in the blank takes no time.
            self.advance(now);
        } else {
            self.raw_push(&[word]);
        }
    }

    /// Lets the swap that waits take place, and goes on until the next one.
    fn swap(&mut self, at: Clocks) {
        self.swap_at = None;
        self.last_swap = Some(Beam::at(at).frame);
        self.shown += 1;
        let mark = self.register(Register::LowWater) as usize;
        let before = self.waiting.len();
        if let Some(swap) = self.waiting.pop_front() {
            self.raw_push(&[swap]);
        }
        while self.swap_at.is_none()
            && let Some(word) = self.waiting.pop_front()
        {
            self.take(word, at);
        }
        self.low_water |= before > mark && self.waiting.len() <= mark;
    }
}

impl Fpga for Model {
    fn read(&mut self, offset: u32, now: Clocks) -> u32 {
        self.advance(now);
        let Some(register) = Register::at(offset as usize) else { return 0 };
        let value = self.register(register);
        match register {
            Register::Status => {
                let waits = self.swap_at.is_some();
                let free = FIFO_WORDS.saturating_sub(self.waiting.len().saturating_sub(waits.into()));
                let status = Status(value);
                status
                    .with_fifo_free(status.fifo_free().min(free as u16))
                    .with_busy(status.busy() || waits || !self.waiting.is_empty())
                    .with_swap_pending(waits)
                    .with_vertical_blank(Beam::at(now).in_blank())
                    .0
            }
            Register::Interrupts => {
                let interrupts = Interrupts(value);
                interrupts.with_low_water(interrupts.low_water() || self.low_water).0
            }
            _ => value,
        }
    }

    fn write(&mut self, offset: u32, value: u32, now: Clocks) {
        self.advance(now);
        let Some(register) = Register::at(offset as usize) else { return };
        match register {
            Register::Control if Control(value).reset() => {
                self.waiting.clear();
                (self.swap_at, self.low_water) = (None, false);
            }
            Register::Interrupts => self.low_water &= !Interrupts(value).low_water(),
            _ => {}
        }
        self.device.with_dependent_mut(|_, device| device.write(register, value));
    }

    fn push(&mut self, word: u32, now: Clocks) -> Clocks {
        self.advance(now);
        let Some(swap_at) = self.swap_at else {
            self.take(word, now);
            return 0;
        };
        // The swap itself has left the FIFO.
        if self.waiting.len() <= FIFO_WORDS {
            self.waiting.push_back(word);
            return 0;
        }
        self.swap(swap_at);
        let held = swap_at - now;
        held + self.push(word, swap_at)
    }

    fn advance(&mut self, now: Clocks) {
        while let Some(at) = self.swap_at.filter(|at| *at <= now && self.control().enable()) {
            self.swap(at);
        }
    }

    fn next_event(&self, _: Clocks) -> Clocks {
        self.swap_at.unwrap_or(Clocks::MAX)
    }

    fn interrupt(&self) -> bool {
        self.device.borrow_dependent().interrupt_pending() || self.low_water && self.control().low_water_interrupt()
    }

    fn frames_shown(&self) -> u64 {
        self.shown
    }

    fn screen(&mut self) -> Option<Screen> {
        Some(Screen::doubled(self.device.borrow_dependent().front()))
    }

    fn reset(&mut self, _: Clocks) {
        *self = Self { shown: self.shown, ..Self::default() };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fpga_regs::packet::{Clear, swap};
    use fpga_regs::screen::{DEPTH_FAR, Rgb332};

    fn enabled() -> Model {
        let mut model = Model::default();
        model.write(Register::Control as u32, Control::default().with_enable(true).0, 0);
        model
    }

    fn status(model: &mut Model, now: Clocks) -> Status {
        Status(model.read(Register::Status as u32, now))
    }

    fn first_pixel(model: &mut Model) -> [u8; 3] {
        model.screen().unwrap().pixels()[0]
    }

    #[test]
    fn a_swap_waits_for_the_blank_and_what_follows_waits_behind_it() {
        let mut model = enabled();
        let clear = Clear { colour: Rgb332(7), depth: DEPTH_FAR }.encode();
        for word in clear.iter().chain(&swap()).chain(&clear) {
            assert_eq!(model.push(*word, 1_000), 0);
        }
        let waiting = status(&mut model, 1_000);
        assert!(waiting.swap_pending() && waiting.busy() && !waiting.vertical_blank());
        assert_eq!(usize::from(waiting.fifo_free()), FIFO_WORDS - clear.len());
        assert_eq!((model.frames_shown(), first_pixel(&mut model)), (0, [0; 3]));
        let blank = model.next_event(1_000);
        model.advance(blank);
        assert_eq!((model.frames_shown(), first_pixel(&mut model)), (1, Rgb332(7).to_rgb888()));
        assert!(!status(&mut model, blank).busy());
        assert!(status(&mut model, blank).vertical_blank());
    }

    #[test]
    fn there_is_one_swap_in_a_blank() {
        let mut model = enabled();
        for _ in 0..3 {
            model.push(swap()[0], 0);
        }
        let first = model.next_event(0);
        model.advance(first);
        let second = model.next_event(first);
        assert_eq!(model.frames_shown(), 1);
        assert!((13_346_574..=13_346_575).contains(&(second - first)), "{}", second - first);
    }

    #[test]
    fn a_full_fifo_holds_the_bus_until_the_blank() {
        let mut model = enabled();
        model.push(swap()[0], 0);
        for _ in 0..FIFO_WORDS {
            assert_eq!(model.push(swap()[0], 0), 0);
        }
        assert_eq!(status(&mut model, 0).fifo_free(), 0);
        assert_eq!(model.push(swap()[0], 0), next_blank(0, None));
    }

    #[test]
    fn the_low_water_interrupt_comes_when_what_waited_is_taken() {
        let mut model = enabled();
        let control = Control::default().with_enable(true).with_low_water_interrupt(true);
        model.write(Register::Control as u32, control.0, 0);
        model.write(Register::LowWater as u32, 2, 0);
        let clear = Clear { colour: Rgb332(7), depth: DEPTH_FAR }.encode();
        for word in swap().iter().chain(&clear).chain(&clear) {
            model.push(*word, 0);
        }
        assert!(!model.interrupt());
        let blank = model.next_event(0);
        model.advance(blank);
        assert!(model.interrupt());
        model.write(Register::Interrupts as u32, Interrupts::default().with_low_water(true).0, blank);
        assert!(!model.interrupt());
    }
}
