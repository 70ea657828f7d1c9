//! From a device's reset to the moment when it can be read.

use embassy_usb_driver::Speed;
use embassy_usb_driver::host::{PipeError, UsbHostAllocator};
use heapless::String;

use crate::descriptor::{self, Configuration, Device, Endpoint, HidInterface, STRING_BYTES};
use crate::hid::{Form, Layout};
use crate::link::Link;
use crate::reader::Reader;
use crate::setup::{Setup, descriptor as kind};
use crate::timing::{ADDRESS_RECOVERY_US, POWER_GOOD_UNIT_US, RESET_RECOVERY_US};
use crate::{Clock, Fault, Identity, Kind, Step, TEXT_BYTES, dualshock3, dualshock4};

/// Bytes of a configuration or report descriptor that are read; what is beyond is not seen.
const DESCRIPTOR_BYTES: usize = 512;
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
pub(crate) async fn bring_up<'d, A: UsbHostAllocator<'d>, K: Clock>(link: &mut Link<'_, A, K>) -> Result<Ready, Fault> {
    link.bus.sleep(RESET_RECOVERY_US).await;
    let device = address(link).await?;
    let mut buffer = [0; DESCRIPTOR_BYTES];
    let configuration = configuration(link, &mut buffer).await?;
    let (maker, name) = names(link, &device).await;
    let class = if device.class == 0 { configuration.class } else { device.class };
    let Device { vendor, product, .. } = device;
    let identity = Identity { vendor, product, class, speed: link.route.speed, maker, name };
    let is_hub = device.class == CLASS_HUB && link.route.speed != Speed::Low;
    let function = match configuration.hub {
        Some(status) if is_hub => {
            link.write(Step::Configuration, Setup::configuration(configuration.value), &[]).await?;
            Function::Hub(hub(link, status).await?)
        }
        _ if configuration.hid.is_empty() => Function::None,
        _ => {
            link.write(Step::Configuration, Setup::configuration(configuration.value), &[]).await?;
            input(link, &identity, &configuration.hid, &mut buffer).await?
        }
    };
    Ok(Ready { identity, function })
}

/// Gives the device its address and reads its descriptor.
async fn address<'d, A: UsbHostAllocator<'d>, K: Clock>(link: &mut Link<'_, A, K>) -> Result<Device, Fault> {
    let doing = Step::DeviceDescriptor;
    let setup = Setup::descriptor(kind::DEVICE, 0, 0);
    let mut bytes = [0; Device::LENGTH];
    let count = link.read(doing, setup, &mut bytes[..Device::FIRST_BYTES]).await?;
    link.packet = Device::packet(&bytes[..count], link.route.speed).ok_or(Fault::Descriptor { doing })?;
    let address = link.slot.address();
    link.write(Step::Address, Setup::address(address), &[]).await?;
    link.address = address;
    link.bus.sleep(ADDRESS_RECOVERY_US).await;
    let count = link.read(doing, setup, &mut bytes).await?;
    Device::parse(&bytes[..count]).ok_or(Fault::Descriptor { doing })
}

async fn configuration<'d, A: UsbHostAllocator<'d>, K: Clock>(
    link: &Link<'_, A, K>,
    buffer: &mut [u8],
) -> Result<Configuration, Fault> {
    let doing = Step::ConfigurationDescriptor;
    let setup = Setup::descriptor(kind::CONFIGURATION, 0, 0);
    let count = link.read(doing, setup, &mut buffer[..Configuration::HEADER_LENGTH]).await?;
    let total = Configuration::total_length(&buffer[..count]).ok_or(Fault::Descriptor { doing })?;
    let wanted = total.min(buffer.len());
    let count = link.read(doing, setup, &mut buffer[..wanted]).await?;
    Configuration::parse(&buffer[..count]).ok_or(Fault::Descriptor { doing })
}

/// Reads the device's maker and name; a device that will not tell has none.
async fn names<'d, A: UsbHostAllocator<'d>, K: Clock>(
    link: &Link<'_, A, K>,
    device: &Device,
) -> (String<TEXT_BYTES>, String<TEXT_BYTES>) {
    let mut names = [String::new(), String::new()];
    if (device.maker, device.name) != (0, 0)
        && let Some(language) =
            string(link, 0, 0).await.and_then(|(bytes, count)| descriptor::language(&bytes[..count]))
    {
        for (name, index) in names.iter_mut().zip([device.maker, device.name]) {
            if index != 0
                && let Some((bytes, count)) = string(link, index, language).await
            {
                *name = descriptor::text(&bytes[..count]);
            }
        }
    }
    names.into()
}

async fn string<'d, A: UsbHostAllocator<'d>, K: Clock>(
    link: &Link<'_, A, K>,
    index: u8,
    language: u16,
) -> Option<([u8; STRING_BYTES], usize)> {
    let mut bytes = [0; STRING_BYTES];
    let setup = Setup::descriptor(kind::STRING, index, language);
    let count = link.read(Step::DeviceDescriptor, setup, &mut bytes).await.ok()?;
    Some((bytes, count))
}

/// Reads the hub descriptor (USB 2.0 §11.23.2.1).
async fn hub<'d, A: UsbHostAllocator<'d>, K: Clock>(link: &Link<'_, A, K>, status: Endpoint) -> Result<Hub, Fault> {
    let doing = Step::HubDescriptor;
    let mut bytes = [0; 9];
    let count = link.read(doing, Setup::hub_descriptor(), &mut bytes).await?;
    match bytes[..count] {
        [7..=255, kind::HUB, ports @ 1..=255, _, _, power_good, _, ..] => {
            Ok(Hub { ports, power_good_us: u64::from(power_good) * POWER_GOOD_UNIT_US, status })
        }
        _ => Err(Fault::Descriptor { doing }),
    }
}

/// Finds what a HID device is good for, and makes it ready.
async fn input<'d, A: UsbHostAllocator<'d>, K: Clock>(
    link: &Link<'_, A, K>,
    identity: &Identity,
    interfaces: &[HidInterface],
    buffer: &mut [u8],
) -> Result<Function, Fault> {
    let product = (identity.vendor, identity.product);
    if let (dualshock3::PRODUCT, [hid, ..]) = (product, interfaces) {
        dualshock3::wake(link, hid, identity).await?;
        return Ok(Function::Input { kind: Kind::DualShock3, hid: *hid, reader: Reader::DualShock3 });
    }
    for &hid in interfaces.iter().filter(|hid| hid.boot_keyboard) {
        if accepts(link.write(Step::Protocol, Setup::boot_protocol(hid.number), &[]).await)? {
            accepts(link.write(Step::Protocol, Setup::report_changes_only(hid.number), &[]).await)?;
            return Ok(Function::Input { kind: Kind::BootKeyboard, hid, reader: Reader::BootKeyboard });
        }
    }
    for &hid in interfaces {
        let wanted = usize::from(hid.report_descriptor).min(buffer.len());
        let count = match link
            .read(Step::ReportDescriptor, Setup::report_descriptor(hid.number), &mut buffer[..wanted])
            .await
        {
            Err(Fault::Transfer { error: PipeError::Stall, .. }) => continue,
            other => other?,
        };
        let Some(layout) = Layout::parse(&buffer[..count]) else { continue };
        let (kind, reader) = match layout.form {
            Form::Keyboard(_) => {
                accepts(link.write(Step::Protocol, Setup::report_changes_only(hid.number), &[]).await)?;
                (Kind::ReportKeyboard, Reader::Layout(layout))
            }
            Form::Pad(_) if dualshock4::PRODUCTS.contains(&product) => (Kind::DualShock4, Reader::DualShock4(layout)),
            Form::Pad(_) => (Kind::Gamepad, Reader::Layout(layout)),
        };
        return Ok(Function::Input { kind, hid, reader });
    }
    Ok(Function::None)
}

/// Tells whether the device did what it was asked to; a refusal is no fault.
fn accepts(result: Result<(), Fault>) -> Result<bool, Fault> {
    match result {
        Ok(()) => Ok(true),
        Err(Fault::Transfer { error: PipeError::Stall, .. }) => Ok(false),
        Err(fault) => Err(fault),
    }
}
