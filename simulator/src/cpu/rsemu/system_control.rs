//! The system control coprocessor: the library's, with an onlooker for caches and attributes.

use std::fmt;
use std::sync::Arc;

use rsemu::cpu::arm::aprofile::cp::{
    AccessKind, Coprocessor, CpEffect, CpFault, CpOp, CpResult, Fault, Mmu, Pa, PhysMem, Regime, Va,
};
use rsemu::cpu::arm::aprofile::cp15v7::{Cp15v7, sctlr};

use crate::bus::{Bus, Refused};
use crate::cache::{Attribute, Operation};
use crate::cpu::Start;
use crate::violation::Access;

/// ACTLR's bit that makes the core take part in coherency.
const ACTLR_SMP: u32 = 1 << 6;

/// CP15 of the core.
pub(super) struct SystemControl {
    inner: Arc<Cp15v7>,
    bus: Arc<Bus>,
}

impl fmt::Debug for SystemControl {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.inner.fmt(out)
    }
}

/// A register of CP15: opcode 1, CRn, CRm, opcode 2.
type Name = (u8, u8, u8, u8);

const SCTLR: Name = (0, 1, 0, 0);
const ACTLR: Name = (0, 1, 0, 1);
const TTBR0: Name = (0, 2, 0, 0);
const DACR: Name = (0, 3, 0, 0);
const VBAR: Name = (0, 12, 0, 0);
const DCIMVAC: Name = (0, 7, 6, 1);
const DCISW: Name = (0, 7, 6, 2);
const DCCMVAC: Name = (0, 7, 10, 1);
const DCCSW: Name = (0, 7, 10, 2);
const DCCMVAU: Name = (0, 7, 11, 1);
const DCCIMVAC: Name = (0, 7, 14, 1);
const DCCISW: Name = (0, 7, 14, 2);

const CLEAN: Operation = Operation { clean: true, invalidate: false };
const INVALIDATE: Operation = Operation { clean: false, invalidate: true };
const CLEAN_INVALIDATE: Operation = Operation { clean: true, invalidate: true };

impl SystemControl {
    pub(super) fn new(inner: Arc<Cp15v7>, bus: Arc<Bus>) -> Self {
        Self { inner, bus }
    }

    /// Sets the registers as they are when U-Boot's `go` calls a program.
    pub(super) fn as_uboot_leaves_it(&self, start: &Start) {
        let set = |(opc1, crn, crm, opc2): Name, value| {
            let operation = CpOp { cp: 15, opc1, crd: 0, crn, crm, opc2, privileged: true };
            self.inner.mcr(operation, value).expect("the register can be written");
        };
        set(VBAR, start.vectors);
        set(TTBR0, start.translation_table);
        // All domains as managers: nothing is checked.
        set(DACR, u32::MAX);
        let cached = if start.cached { sctlr::M | sctlr::C | sctlr::I } else { 0 };
        // Accesses that are not aligned are trapped, too (U-Boot's `start.S`).
        set(SCTLR, sctlr::Z | sctlr::A | cached);
        self.note_translation();
    }

    fn note_translation(&self) {
        let control = self.inner.sctlr();
        self.bus.set_translation(control & sctlr::M != 0, control & sctlr::C != 0);
    }

    /// Tells the bus what the descriptor of an address says of caching.
    ///
    /// Without TEX remap, and of a short descriptor: a section's or a page's TEX, C and B.
    fn note_attribute(&self, memory: &dyn PhysMem, address: Va, physical: Pa) {
        let table = self.inner.ttbr0() & !0x3FFF;
        let Some(section) = memory.read_u32(Pa(table | address.0 >> 20 << 2)) else { return };
        let (texture, bits) = match section & 0b11 {
            0b01 => {
                let page = Pa(section & !0x3FF | (address.0 >> 12 & 0xFF) << 2);
                let Some(page) = memory.read_u32(page) else { return };
                let texture = if page & 0b11 == 0b01 { page >> 12 } else { page >> 6 };
                (texture & 7, page >> 2 & 3)
            }
            _ => (section >> 12 & 7, section >> 2 & 3),
        };
        let attribute = match (texture, bits) {
            // Strongly ordered; shared and not shared Device.
            (0b000, 0b00 | 0b01) | (0b010, 0b00) => Attribute::Device,
            (0b001, 0b00) | (0b100, _) => Attribute::Uncached,
            _ => Attribute::Cached,
        };
        self.bus.set_attribute(physical.0, attribute);
    }

    /// Does a cache operation's effect; whether it was one.
    fn maintain(&self, name: Name, value: u32, memory: &dyn PhysMem) -> Result<(), Refused> {
        let by_address = |operation| {
            let physical = if self.inner.mmu_enabled() {
                self.bus.set_walking(true);
                let physical = self.inner.translate_debug(memory, Va(value));
                self.bus.set_walking(false);
                physical.map_err(|_| {
                    self.bus.refuse(Access::Maintenance, value, "nothing", "cache maintenance of a mapped address")
                })?
            } else {
                Pa(value)
            };
            self.bus.l1_line(physical.0, operation)
        };
        match name {
            DCIMVAC => by_address(INVALIDATE),
            DCCMVAC | DCCMVAU => by_address(CLEAN),
            DCCIMVAC => by_address(CLEAN_INVALIDATE),
            DCISW => self.bus.l1_set_way(value, INVALIDATE),
            DCCSW => self.bus.l1_set_way(value, CLEAN),
            DCCISW => self.bus.l1_set_way(value, CLEAN_INVALIDATE),
            ACTLR if value & ACTLR_SMP != 0 && !self.bus.hardware().scu_enabled() => Err(self.bus.refuse(
                Access::Maintenance,
                value,
                "ACTLR",
                "the core joins coherency (SMP): enable the snoop control unit first",
            )),
            _ => Ok(()),
        }
    }
}

impl Coprocessor for SystemControl {
    fn mcr_with(&self, operation: CpOp, value: u32, memory: &dyn PhysMem) -> CpResult<CpEffect> {
        let name = (operation.opc1, operation.crn, operation.crm, operation.opc2);
        self.maintain(name, value, memory).map_err(|Refused| CpFault::Undefined)?;
        let effect = self.inner.mcr_with(operation, value, memory)?;
        if name == SCTLR {
            self.note_translation();
        }
        Ok(effect)
    }

    fn mrc(&self, operation: CpOp) -> CpResult<u32> {
        self.inner.mrc(operation)
    }
}

impl Mmu for SystemControl {
    fn regime(&self) -> Regime {
        let regime = self.inner.regime();
        // With the MMU off all data is strongly ordered, and may not be accessed unaligned.
        Regime { alignment_faults: regime.alignment_faults || !regime.translating, ..regime }
    }

    fn translate(&self, memory: &dyn PhysMem, address: Va, kind: AccessKind, privileged: bool) -> Result<Pa, Fault> {
        self.bus.set_walking(true);
        let physical = self.inner.translate(memory, address, kind, privileged);
        if let Ok(physical) = physical {
            self.note_attribute(memory, address, physical);
        }
        self.bus.set_walking(false);
        physical
    }

    fn translate_debug(&self, memory: &dyn PhysMem, address: Va) -> Result<Pa, Fault> {
        self.inner.translate_debug(memory, address)
    }

    fn report_abort(&self, address: Va, fault: Fault, kind: AccessKind) {
        self.inner.report_abort(address, fault, kind);
    }
}
