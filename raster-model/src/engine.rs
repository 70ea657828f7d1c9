//! What each packet does.

use fpga_regs::Counters;
use fpga_regs::packet::{Clear, Packet, PixelMode, TriangleShape};
use fpga_regs::registers::{Errors, Interrupts};

use crate::decoder::Decoder;
use crate::memory::Memory;
use crate::paint::{DepthGrey, Paint, Planes};
use crate::triangle::{self, Nothing};

/// The device behind its FIFO: takes words, draws, counts and raises flags.
pub(crate) struct Engine<'a> {
    pub(crate) decoder: Decoder,
    pub(crate) memory: Memory<'a>,
    pub(crate) counters: Counters,
    pub(crate) errors: Errors,
    pub(crate) interrupts: Interrupts,
    pub(crate) fence: u32,
}

impl<'a> Engine<'a> {
    /// Returns an engine that draws in `memory`, as it is after reset.
    pub(crate) fn new(memory: Memory<'a>) -> Self {
        Self {
            decoder: Decoder::default(),
            memory,
            counters: Counters::default(),
            errors: Errors::default(),
            interrupts: Interrupts::default(),
            fence: 0,
        }
    }

    /// Forgets everything but the memory: its pixels, and which buffer shows.
    pub(crate) fn reset(&mut self) {
        self.decoder = Decoder::default();
        self.counters = Counters::default();
        self.errors = Errors::default();
        self.interrupts = Interrupts::default();
        self.fence = 0;
    }

    /// Takes all of `words` and does what they say.
    pub(crate) fn take(&mut self, mut words: &[u32]) {
        while let Some(outcome) = self.decoder.take(&mut words) {
            match outcome {
                Ok(packet) => self.execute(&packet),
                Err(_) => {
                    self.counters.bad_packets = self.counters.bad_packets.wrapping_add(1);
                    self.raise_error(Errors::default().with_bad_packet(true));
                }
            }
        }
    }

    /// Sets error flags, and the error interrupt with them.
    pub(crate) fn raise_error(&mut self, errors: Errors) {
        self.errors.0 |= errors.0;
        self.interrupts = self.interrupts.with_error(true);
    }

    fn execute(&mut self, packet: &Packet) {
        match packet {
            Packet::Clear(Clear { colour, depth }) => {
                let (colours, depths) = self.memory.target();
                colours.fill(colour.0);
                depths.fill(*depth);
            }
            Packet::FlatTriangle(triangle) => self.draw(&triangle.shape, triangle.colour, triangle.mode),
            Packet::GouraudTriangle(triangle) => self.draw(&triangle.shape, Planes::from(triangle), triangle.mode),
            Packet::Swap => {
                self.memory.swap();
                let counters = &mut self.counters;
                counters.frames_shown = counters.frames_shown.wrapping_add(1);
                self.interrupts = self.interrupts.with_swap(true);
            }
            Packet::Fence(fence) => {
                self.fence = fence.tag;
                self.interrupts = self.interrupts.with_fence(true);
            }
        }
    }

    fn draw(&mut self, shape: &TriangleShape, paint: impl Paint, mode: PixelMode) {
        let (colours, depths) = self.memory.target();
        let pixels = if mode == PixelMode::USUAL {
            triangle::draw(shape, paint, Nothing, colours, depths)
        } else if mode.depth_grey {
            triangle::draw(shape, DepthGrey, mode, colours, depths)
        } else {
            triangle::draw(shape, paint, mode, colours, depths)
        };
        let counters = &mut self.counters;
        counters.triangles = counters.triangles.wrapping_add(1);
        counters.pixels_tested = counters.pixels_tested.wrapping_add(pixels.tested);
        counters.pixels_written = counters.pixels_written.wrapping_add(pixels.written);
    }
}
