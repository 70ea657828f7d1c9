//! A bus for tests: it keeps a journal, and a model of the devices answers.

extern crate std;

use super::Bus;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::rc::Rc;
use std::vec::Vec;

/// One access.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Access {
    /// A read of an address, and what it gave.
    Read(usize, u32),
    /// A write to an address.
    Write(usize, u32),
    /// A wait for the writes before.
    Settle,
}

/// What answers behind a [`MockBus`].
pub(crate) trait Devices {
    fn read(&mut self, address: usize) -> u32;
    fn write(&mut self, address: usize, value: u32);
}

/// Plain memory, zero at first: devices without a will of their own.
impl Devices for BTreeMap<usize, u32> {
    fn read(&mut self, address: usize) -> u32 {
        self.get(&address).copied().unwrap_or(0)
    }

    fn write(&mut self, address: usize, value: u32) {
        self.insert(address, value);
    }
}

/// A shared handle: the driver has one, the test another.
pub(crate) struct MockBus<D> {
    devices: Rc<RefCell<D>>,
    journal: Rc<RefCell<Vec<Access>>>,
}

impl<D> Clone for MockBus<D> {
    fn clone(&self) -> Self {
        Self { devices: Rc::clone(&self.devices), journal: Rc::clone(&self.journal) }
    }
}

impl<D: Devices> MockBus<D> {
    pub(crate) fn new(devices: D) -> Self {
        Self { devices: Rc::new(RefCell::new(devices)), journal: Rc::default() }
    }

    /// Works on the devices.
    pub(crate) fn devices<T>(&self, work: impl FnOnce(&mut D) -> T) -> T {
        work(&mut self.devices.borrow_mut())
    }

    /// Empties the journal and returns what was in it.
    pub(crate) fn take_journal(&self) -> Vec<Access> {
        self.journal.take()
    }

    /// Empties the journal and returns the writes that were in it.
    pub(crate) fn take_writes(&self) -> Vec<(usize, u32)> {
        let writes = |access: Access| match access {
            Access::Read(..) | Access::Settle => None,
            Access::Write(address, value) => Some((address, value)),
        };
        self.take_journal().into_iter().filter_map(writes).collect()
    }
}

impl<D: Devices> Bus for MockBus<D> {
    fn read(&self, address: usize) -> u32 {
        let value = self.devices.borrow_mut().read(address);
        self.journal.borrow_mut().push(Access::Read(address, value));
        value
    }

    fn write(&self, address: usize, value: u32) {
        self.journal.borrow_mut().push(Access::Write(address, value));
        self.devices.borrow_mut().write(address, value);
    }

    fn settle(&self) {
        self.journal.borrow_mut().push(Access::Settle);
    }
}
