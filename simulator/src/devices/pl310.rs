//! The L2 cache controller (PL310, ARM DDI 0246): its registers; what the operations do is
//! [`Caches`]' matter.

use super::{Answer, no_register, read_only};
use crate::bus::Bus;
use crate::cache::Operation;

const CLEAN: Operation = Operation { clean: true, invalidate: false };
const INVALIDATE: Operation = Operation { clean: false, invalidate: true };
const CLEAN_INVALIDATE: Operation = Operation { clean: true, invalidate: true };
const ALL_WAYS: u32 = 0xFF;

/// The controller's registers.
pub struct Pl310 {
    control: u32,
    auxiliary: u32,
    tag_latency: u32,
    data_latency: u32,
    prefetch: u32,
    power: u32,
    filter_start: u32,
    filter_end: u32,
    /// Ways of an operation by way, until the next register is read.
    busy: u32,
}

impl Pl310 {
    /// Returns the controller as U-Boot leaves it: on, address 0 is SDRAM.
    pub fn as_uboot_leaves_it() -> Self {
        Self {
            control: 1,
            auxiliary: 0x0246_0000 | 1 << 22 | 1 << 28 | 1 << 29,
            tag_latency: 0,
            data_latency: 0x010,
            prefetch: 0,
            power: 0,
            filter_start: 1,
            filter_end: 0xC000_0000,
            busy: 0,
        }
    }

    /// Reads a register.
    ///
    /// # Errors
    /// What the access lacked.
    pub fn read(&mut self, offset: u32) -> Answer<u32> {
        Ok(match offset {
            // RTL release r3p2, as LX' device tree expects none in particular.
            0x000 => 0x4100_00C8,
            // Eight ways of 64 KiB.
            0x004 => 0x9E30_0300,
            0x100 => self.control,
            0x104 => self.auxiliary,
            0x108 => self.tag_latency,
            0x10C => self.data_latency,
            0x214 | 0x21C | 0x220 => 0,
            0x730 => 0,
            // One poll finds a way operation busy.
            0x77C | 0x7BC | 0x7FC => std::mem::take(&mut self.busy),
            0x770 | 0x7B0 | 0x7F0 => 0,
            0xC00 => self.filter_start,
            0xC04 => self.filter_end,
            0xF60 => self.prefetch,
            0xF80 => self.power,
            _ => return no_register(offset),
        })
    }

    /// Writes a register.
    ///
    /// # Errors
    /// What the access lacked.
    pub fn write(&mut self, offset: u32, value: u32, bus: &Bus) -> Answer<()> {
        if self.busy != 0 && (0x730..=0x7FC).contains(&offset) {
            return Err("the end of the operation by way that runs: poll its register until it reads 0".into());
        }
        let off = |name: &str| -> Answer<()> {
            if self.control & 1 == 0 { Ok(()) } else { Err(format!("{name} is written only while the cache is off")) }
        };
        match offset {
            0x100 => {
                self.control = value & 1;
                bus.caches.set_l2(value & 1 != 0);
            }
            0x104 => {
                off("AUX_CTRL")?;
                self.auxiliary = value;
            }
            0x108 => {
                off("TAG_RAM latency")?;
                self.tag_latency = value & 0x777;
            }
            0x10C => {
                off("DATA_RAM latency")?;
                self.data_latency = value & 0x777;
            }
            // No interrupt is ever raised: there is no parity, no error.
            0x214 | 0x220 => {}
            0x730 => {}
            0x770 => bus.caches.l2_line(bus.sdram(), value, INVALIDATE),
            0x7B0 => bus.caches.l2_line(bus.sdram(), value, CLEAN),
            0x7F0 => bus.caches.l2_line(bus.sdram(), value, CLEAN_INVALIDATE),
            0x77C | 0x7BC | 0x7FC => {
                if value & ALL_WAYS != ALL_WAYS {
                    return Err(format!("all eight ways (0xff), not {value:#x}: which lines a way holds nobody knows"));
                }
                let operation = match offset {
                    0x77C => INVALIDATE,
                    0x7BC => CLEAN,
                    _ => CLEAN_INVALIDATE,
                };
                bus.caches.l2_all(bus.sdram(), operation)?;
                self.busy = ALL_WAYS;
            }
            0x004 => return read_only("CACHE_TYPE"),
            0xC00 => self.filter_start = value,
            0xC04 => self.filter_end = value,
            0xF60 => self.prefetch = value,
            0xF80 => self.power = value,
            _ => return no_register(offset),
        }
        Ok(())
    }
}
