//! Loads and stores.

use rsemu::cpu::arm::aprofile::cp::AccessKind;

use super::op::{Block, Index, PC, Size, Transfer};
use super::translation::PAGE_BYTES;
use super::{Core, Flow, Stop};

impl Core<'_> {
    #[inline(always)]
    pub(super) fn transfer(&mut self, transfer: Transfer, offset: u32) -> Result<Flow, Stop> {
        let Transfer { load, size, index, rd, rn } = transfer;
        let base = self.base(rn);
        let moved = base.wrapping_add(offset);
        let address = if index == Index::Post { base } else { moved };
        let bytes = match size {
            Size::Word => 4,
            Size::Byte | Size::SignedByte => 1,
            Size::Half | Size::SignedHalf => 2,
        };
        if address & (bytes - 1) != 0 {
            return Err(Stop::Library);
        }
        let kind = if load { AccessKind::Read } else { AccessKind::Write };
        let physical = self.physical(address, kind)?;
        if !load {
            self.bus.write(physical, bytes, self.register(rd) & u32::MAX >> (32 - 8 * bytes))?;
            self.write_back(index, rn, moved);
            return Ok(Flow::Next);
        }
        let value = self.bus.read(physical, bytes)?;
        self.write_back(index, rn, moved);
        let value = match size {
            Size::SignedByte => value as i8 as u32,
            Size::SignedHalf => value as i16 as u32,
            _ => value,
        };
        if rd == PC {
            return Ok(self.exchange(value));
        }
        self.set(rd, value);
        Ok(Flow::Next)
    }

    pub(super) fn pair(&mut self, transfer: Transfer, second: u8, offset: u32) -> Result<Flow, Stop> {
        let Transfer { load, index, rd, rn, .. } = transfer;
        let base = self.base(rn);
        let moved = base.wrapping_add(offset);
        let address = if index == Index::Post { base } else { moved };
        if address & 3 != 0 {
            return Err(Stop::Library);
        }
        let kind = if load { AccessKind::Read } else { AccessKind::Write };
        let places = [self.physical(address, kind)?, self.physical(address.wrapping_add(4), kind)?];
        if load {
            let values = [self.bus.read(places[0], 4)?, self.bus.read(places[1], 4)?];
            self.write_back(index, rn, moved);
            self.set(rd, values[0]);
            self.set(second, values[1]);
        } else {
            self.bus.write(places[0], 4, self.register(rd))?;
            self.bus.write(places[1], 4, self.register(second))?;
            self.write_back(index, rn, moved);
        }
        Ok(Flow::Next)
    }

    /// Goes where a table of halves or bytes says, in steps of two from the program counter.
    pub(super) fn table_branch(&mut self, half: bool, rn: u8, rm: u8) -> Result<Flow, Stop> {
        let (bytes, shift) = if half { (2, 1) } else { (1, 0) };
        let address = self.register(rn).wrapping_add(self.register(rm) << shift);
        if address & (bytes - 1) != 0 {
            return Err(Stop::Library);
        }
        let physical = self.physical(address, AccessKind::Read)?;
        let steps = self.bus.read(physical, bytes)?;
        Ok(Flow::To(self.pc().wrapping_add(2 * steps)))
    }

    /// Returns the register that an address is made of; of the program counter it is the word's.
    #[inline(always)]
    fn base(&self, rn: u8) -> u32 {
        self.register(rn) & if rn == PC { !3 } else { u32::MAX }
    }

    #[inline(always)]
    fn write_back(&mut self, index: Index, rn: u8, moved: u32) {
        if index != Index::Offset {
            self.set(rn, moved);
        }
    }

    pub(super) fn block(&mut self, block: Block) -> Result<Flow, Stop> {
        let Block { load, before, up, writeback, rn, list } = block;
        let base = self.register(rn);
        let bytes = 4 * list.count_ones();
        let moved = if up { base.wrapping_add(bytes) } else { base.wrapping_sub(bytes) };
        let lowest = if up { base } else { moved };
        // Downwards it is the other way round: the lowest register is at the lowest address.
        let first = if before == up { lowest.wrapping_add(4) } else { lowest };
        let last = first.wrapping_add(bytes - 4);
        if first & 3 != 0 || last < first {
            return Err(Stop::Library);
        }
        let kind = if load { AccessKind::Read } else { AccessKind::Write };
        let mut physical = self.physical(first, kind)?;
        let next_page = self.physical(last, kind)? & !(PAGE_BYTES - 1);
        let mut flow = Flow::Next;
        let mut left = list;
        while left != 0 {
            let number = left.trailing_zeros() as u8;
            left &= left - 1;
            if !load {
                self.bus.write(physical, 4, self.register(number))?;
            } else if number == PC {
                let target = self.bus.read(physical, 4)?;
                flow = self.exchange(target);
            } else {
                let value = self.bus.read(physical, 4)?;
                self.set(number, value);
            }
            physical = physical.wrapping_add(4);
            if physical % PAGE_BYTES == 0 {
                physical = next_page;
            }
        }
        if writeback {
            self.set(rn, moved);
        }
        Ok(flow)
    }
}
