//! From a device's reset to the moment when it can be served.

use embassy_usb_driver::Speed;

use crate::descriptor::{self, Configuration, Device, HidInterface, STRING_BYTES};
use crate::hid::{Form, Layout};
use crate::hub::HubTalk;
use crate::input::Input;
use crate::link::{Link, Next};
use crate::mailbox::{Outcome, TransferError};
use crate::reader::Reader;
use crate::setup::{Setup, descriptor as kind};
use crate::talk::Role;
use crate::timing::{Moment, Wait};
use crate::{Fault, Identity, Kind, Memory, Step, Text, dualshock3, dualshock4};

const CLASS_HUB: u8 = 9;

/// What is known of a device so far, and what is to be learned next.
#[derive(Debug)]
pub(crate) struct BringUp {
    stage: Stage,
    /// When it has taken too long.
    pub(crate) deadline: Moment,
    pub(crate) identity: Identity,
    device: Device,
    language: u16,
    configuration: Configuration,
    /// Which of the HID interfaces is looked at.
    hid: usize,
    found: Found,
}

/// What is asked of a device, one after the other, for those that a device has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Stage {
    FirstBytes,
    Address,
    Device,
    /// The configuration descriptor's own part.
    Head,
    Configuration {
        length: usize,
    },
    Languages,
    Maker,
    Name,
    Configure,
    HubDescriptor,
    /// A DualShock 3's.
    Wake(dualshock3::Wake),
    /// A boot keyboard's.
    Protocol,
    ReportDescriptor,
    /// A keyboard's: to report changes alone.
    Quiet,
    Ready,
}

/// What the device turned out to be.
#[expect(clippy::large_enum_variant, reason = "there is no heap to put the larger one on")]
#[derive(Debug, Clone, Copy)]
enum Found {
    Nothing,
    Hub { ports: u8, power_good: u8 },
    Input(Kind, Reader),
}

impl BringUp {
    pub(crate) fn new(deadline: Moment, speed: Speed) -> Self {
        let (maker, name) = (Text::default(), Text::default());
        Self {
            stage: Stage::FirstBytes,
            deadline,
            identity: Identity { vendor: 0, product: 0, class: 0, speed, maker, name },
            device: Device::default(),
            language: 0,
            configuration: Configuration::default(),
            hid: 0,
            found: Found::Nothing,
        }
    }

    pub(crate) fn is_ready(&self) -> bool {
        self.stage == Stage::Ready
    }

    /// Returns what the device is to be served as.
    pub(crate) fn role(&self) -> Role {
        match (&self.found, self.configuration.hub, self.interface()) {
            (&Found::Hub { ports, power_good }, Some(status), _) => Role::Hub(HubTalk::new(ports, power_good, status)),
            (Found::Input(kind, reader), _, Some(hid)) => Role::Input(Input::new(*kind, hid, reader)),
            _ => Role::Alone,
        }
    }

    /// The HID interface that is looked at.
    fn interface(&self) -> Option<&HidInterface> {
        self.configuration.hid.get(self.hid)
    }

    /// Says what is next.
    pub(crate) fn next(&mut self, link: &mut Link, memory: &Memory) -> Next {
        let number = self.interface().map_or(0, |hid| hid.number);
        let (doing, setup, length) = match self.stage {
            Stage::Wake(wake) => {
                return self.interface().map_or(Next::Nothing, |hid| wake.next(link, memory, hid));
            }
            Stage::Ready => return Next::Nothing,
            Stage::FirstBytes => (Step::DeviceDescriptor, get(kind::DEVICE, 0, 0), Device::FIRST_BYTES),
            Stage::Address => (Step::Address, Setup::address(link.slot.address()), 0),
            Stage::Device => (Step::DeviceDescriptor, get(kind::DEVICE, 0, 0), Device::LENGTH),
            Stage::Head => {
                (Step::ConfigurationDescriptor, get(kind::CONFIGURATION, 0, 0), Configuration::HEADER_LENGTH)
            }
            Stage::Configuration { length } => (Step::ConfigurationDescriptor, get(kind::CONFIGURATION, 0, 0), length),
            Stage::Languages => (Step::DeviceDescriptor, get(kind::STRING, 0, 0), STRING_BYTES),
            Stage::Maker => (Step::DeviceDescriptor, get(kind::STRING, self.device.maker, self.language), STRING_BYTES),
            Stage::Name => (Step::DeviceDescriptor, get(kind::STRING, self.device.name, self.language), STRING_BYTES),
            Stage::Configure => (Step::Configuration, Setup::configuration(self.configuration.value), 0),
            Stage::HubDescriptor => (Step::HubDescriptor, Setup::hub_descriptor(), HubTalk::DESCRIPTOR_LENGTH),
            Stage::Protocol => (Step::Protocol, Setup::boot_protocol(number), 0),
            Stage::ReportDescriptor => {
                let length = self.interface().map_or(0, |hid| hid.report_descriptor.into());
                (Step::ReportDescriptor, Setup::report_descriptor(number), length)
            }
            Stage::Quiet => (Step::Protocol, Setup::report_changes_only(number), 0),
        };
        link.read(memory, doing, setup, length)
    }

    /// Takes the answer to what was asked.
    pub(crate) fn answered(&mut self, link: &mut Link, memory: &Memory, answer: Outcome) -> Result<(), Fault> {
        let data = link.data(memory, answer.unwrap_or(0));
        match self.stage {
            // What a device will not tell of its names, it has not.
            Stage::Languages => self.language = descriptor::language(&data).unwrap_or(0),
            Stage::Maker => self.identity.maker = descriptor::text(&data),
            Stage::Name => self.identity.name = descriptor::text(&data),
            Stage::Wake(wake) => {
                if wake.has_to_succeed() {
                    unless_refused(link, answer)?;
                }
            }
            Stage::Protocol | Stage::Quiet | Stage::ReportDescriptor => {
                unless_refused(link, answer)?;
            }
            _ => {
                link.succeeded(answer)?;
            }
        }
        self.stage = match self.stage {
            Stage::FirstBytes => {
                link.packet = Device::packet(&data, link.route.speed).ok_or(link.nonsense())?;
                Stage::Address
            }
            Stage::Address => {
                link.address = link.slot.address();
                link.wait(memory, Wait::ADDRESS_RECOVERY);
                Stage::Device
            }
            Stage::Device => {
                self.device = Device::parse(&data).ok_or(link.nonsense())?;
                let Device { vendor, product, class, .. } = self.device;
                self.identity = Identity { vendor, product, class, ..self.identity };
                Stage::Head
            }
            Stage::Head => Stage::Configuration { length: Configuration::total_length(&data).ok_or(link.nonsense())? },
            Stage::Configuration { .. } => {
                self.configuration = Configuration::parse(&data, link.route.speed).ok_or(link.nonsense())?;
                if self.identity.class == 0 {
                    self.identity.class = self.configuration.class;
                }
                if self.device.maker != 0 || self.device.name != 0 { Stage::Languages } else { self.configure(link) }
            }
            Stage::Languages if self.language != 0 && self.device.maker != 0 => Stage::Maker,
            Stage::Languages | Stage::Maker if self.language != 0 && self.device.name != 0 => Stage::Name,
            Stage::Languages | Stage::Maker | Stage::Name => self.configure(link),
            Stage::Configure => self.first_question(),
            Stage::HubDescriptor => {
                let (ports, power_good) = HubTalk::parse(&data).ok_or(link.nonsense())?;
                self.found = Found::Hub { ports, power_good };
                Stage::Ready
            }
            Stage::Wake(wake) => {
                let after = self
                    .interface()
                    .and_then(|hid| wake.after(&data, hid, [&self.identity.maker, &self.identity.name]));
                after.map_or(Stage::Ready, Stage::Wake)
            }
            Stage::Protocol => match answer {
                Ok(_) => {
                    self.found = Found::Input(Kind::BootKeyboard, Reader::BootKeyboard);
                    Stage::Quiet
                }
                Err(_) => self.ask_for_reports(0),
            },
            Stage::ReportDescriptor => match Layout::parse(&data) {
                Some(layout) => self.found_layout(layout),
                None => self.ask_for_reports(self.hid + 1),
            },
            Stage::Quiet | Stage::Ready => Stage::Ready,
        };
        Ok(())
    }

    /// Goes on to use the device, if it is of use.
    fn configure(&mut self, link: &Link) -> Stage {
        let is_hub = self.device.class == CLASS_HUB && link.route.speed != Speed::Low;
        if !is_hub {
            self.configuration.hub = None;
        }
        let of_use = self.configuration.hub.is_some() || !self.configuration.hid.is_empty();
        if of_use { Stage::Configure } else { Stage::Ready }
    }

    /// Goes on with a device that is configured.
    fn first_question(&mut self) -> Stage {
        if self.configuration.hub.is_some() {
            return Stage::HubDescriptor;
        }
        if (self.device.vendor, self.device.product) == dualshock3::PRODUCT {
            self.found = Found::Input(Kind::DualShock3, Reader::DualShock3);
            return Stage::Wake(dualshock3::Wake::FIRST);
        }
        match self.configuration.hid.iter().position(|hid| hid.boot_keyboard) {
            Some(hid) => {
                self.hid = hid;
                Stage::Protocol
            }
            None => self.ask_for_reports(0),
        }
    }

    /// Goes on with the report descriptor of an interface, or ends without.
    fn ask_for_reports(&mut self, hid: usize) -> Stage {
        self.hid = hid;
        if self.interface().is_some() { Stage::ReportDescriptor } else { Stage::Ready }
    }

    fn found_layout(&mut self, layout: Layout) -> Stage {
        let product = (self.device.vendor, self.device.product);
        let (kind, reader, next) = match layout.form {
            Form::Keyboard(_) => (Kind::ReportKeyboard, Reader::Layout(layout), Stage::Quiet),
            Form::Pad(_) if dualshock4::PRODUCTS.contains(&product) => {
                (Kind::DualShock4, Reader::DualShock4(layout), Stage::Ready)
            }
            Form::Pad(_) => (Kind::Gamepad, Reader::Layout(layout), Stage::Ready),
        };
        self.found = Found::Input(kind, reader);
        next
    }
}

const fn get(kind: u8, index: u8, language: u16) -> Setup {
    Setup::descriptor(kind, index, language)
}

/// Takes a refusal for an answer.
fn unless_refused(link: &Link, answer: Outcome) -> Result<(), Fault> {
    match answer {
        Err(TransferError::STALL) => Ok(()),
        other => link.succeeded(other).map(drop),
    }
}
