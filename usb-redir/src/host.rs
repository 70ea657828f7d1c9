//! Transfers to a device: what a host controller and its driver make of transactions.
//!
//! The host here is strict, too: a toggle out of turn or a packet longer than the endpoint's size
//! is an error, so a model that is wrong shows.

use std::fmt;
use std::thread;
use std::time::{Duration, Instant};

use usb_model::wire::{Answer, Device, Handshake, Speed, Target, Toggle};

use crate::descriptors::{self, Endpoint};

/// The address that the device is given; QEMU keeps the guest's address for itself.
const ADDRESS: u8 = 1;
/// Longest time that a control transfer may be put off (USB 2.0 §9.2.6.4: 500 ms a data stage).
const NAK_LIMIT: Duration = Duration::from_millis(500);
/// How long a device is left alone after a reset (USB 2.0 §7.1.7.5: 10 ms), and a bit for the clock.
const RESET_RECOVERY: Duration = Duration::from_millis(11);
/// How long it is after SET_ADDRESS (§9.2.6.3: 2 ms), and a bit for the clock.
const ADDRESS_RECOVERY: Duration = Duration::from_millis(3);
/// How long a device that said NAK is left alone.
const NAK_PAUSE: Duration = Duration::from_micros(250);
/// Packet size of endpoint 0 before the descriptor is known: the least that every speed has.
const FIRST_PACKET_SIZE: u8 = 8;

const GET_DESCRIPTOR: u8 = 6;
const DEVICE_DESCRIPTOR: u16 = 0x0100;
const CONFIGURATION_DESCRIPTOR: u16 = 0x0200;
const SET_ADDRESS: u8 = 5;
/// bmRequestType, bRequest, wValue of the request after which an endpoint begins with DATA0 (§9.4.5).
const CLEAR_ENDPOINT_HALT: (u8, u8, u16) = (0x02, 1, 0);

/// How a transfer failed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TransferError {
    /// STALL.
    Stall,
    /// No answer.
    Silent,
    /// NAK for longer than 500 ms.
    Timeout,
    /// A packet longer than the endpoint's size.
    Babble,
    /// A toggle out of turn.
    Toggle,
}

impl fmt::Display for TransferError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Stall => "it stalls",
            Self::Silent => "it does not answer",
            Self::Timeout => "it is busy for more than 500 ms",
            Self::Babble => "its packet is too long",
            Self::Toggle => "its data toggle is out of turn",
        })
    }
}

impl std::error::Error for TransferError {}

/// A control request (USB 2.0 §9.3).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Request {
    /// bmRequestType.
    pub request_type: u8,
    /// bRequest.
    pub request: u8,
    /// wValue.
    pub value: u16,
    /// wIndex.
    pub index: u16,
    /// wLength.
    pub length: u16,
}

impl Request {
    const fn is_in(self) -> bool {
        self.request_type & 0x80 != 0
    }

    fn packet(self) -> [u8; 8] {
        let ([v, w], [i, j], [l, m]) = (self.value.to_le_bytes(), self.index.to_le_bytes(), self.length.to_le_bytes());
        [self.request_type, self.request, v, w, i, j, l, m]
    }
}

/// A device on a port, with a host's view of it.
pub struct Host {
    device: Box<dyn Device + Send>,
    started: Instant,
    speed: Speed,
    address: u8,
    packet_size: u8,
    /// The next toggle of each endpoint, by [`Endpoint::index`].
    toggles: [Toggle; 32],
}

impl Host {
    /// Plugs a device into a port that takes every speed.
    pub fn new(device: Box<dyn Device + Send>) -> Self {
        let speed = device.speed(Speed::High);
        Self {
            device,
            started: Instant::now(),
            speed,
            address: 0,
            packet_size: FIRST_PACKET_SIZE,
            toggles: [Toggle::Data0; 32],
        }
    }

    /// Takes the device out of its port.
    pub fn into_device(self) -> Box<dyn Device + Send> {
        self.device
    }

    /// Returns how fast the device signals.
    pub fn speed(&self) -> Speed {
        self.speed
    }

    /// Resets the device, learns its packet size and gives it an address.
    ///
    /// # Errors
    /// [`TransferError`]; the device is then of no use.
    pub fn reset(&mut self) -> Result<(), TransferError> {
        let (now, speed) = (self.now(), self.speed);
        self.device.reset(now, speed);
        self.address = 0;
        self.packet_size = FIRST_PACKET_SIZE;
        self.reset_toggles();
        thread::sleep(RESET_RECOVERY);
        let start = self.descriptor(DEVICE_DESCRIPTOR, 8)?;
        self.packet_size = start.get(7).copied().unwrap_or(0).max(FIRST_PACKET_SIZE);
        let address = Request { request_type: 0, request: SET_ADDRESS, value: ADDRESS.into(), index: 0, length: 0 };
        self.control(address, &[])?;
        self.address = ADDRESS;
        thread::sleep(ADDRESS_RECOVERY);
        Ok(())
    }

    /// Lets every endpoint but 0 begin with DATA0 again, as a new configuration does.
    pub fn reset_toggles(&mut self) {
        self.toggles = [Toggle::Data0; 32];
    }

    /// Reads the device descriptor.
    ///
    /// # Errors
    /// [`TransferError`].
    pub fn device_descriptor(&mut self) -> Result<Vec<u8>, TransferError> {
        self.descriptor(DEVICE_DESCRIPTOR, 18)
    }

    /// Reads the first configuration's descriptors, all of them.
    ///
    /// # Errors
    /// [`TransferError`].
    pub fn configuration_descriptors(&mut self) -> Result<Vec<u8>, TransferError> {
        let head = self.descriptor(CONFIGURATION_DESCRIPTOR, 9)?;
        let total = head.get(2..4).map_or(0, |bytes| u16::from_le_bytes([bytes[0], bytes[1]]));
        self.descriptor(CONFIGURATION_DESCRIPTOR, total.max(9))
    }

    fn descriptor(&mut self, value: u16, length: u16) -> Result<Vec<u8>, TransferError> {
        self.control(Request { request_type: 0x80, request: GET_DESCRIPTOR, value, index: 0, length }, &[])
    }

    /// Makes a control transfer; `data` is what goes out with it. Returns what came in.
    ///
    /// # Errors
    /// [`TransferError`].
    pub fn control(&mut self, request: Request, data: &[u8]) -> Result<Vec<u8>, TransferError> {
        let target = Target { address: self.address, endpoint: 0 };
        self.again_after_nak(|device, now| device.setup(now, target, request.packet()))?;
        let mut received = Vec::new();
        let mut toggle = Toggle::Data1;
        if request.is_in() && request.length > 0 {
            loop {
                let packet = self.packet_in(target, toggle, self.packet_size.into())?;
                received.extend_from_slice(&packet);
                toggle = other(toggle);
                if packet.len() < self.packet_size.into() || received.len() >= request.length.into() {
                    break;
                }
            }
            received.truncate(request.length.into());
            self.again_after_nak(|device, now| device.data_out(now, target, Toggle::Data1, &[]))?;
        } else {
            for packet in data.chunks(self.packet_size.into()) {
                self.again_after_nak(|device, now| device.data_out(now, target, toggle, packet))?;
                toggle = other(toggle);
            }
            self.packet_in(target, Toggle::Data1, 0)?;
        }
        if (request.request_type, request.request, request.value) == CLEAR_ENDPOINT_HALT {
            self.toggles[descriptors::index(request.index as u8)] = Toggle::Data0;
        }
        Ok(received)
    }

    /// Asks an interrupt IN endpoint once; `None` when it has nothing.
    ///
    /// # Errors
    /// [`TransferError`]; after a STALL the endpoint is halted.
    pub fn interrupt_in(&mut self, endpoint: Endpoint) -> Result<Option<Vec<u8>>, TransferError> {
        let target = Target { address: self.address, endpoint: endpoint.number() };
        let now = self.now();
        match self.device.data_in(now, target) {
            Answer::Nak => Ok(None),
            Answer::Stall => Err(TransferError::Stall),
            Answer::Silent => Err(TransferError::Silent),
            Answer::Data(_, bytes) if bytes.len() > endpoint.packet_size.into() => Err(TransferError::Babble),
            Answer::Data(toggle, bytes) => {
                self.device.acknowledged(now, target);
                let expected = &mut self.toggles[endpoint.index()];
                if toggle != *expected {
                    return Err(TransferError::Toggle);
                }
                *expected = other(toggle);
                Ok(Some(bytes))
            }
        }
    }

    /// Sends data to an interrupt OUT endpoint.
    ///
    /// # Errors
    /// [`TransferError`].
    pub fn interrupt_out(&mut self, endpoint: Endpoint, data: &[u8]) -> Result<(), TransferError> {
        let target = Target { address: self.address, endpoint: endpoint.number() };
        let size = usize::from(endpoint.packet_size).max(1);
        for packet in data.chunks(size) {
            let toggle = self.toggles[endpoint.index()];
            self.again_after_nak(|device, now| device.data_out(now, target, toggle, packet))?;
            self.toggles[endpoint.index()] = other(toggle);
        }
        Ok(())
    }

    /// Takes one packet in, acknowledged.
    fn packet_in(&mut self, target: Target, toggle: Toggle, longest: usize) -> Result<Vec<u8>, TransferError> {
        let limit = Instant::now() + NAK_LIMIT;
        loop {
            let now = self.now();
            match self.device.data_in(now, target) {
                Answer::Nak if Instant::now() < limit => thread::sleep(NAK_PAUSE),
                Answer::Nak => return Err(TransferError::Timeout),
                Answer::Stall => return Err(TransferError::Stall),
                Answer::Silent => return Err(TransferError::Silent),
                Answer::Data(_, bytes) if bytes.len() > longest => return Err(TransferError::Babble),
                Answer::Data(found, _) if found != toggle => return Err(TransferError::Toggle),
                Answer::Data(_, bytes) => {
                    self.device.acknowledged(now, target);
                    return Ok(bytes);
                }
            }
        }
    }

    /// Makes a transaction, and again while the answer is NAK.
    fn again_after_nak(
        &mut self,
        mut transaction: impl FnMut(&mut dyn Device, u64) -> Handshake,
    ) -> Result<(), TransferError> {
        let limit = Instant::now() + NAK_LIMIT;
        loop {
            let now = self.now();
            match transaction(&mut *self.device, now) {
                Handshake::Ack | Handshake::Nyet => return Ok(()),
                Handshake::Nak if Instant::now() < limit => thread::sleep(NAK_PAUSE),
                Handshake::Nak => return Err(TransferError::Timeout),
                Handshake::Stall => return Err(TransferError::Stall),
                Handshake::Silent => return Err(TransferError::Silent),
            }
        }
    }

    fn now(&self) -> u64 {
        self.started.elapsed().as_micros() as u64
    }
}

const fn other(toggle: Toggle) -> Toggle {
    match toggle {
        Toggle::Data0 => Toggle::Data1,
        Toggle::Data1 => Toggle::Data0,
    }
}
