//! A device that QEMU has, and what QEMU asks of it.

use std::time::{Duration, Instant};

use usb_model::wire::Device;

use crate::descriptors::{Configuration, Endpoint};
use crate::host::{Host, Request, TransferError};
use crate::packet::{self, Control, Packet, kind};

const GET_CONFIGURATION: Request = Request { request_type: 0x80, request: 8, value: 0, index: 0, length: 1 };
const SET_CONFIGURATION: Request = Request { request_type: 0x00, request: 9, value: 0, index: 0, length: 0 };
const GET_INTERFACE: Request = Request { request_type: 0x81, request: 10, value: 0, index: 0, length: 1 };
const SET_INTERFACE: Request = Request { request_type: 0x01, request: 11, value: 0, index: 0, length: 0 };
const DEVICE_RESET_FAILED: &str = "the device does not come back from a reset";

/// Packets for QEMU: kind and content.
pub type Packets = Vec<(u32, Vec<u8>)>;

/// A device that QEMU has.
pub struct Plugged {
    host: Host,
    configuration: Configuration,
    /// Endpoints that QEMU wants to hear from, and when they are asked next.
    listening: Vec<(Endpoint, Instant)>,
    /// Interfaces and endpoints are to be told again.
    pub configured_anew: bool,
}

impl Plugged {
    /// Resets a device and reads its descriptors; returns what DEVICE_CONNECT says of it, too.
    pub fn new(device: Box<dyn Device + Send>) -> Result<(Self, Vec<u8>), String> {
        let mut host = Host::new(device);
        let failed = |error: TransferError| format!("the device cannot be plugged in: {error}");
        host.reset().map_err(failed)?;
        let descriptor = host.device_descriptor().map_err(failed)?;
        let configuration = Configuration::parse(&host.configuration_descriptors().map_err(failed)?);
        let connect = packet::device_connect(host.speed(), &descriptor)?;
        Ok((Self { host, configuration, listening: Vec::new(), configured_anew: false }, connect))
    }

    /// Returns the device, for another QEMU.
    pub fn into_device(self) -> Box<dyn Device + Send> {
        self.host.into_device()
    }

    /// Returns what the device's descriptors name.
    pub fn configuration(&self) -> &Configuration {
        &self.configuration
    }

    /// Returns when an endpoint is to be asked next.
    pub fn next_due(&self) -> Option<Instant> {
        self.listening.iter().map(|(_, due)| *due).min()
    }

    /// Asks the endpoints that are due. One that fails is asked no more until QEMU wants it again.
    pub fn ask_endpoints(&mut self) -> Packets {
        let now = Instant::now();
        let Self { host, listening, .. } = self;
        let mut packets = Packets::new();
        listening.retain_mut(|(endpoint, due)| {
            if *due > now {
                return true;
            }
            *due = now + Duration::from_micros(endpoint.period_microseconds(host.speed()));
            let asked = host.interrupt_in(*endpoint);
            match &asked {
                Ok(None) => {}
                Ok(Some(data)) => {
                    let content = packet::interrupt(endpoint.address, 0, data.len() as u16, data);
                    packets.push((kind::INTERRUPT, content));
                }
                Err(_) => {
                    let content = vec![packet::status(&asked), endpoint.address];
                    packets.push((kind::INTERRUPT_RECEIVING_STATUS, content));
                }
            }
            asked.is_ok()
        });
        packets
    }

    /// Does what QEMU asks; returns the answer. What this server does not know has none.
    pub fn serve(&mut self, packet: &Packet) -> Result<Packets, String> {
        let answer = match packet.kind {
            kind::RESET => {
                self.listening.clear();
                self.host.reset().map_err(|error| format!("{DEVICE_RESET_FAILED}: {error}"))?;
                return Ok(Packets::new());
            }
            kind::SET_CONFIGURATION => {
                let (&[value], _) = packet.head()?;
                self.listening.clear();
                let done = self.host.control(Request { value: value.into(), ..SET_CONFIGURATION }, &[]);
                self.host.reset_toggles();
                self.configured_anew = true;
                (kind::CONFIGURATION_STATUS, vec![packet::status(&done), value])
            }
            kind::GET_CONFIGURATION => {
                let found = self.host.control(GET_CONFIGURATION, &[]);
                (kind::CONFIGURATION_STATUS, vec![packet::status(&found), first(&found)])
            }
            kind::SET_ALTERNATE_SETTING => {
                let (&[interface, setting], _) = packet.head()?;
                let request = Request { value: setting.into(), index: interface.into(), ..SET_INTERFACE };
                let done = self.host.control(request, &[]);
                (kind::ALTERNATE_SETTING_STATUS, vec![packet::status(&done), interface, setting])
            }
            kind::GET_ALTERNATE_SETTING => {
                let (&[interface], _) = packet.head()?;
                let found = self.host.control(Request { index: interface.into(), ..GET_INTERFACE }, &[]);
                (kind::ALTERNATE_SETTING_STATUS, vec![packet::status(&found), interface, first(&found)])
            }
            kind::START_INTERRUPT_RECEIVING => {
                let (&[address], _) = packet.head()?;
                let known = self.configuration.endpoint(address).filter(|endpoint| endpoint.is_in());
                self.listening.retain(|(endpoint, _)| endpoint.address != address);
                self.listening.extend(known.map(|endpoint| (endpoint, Instant::now())));
                let status = known.ok_or(TransferError::Stall);
                (kind::INTERRUPT_RECEIVING_STATUS, vec![packet::status(&status), address])
            }
            kind::STOP_INTERRUPT_RECEIVING => {
                let (&[address], _) = packet.head()?;
                self.listening.retain(|(endpoint, _)| endpoint.address != address);
                (kind::INTERRUPT_RECEIVING_STATUS, vec![0, address])
            }
            kind::CONTROL => (kind::CONTROL, self.control(packet)?),
            kind::INTERRUPT => (kind::INTERRUPT, self.interrupt_out(packet)?),
            // Filters, and what other kinds of endpoint would need.
            _ => return Ok(Packets::new()),
        };
        Ok(vec![answer])
    }

    fn control(&mut self, packet: &Packet) -> Result<Vec<u8>, String> {
        let (head, data) = packet.head::<{ Control::BYTES }>()?;
        let control = Control::parse(head);
        let is_in = control.request.request_type & 0x80 != 0;
        let done = self.host.control(control.request, if is_in { &[] } else { data });
        let status = packet::status(&done);
        let received = done.unwrap_or_default();
        let length = match (status, is_in) {
            (0, false) => control.request.length,
            _ => received.len() as u16,
        };
        Ok(control.answer(status, length, &received))
    }

    fn interrupt_out(&mut self, packet: &Packet) -> Result<Vec<u8>, String> {
        let (&[address, _, low, high], data) = packet.head()?;
        let done = match self.configuration.endpoint(address).filter(|endpoint| !endpoint.is_in()) {
            Some(endpoint) => self.host.interrupt_out(endpoint, data),
            None => Err(TransferError::Stall),
        };
        Ok(packet::interrupt(address, packet::status(&done), u16::from_le_bytes([low, high]), &[]))
    }
}

/// Returns the one byte that an answer has.
fn first(answer: &Result<Vec<u8>, TransferError>) -> u8 {
    answer.as_ref().ok().and_then(|bytes| bytes.first()).copied().unwrap_or(0)
}
