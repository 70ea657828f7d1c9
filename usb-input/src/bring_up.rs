//! From a device's reset to the moment when it can be read.

use embassy_usb_driver::Speed;
use embassy_usb_driver::host::PipeError;
use heapless::String;

use crate::descriptor::{self, Configuration, Device, Endpoint, HidInterface, STRING_BYTES};
use crate::hid::{Form, Layout};
use crate::link::Link;
use crate::mailbox::DATA_BYTES;
use crate::reader::Reader;
use crate::setup::{Setup, descriptor as kind};
use crate::timing::{ADDRESS_RECOVERY_US, POWER_GOOD_UNIT_US, RESET_RECOVERY_US};
use crate::{Fault, Identity, Kind, Step, TEXT_BYTES, dualshock3, dualshock4};

const CLASS_HUB: u8 = 9;

/// What a device is, and how to go on with it.
pub(crate) struct Ready {
    pub(crate) identity: Identity,
    pub(crate) function: Function,
}

/// How to go on with a device.
#[expect(clippy::large_enum_variant, reason = "there is no heap to put the larger one on")]
#[derive(Clone, Copy)]
pub(crate) enum Function {
    Hub(Hub),
    Input {
        kind: Kind,
        hid: HidInterface,
        reader: Reader,
    },
    /// Leave it alone.
    None,
}

/// What a hub tells of itself.
#[derive(Clone, Copy)]
pub(crate) struct Hub {
    pub(crate) ports: u8,
    pub(crate) power_good_us: u64,
    pub(crate) status: Endpoint,
}

impl Function {
    pub(crate) fn kind(&self) -> Option<Kind> {
        match self {
            Self::Hub(hub) => Some(Kind::Hub { ports: hub.ports }),
            Self::Input { kind, .. } => Some(*kind),
            Self::None => None,
        }
    }
}

/// Gives the device its address, learns what it is and makes it ready. It has just been reset.
pub(crate) async fn bring_up(link: &mut Link<'_>) -> Result<Ready, Fault> {
    link.memory.sleep(RESET_RECOVERY_US).await;
    let device = address(link).await?;
    let configuration = configuration(link).await?;
    let [maker, name] = names(link, &device).await;
    let class = if device.class == 0 { configuration.class } else { device.class };
    let Device { vendor, product, .. } = device;
    let identity = Identity { vendor, product, class, speed: link.route.speed, maker, name };
    let is_hub = device.class == CLASS_HUB && link.route.speed != Speed::Low;
    let hub_status = configuration.hub.filter(|_| is_hub);
    if hub_status.is_none() && configuration.hid.is_empty() {
        return Ok(Ready { identity, function: Function::None });
    }
    link.write(Step::Configuration, Setup::configuration(configuration.value), &[]).await?;
    let function = match hub_status {
        Some(status) => Function::Hub(hub(link, status).await?),
        None => input(link, &identity, &configuration.hid).await?,
    };
    Ok(Ready { identity, function })
}

/// Gives the device its address and reads its descriptor.
async fn address(link: &mut Link<'_>) -> Result<Device, Fault> {
    let doing = Step::DeviceDescriptor;
    let setup = Setup::descriptor(kind::DEVICE, 0, 0);
    let count = link.read(doing, setup, Device::FIRST_BYTES).await?;
    let packet = Device::packet(&link.data(count), link.route.speed);
    link.packet = packet.ok_or(Fault::Descriptor { doing })?;
    let address = link.slot.address();
    link.write(Step::Address, Setup::address(address), &[]).await?;
    link.address = address;
    link.memory.sleep(ADDRESS_RECOVERY_US).await;
    let count = link.read(doing, setup, Device::LENGTH).await?;
    Device::parse(&link.data(count)).ok_or(Fault::Descriptor { doing })
}

async fn configuration(link: &Link<'_>) -> Result<Configuration, Fault> {
    let doing = Step::ConfigurationDescriptor;
    let setup = Setup::descriptor(kind::CONFIGURATION, 0, 0);
    let count = link.read(doing, setup, Configuration::HEADER_LENGTH).await?;
    let total = Configuration::total_length(&link.data(count)).ok_or(Fault::Descriptor { doing })?;
    let count = link.read(doing, setup, total.min(DATA_BYTES)).await?;
    Configuration::parse(&link.data(count)).ok_or(Fault::Descriptor { doing })
}

/// Reads the device's maker and name; a device that will not tell has none.
async fn names(link: &Link<'_>, device: &Device) -> [String<TEXT_BYTES>; 2] {
    let mut names = [String::new(), String::new()];
    let mut language = 0;
    // String 0 tells the languages.
    for (turn, index) in [0, device.maker, device.name].into_iter().enumerate() {
        if turn > 0 && (index == 0 || language == 0) {
            continue;
        }
        let setup = Setup::descriptor(kind::STRING, index, language);
        let Ok(count) = link.read(Step::DeviceDescriptor, setup, STRING_BYTES).await else { continue };
        let data = link.data(count);
        match turn.checked_sub(1) {
            None => language = descriptor::language(&data).unwrap_or(0),
            Some(which) => names[which] = descriptor::text(&data),
        }
    }
    names
}

/// Reads the hub descriptor (USB 2.0 §11.23.2.1).
async fn hub(link: &Link<'_>, status: Endpoint) -> Result<Hub, Fault> {
    const LENGTH: usize = 9;
    let doing = Step::HubDescriptor;
    let count = link.read(doing, Setup::hub_descriptor(), LENGTH).await?;
    match *link.data(count) {
        [7..=255, kind::HUB, ports @ 1..=255, _, _, power_good, _, ..] => {
            Ok(Hub { ports, power_good_us: u64::from(power_good) * POWER_GOOD_UNIT_US, status })
        }
        _ => Err(Fault::Descriptor { doing }),
    }
}

/// Finds what a HID device is good for, and makes it ready.
async fn input(link: &Link<'_>, identity: &Identity, interfaces: &[HidInterface]) -> Result<Function, Fault> {
    let product = (identity.vendor, identity.product);
    if let (dualshock3::PRODUCT, [hid, ..]) = (product, interfaces) {
        dualshock3::wake(link, hid, identity).await?;
        return Ok(Function::Input { kind: Kind::DualShock3, hid: *hid, reader: Reader::DualShock3 });
    }
    for &hid in interfaces.iter().filter(|hid| hid.boot_keyboard) {
        if unless_refused(link.write(Step::Protocol, Setup::boot_protocol(hid.number), &[]).await)?.is_some() {
            report_changes_only(link, &hid).await?;
            return Ok(Function::Input { kind: Kind::BootKeyboard, hid, reader: Reader::BootKeyboard });
        }
    }
    for &hid in interfaces {
        let setup = Setup::report_descriptor(hid.number);
        let read = link.read(Step::ReportDescriptor, setup, hid.report_descriptor.into()).await;
        let Some(count) = unless_refused(read)? else { continue };
        let Some(layout) = Layout::parse(&link.data(count)) else { continue };
        let (kind, reader) = match layout.form {
            Form::Keyboard(_) => (Kind::ReportKeyboard, Reader::Layout(layout)),
            Form::Pad(_) if dualshock4::PRODUCTS.contains(&product) => (Kind::DualShock4, Reader::DualShock4(layout)),
            Form::Pad(_) => (Kind::Gamepad, Reader::Layout(layout)),
        };
        if kind == Kind::ReportKeyboard {
            report_changes_only(link, &hid).await?;
        }
        return Ok(Function::Input { kind, hid, reader });
    }
    Ok(Function::None)
}

/// Asks a keyboard not to repeat itself; it may refuse.
async fn report_changes_only(link: &Link<'_>, hid: &HidInterface) -> Result<(), Fault> {
    unless_refused(link.write(Step::Protocol, Setup::report_changes_only(hid.number), &[]).await).map(drop)
}

/// Takes a refusal for an answer: `None`.
pub(crate) fn unless_refused(result: Result<usize, Fault>) -> Result<Option<usize>, Fault> {
    match result {
        Ok(count) => Ok(Some(count)),
        Err(Fault::Transfer { error: PipeError::Stall, .. }) => Ok(None),
        Err(fault) => Err(fault),
    }
}
