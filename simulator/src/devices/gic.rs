//! The interrupt controller of the Cortex-A9 MPCore (ARM IHI 0048, GIC v1; ARM DDI 0407, chapter 3),
//! as its first core sees it in the secure state. All interrupts are in group 0.

use super::{Answer, no_register};

/// Interrupts that the Cyclone V's controller has.
pub const INTERRUPTS: usize = 256;
/// The first shared one.
const FIRST_SHARED: usize = 32;
/// Software interrupts.
const SOFTWARE: usize = 16;
const WORDS: usize = INTERRUPTS / 32;
/// What an acknowledge reads when nothing is pending.
const SPURIOUS: u32 = 1023;
const IDLE_PRIORITY: u8 = 0xFF;
/// Five bits of a priority exist.
const PRIORITY_BITS: u8 = 0xF8;

/// The controller.
pub struct Gic {
    distributor_on: bool,
    enabled: [u32; WORDS],
    /// Levels of the wires.
    level: [u32; WORDS],
    /// Pending by an edge, by software or by a write to the set-pending register.
    latched: [u32; WORDS],
    active: [u32; WORDS],
    edge: [u32; WORDS],
    priority: [u8; INTERRUPTS],
    targets: [u8; INTERRUPTS],
    interface_control: u32,
    mask: u8,
    binary_point: u32,
    /// Interrupts being served, the last one on top, with the priority that ran before.
    running: Vec<(usize, u8)>,
    acknowledged: u64,
}

impl Default for Gic {
    fn default() -> Self {
        Self {
            distributor_on: false,
            // Software interrupts are always enabled.
            enabled: [0xFFFF, 0, 0, 0, 0, 0, 0, 0],
            level: [0; WORDS],
            latched: [0; WORDS],
            active: [0; WORDS],
            edge: [0xFFFF, 0, 0, 0, 0, 0, 0, 0],
            priority: [0; INTERRUPTS],
            targets: [0; INTERRUPTS],
            interface_control: 0,
            mask: 0,
            binary_point: 0,
            running: Vec::new(),
            acknowledged: 0,
        }
    }
}

fn bit(words: &[u32; WORDS], id: usize) -> bool {
    words[id / 32] >> (id % 32) & 1 != 0
}

fn set_bit(words: &mut [u32; WORDS], id: usize, value: bool) {
    let mask = 1 << (id % 32);
    if value { words[id / 32] |= mask } else { words[id / 32] &= !mask }
}

impl Gic {
    /// Sets the level of an interrupt's wire.
    pub fn set_level(&mut self, id: usize, level: bool) {
        if level && !bit(&self.level, id) && bit(&self.edge, id) {
            set_bit(&mut self.latched, id, true);
        }
        set_bit(&mut self.level, id, level);
    }

    /// Returns how many interrupts the core has acknowledged.
    pub fn acknowledged(&self) -> u64 {
        self.acknowledged
    }

    fn pending_words(&self) -> [u32; WORDS] {
        std::array::from_fn(|word| self.latched[word] | self.level[word] & !self.edge[word])
    }

    /// Returns the interrupt that the core would acknowledge.
    fn best(&self) -> Option<usize> {
        if !self.distributor_on || self.interface_control & 1 == 0 {
            return None;
        }
        let pending = self.pending_words();
        let mut best: Option<usize> = None;
        for (word, pending) in pending.iter().enumerate() {
            let mut bits = pending & self.enabled[word] & !self.active[word];
            while bits != 0 {
                let id = word * 32 + bits.trailing_zeros() as usize;
                bits &= bits - 1;
                let targeted = id < FIRST_SHARED || self.targets[id] & 1 != 0;
                if targeted && best.is_none_or(|best| self.priority[id] < self.priority[best]) {
                    best = Some(id);
                }
            }
        }
        best.filter(|id| self.priority[*id] < self.mask && self.priority[*id] < self.running_priority())
    }

    fn running_priority(&self) -> u8 {
        self.running.last().map_or(IDLE_PRIORITY, |(id, _)| self.priority[*id])
    }

    /// Returns the line to the core.
    pub fn output(&self) -> bool {
        self.best().is_some()
    }

    /// Reads a register of the core's interface.
    ///
    /// # Errors
    /// What the access lacked.
    pub fn read_interface(&mut self, offset: u32) -> Answer<u32> {
        Ok(match offset {
            0x00 => self.interface_control,
            0x04 => u32::from(self.mask),
            0x08 => self.binary_point,
            0x0C => self.acknowledge(),
            0x14 => u32::from(self.running_priority()),
            0x18 => self.best().map_or(SPURIOUS, |id| id as u32),
            0xFC => 0x3901_243B,
            _ => return no_register(offset),
        })
    }

    fn acknowledge(&mut self) -> u32 {
        let Some(id) = self.best() else { return SPURIOUS };
        self.running.push((id, self.running_priority()));
        set_bit(&mut self.active, id, true);
        set_bit(&mut self.latched, id, false);
        self.acknowledged += 1;
        id as u32
    }

    /// Writes a register of the core's interface.
    ///
    /// # Errors
    /// What the access lacked.
    pub fn write_interface(&mut self, offset: u32, value: u32) -> Answer<()> {
        match offset {
            0x00 if value & 0b1000 != 0 => return Err("FIQs are not modelled: leave FIQEn 0".into()),
            0x00 => self.interface_control = value & 0x1F,
            0x04 => self.mask = value as u8 & PRIORITY_BITS,
            0x08 => self.binary_point = value & 7,
            0x10 => {
                let id = (value & 0x3FF) as usize;
                match self.running.last() {
                    Some((running, _)) if *running == id => {
                        self.running.pop();
                        set_bit(&mut self.active, id, false);
                    }
                    Some((running, _)) => {
                        return Err(format!(
                            "the end of interrupt {running}, the last acknowledged, before that of {id}"
                        ));
                    }
                    None => return Err(format!("an interrupt being served: the end of {id} has no acknowledge")),
                }
            }
            _ => return no_register(offset),
        }
        Ok(())
    }

    /// Reads a register of the distributor; `bytes` is 1 or 4.
    ///
    /// # Errors
    /// What the access lacked.
    pub fn read_distributor(&self, offset: u32, bytes: u32) -> Answer<u32> {
        let word = (offset as usize % 0x80) / 4;
        let of_words = |words: &[u32; WORDS]| words.get(word).copied().unwrap_or(0);
        Ok(match offset {
            0x000 => self.distributor_on.into(),
            // Two cores, the security extensions, 256 interrupts.
            0x004 => 1 << 10 | 1 << 5 | (WORDS as u32 - 1),
            0x008 => 0x0102_043B,
            0x080..=0x0FC => 0,
            0x100..=0x1FC => of_words(&self.enabled),
            0x200..=0x2FC => of_words(&self.pending_words()),
            0x300..=0x37C => of_words(&self.active),
            0x400..=0x7FF => read_bytes(&self.priority, offset - 0x400, bytes),
            0x800..=0xBFF => {
                let own: [u8; INTERRUPTS] =
                    std::array::from_fn(|id| if id < FIRST_SHARED { 1 } else { self.targets[id] });
                read_bytes(&own, offset - 0x800, bytes)
            }
            0xC00..=0xCFC => {
                let first = (offset as usize - 0xC00) / 4 * 16;
                (0..16)
                    .filter(|at| first + at < INTERRUPTS)
                    .fold(0, |all, at| all | u32::from(bit(&self.edge, first + at)) << (2 * at + 1))
            }
            _ => return no_register(offset),
        })
    }

    /// Writes a register of the distributor; `bytes` is 1 or 4.
    ///
    /// # Errors
    /// What the access lacked.
    pub fn write_distributor(&mut self, offset: u32, bytes: u32, value: u32) -> Answer<()> {
        let word = (offset as usize % 0x80) / 4;
        let change = |words: &mut [u32; WORDS], set: bool| {
            if let Some(bits) = words.get_mut(word) {
                if set { *bits |= value } else { *bits &= !value }
            }
        };
        match offset {
            0x000 => self.distributor_on = value & 1 != 0,
            0x080..=0x0FC if value != 0 => return Err("interrupts in group 1 are not modelled".into()),
            0x080..=0x0FC => {}
            0x100..=0x17C => change(&mut self.enabled, true),
            0x180..=0x1FC => {
                change(&mut self.enabled, false);
                self.enabled[0] |= 0xFFFF;
            }
            0x200..=0x27C => change(&mut self.latched, true),
            0x280..=0x2FC => change(&mut self.latched, false),
            0x400..=0x7FF => {
                write_bytes(&mut self.priority, offset - 0x400, bytes, value);
                for priority in &mut self.priority {
                    *priority &= PRIORITY_BITS;
                }
            }
            0x800..=0xBFF => write_bytes(&mut self.targets, offset - 0x800, bytes, value),
            0xC00..=0xCFC => {
                let first = (offset as usize - 0xC00) / 4 * 16;
                for at in 0..16 {
                    let id = first + at;
                    if (FIRST_SHARED..INTERRUPTS).contains(&id) {
                        set_bit(&mut self.edge, id, value >> (2 * at + 1) & 1 != 0);
                    }
                }
            }
            0xF00 => {
                let to_this_core = match value >> 24 & 3 {
                    0 => value >> 16 & 1 != 0,
                    1 => false,
                    _ => true,
                };
                if to_this_core {
                    set_bit(&mut self.latched, value as usize % SOFTWARE, true);
                }
            }
            _ => return no_register(offset),
        }
        Ok(())
    }
}

fn read_bytes(table: &[u8; INTERRUPTS], offset: u32, bytes: u32) -> u32 {
    (0..bytes).fold(0, |all, at| {
        let byte = table.get((offset + at) as usize).copied().unwrap_or(0);
        all | u32::from(byte) << (8 * at)
    })
}

fn write_bytes(table: &mut [u8; INTERRUPTS], offset: u32, bytes: u32, value: u32) {
    for at in 0..bytes {
        if let Some(byte) = table.get_mut((offset + at) as usize) {
            *byte = (value >> (8 * at)) as u8;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FPGA: usize = 72;

    fn with_fpga_enabled() -> Gic {
        let mut gic = Gic::default();
        gic.write_distributor(0x000, 4, 1).unwrap();
        gic.write_distributor(0x100 + 4 * (FPGA as u32 / 32), 4, 1 << (FPGA % 32)).unwrap();
        gic.write_distributor(0x400 + FPGA as u32, 1, 0xA0).unwrap();
        gic.write_interface(0x00, 1).unwrap();
        gic.write_interface(0x04, 0xF8).unwrap();
        gic
    }

    #[test]
    fn a_shared_interrupt_needs_a_target() {
        let mut gic = with_fpga_enabled();
        gic.set_level(FPGA, true);
        assert!(!gic.output(), "no core is its target");
        gic.write_distributor(0x800 + FPGA as u32, 1, 1).unwrap();
        assert!(gic.output());
        assert_eq!(gic.read_interface(0x0C), Ok(FPGA as u32));
        assert!(!gic.output(), "it is active");
        assert_eq!(gic.read_interface(0x0C), Ok(SPURIOUS));
        gic.write_interface(0x10, FPGA as u32).unwrap();
        assert!(gic.output(), "its level is still high");
        gic.set_level(FPGA, false);
        assert!(!gic.output());
    }

    #[test]
    fn masks_and_priorities_hold_interrupts_back() {
        let mut gic = with_fpga_enabled();
        gic.write_distributor(0x800, 4, 0).unwrap();
        gic.write_distributor(0x800 + FPGA as u32, 1, 1).unwrap();
        gic.write_distributor(0x100, 4, 1 << 29).unwrap();
        gic.write_distributor(0x400 + 29, 1, 0x50).unwrap();
        gic.set_level(FPGA, true);
        gic.write_interface(0x04, 0xA0).unwrap();
        assert!(!gic.output(), "the mask takes only what is more urgent than itself");
        gic.write_interface(0x04, 0xF8).unwrap();
        assert_eq!(gic.read_interface(0x0C), Ok(FPGA as u32));
        gic.set_level(29, true);
        assert_eq!(gic.read_interface(0x0C), Ok(29), "the timer is more urgent and comes in between");
        assert!(gic.write_interface(0x10, FPGA as u32).is_err(), "ends come in reverse order");
        gic.write_interface(0x10, 29).unwrap();
        gic.write_interface(0x10, FPGA as u32).unwrap();
        assert!(gic.write_interface(0x10, 3).is_err());
    }

    #[test]
    fn an_edge_is_kept() {
        let mut gic = with_fpga_enabled();
        gic.write_distributor(0x800 + FPGA as u32, 1, 1).unwrap();
        gic.write_distributor(0xC00 + 4 * (FPGA as u32 / 16), 4, 0b10 << (2 * (FPGA % 16))).unwrap();
        gic.set_level(FPGA, true);
        gic.set_level(FPGA, false);
        assert_eq!(gic.read_interface(0x0C), Ok(FPGA as u32));
        gic.write_interface(0x10, FPGA as u32).unwrap();
        assert!(!gic.output());
    }
}
