//! One conversation with QEMU.

use std::io;
use std::sync::mpsc::{Receiver, TryRecvError};
use std::time::{Duration, Instant};

use usb_model::wire::Device;

use crate::connection::{Connection, wrong};
use crate::packet::{self, Packet, capability, kind};
use crate::plugged::Plugged;

/// How often the socket's owner is listened to.
const ATTENTION: Duration = Duration::from_millis(5);
/// Least time between two looks at the endpoints.
const TICK: Duration = Duration::from_micros(250);
/// How long nothing may have come from QEMU before a device is pulled out: QEMU 7.2 aborts when a
/// request is under way at that moment (its `usb_packet_setup` asserts that none is).
const IDLE: Duration = Duration::from_millis(20);

/// What the socket's owner wants.
pub enum Order {
    /// Plug a device in, in place of what is.
    PlugIn(Box<dyn Device + Send>),
    /// Pull it out.
    PullOut,
}

/// A conversation.
pub struct Session<'a> {
    connection: Connection,
    orders: &'a Receiver<Order>,
    /// A device to plug in.
    waiting: Option<Box<dyn Device + Send>>,
    plugged: Option<Plugged>,
    /// When QEMU sent something last.
    heard: Instant,
    /// QEMU has not said yet that it let the last device go.
    leaving: bool,
}

impl<'a> Session<'a> {
    /// Returns a conversation over a connection. A device that waits is plugged in first.
    pub fn new(connection: Connection, orders: &'a Receiver<Order>, waiting: Option<Box<dyn Device + Send>>) -> Self {
        Self { connection, orders, waiting, plugged: None, heard: Instant::now(), leaving: false }
    }

    /// Goes on until QEMU ends (an error of the kind `UnexpectedEof`) or the socket's owner does (`Ok`).
    pub fn run(&mut self) -> io::Result<()> {
        loop {
            match self.orders.try_recv() {
                Ok(order) => self.obey(order)?,
                Err(TryRecvError::Disconnected) => return Ok(()),
                Err(TryRecvError::Empty) => {}
            }
            if !self.leaving
                && let Some(device) = self.waiting.take()
            {
                self.plug_in(device)?;
            }
            self.ask_endpoints()?;
            if let Some(packet) = self.connection.receive(self.patience())? {
                self.heard = Instant::now();
                self.serve(&packet)?;
            }
        }
    }

    /// Returns the device that is plugged in or waits.
    pub fn into_device(self) -> Option<Box<dyn Device + Send>> {
        self.waiting.or_else(|| self.plugged.map(Plugged::into_device))
    }

    fn obey(&mut self, order: Order) -> io::Result<()> {
        // What QEMU has asked already is answered before its device goes.
        while self.plugged.is_some() && self.heard.elapsed() < IDLE {
            if let Some(packet) = self.connection.receive(IDLE)? {
                self.heard = Instant::now();
                self.serve(&packet)?;
            }
        }
        if self.plugged.take().is_some() {
            self.connection.send(kind::DEVICE_DISCONNECT, 0, &[])?;
            self.leaving = self.connection.can(capability::DISCONNECT_ACKNOWLEDGED);
        }
        self.waiting = match order {
            Order::PlugIn(device) => Some(device),
            Order::PullOut => None,
        };
        Ok(())
    }

    /// How long to wait for QEMU before something else is due.
    fn patience(&self) -> Duration {
        let due = self.plugged.as_ref().and_then(Plugged::next_due);
        due.map_or(ATTENTION, |due| due.saturating_duration_since(Instant::now()).clamp(TICK, ATTENTION))
    }

    fn plug_in(&mut self, device: Box<dyn Device + Send>) -> io::Result<()> {
        let (plugged, connect) = Plugged::new(device).map_err(wrong)?;
        self.plugged = Some(plugged);
        self.describe()?;
        // Without the version, for a side that does not know it.
        let length = if self.connection.can(capability::CONNECT_DEVICE_VERSION) { 10 } else { 8 };
        self.connection.send(kind::DEVICE_CONNECT, 0, &connect[..length])
    }

    /// Tells QEMU the interfaces and endpoints.
    fn describe(&mut self) -> io::Result<()> {
        let Some(plugged) = &self.plugged else { return Ok(()) };
        let configuration = plugged.configuration();
        let interfaces = packet::interface_info(configuration);
        let endpoints = packet::endpoint_info(configuration, self.connection.can(capability::PACKET_SIZES));
        self.connection.send(kind::INTERFACE_INFO, 0, &interfaces)?;
        self.connection.send(kind::ENDPOINT_INFO, 0, &endpoints)
    }

    /// Asks the endpoints that are due, and passes on what they have.
    fn ask_endpoints(&mut self) -> io::Result<()> {
        for (kind, content) in self.plugged.as_mut().map(Plugged::ask_endpoints).unwrap_or_default() {
            self.connection.send(kind, 0, &content)?;
        }
        Ok(())
    }

    fn serve(&mut self, packet: &Packet) -> io::Result<()> {
        if packet.kind == kind::DEVICE_DISCONNECT_ACKNOWLEDGED {
            self.leaving = false;
            return Ok(());
        }
        // What QEMU asked of a device that has gone has no answer.
        let Some(plugged) = &mut self.plugged else { return Ok(()) };
        let answers = plugged.serve(packet).map_err(wrong)?;
        if plugged.configured_anew {
            plugged.configured_anew = false;
            self.describe()?;
        }
        for (kind, content) in answers {
            self.connection.send(kind, packet.id, &content)?;
        }
        Ok(())
    }
}
