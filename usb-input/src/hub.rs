//! A hub: its ports, and what is plugged into them.

mod port;

use core::convert::Infallible;
use core::future::poll_fn;
use core::pin::pin;
use core::task::Poll;

use embassy_futures::select::{Either, select};
use embassy_usb_driver::host::{PipeError, UsbHostAllocator, UsbPipe, pipe};

use crate::bring_up::Hub;
use crate::descriptor::PACKET_MAXIMUM;
use crate::link::Link;
use crate::setup::Setup;
use crate::timing::{READ_ERRORS_MAXIMUM, READ_PAUSE_US};
use crate::{Clock, Fault, Place, Step};
use port::{Port, feature};

/// Ports of a hub that are served, from port 1 on.
pub const HUB_PORTS_MAXIMUM: u8 = 8;

/// Bit `n` for port `n`, bit 0 for the hub itself (USB 2.0 §11.12.4).
type Changes = u32;

/// Serves a hub's ports until the hub fails.
pub(crate) async fn serve<'d, A: UsbHostAllocator<'d>, K: Clock>(
    link: Link<'_, A, K>,
    hub: Hub,
) -> Result<Infallible, Fault> {
    if hub.ports > HUB_PORTS_MAXIMUM {
        link.bus.tell_fault(link.route.place, Fault::TooManyPorts { ports: hub.ports }).await;
    }
    let count = hub.ports.min(HUB_PORTS_MAXIMUM);
    for port in 1..=count {
        link.write(Step::Port, Setup::set_port_feature(feature::POWER, port), &[]).await?;
    }
    link.bus.sleep(hub.power_good_us).await;
    let mut ports: [Port; HUB_PORTS_MAXIMUM as usize] = core::array::from_fn(|index| Port::new(index as u8 + 1));
    let ports = &mut ports[..usize::from(count)];
    let mut pipe = link.interrupt_pipe::<pipe::In>(Step::Port, hub.status).await?;
    let mut buffer = [0; PACKET_MAXIMUM as usize];
    let mut errors = 0;
    // What was plugged in before power came need not be told of as a change.
    let mut changes = Changes::MAX;
    loop {
        look(&link, ports, changes).await?;
        let asked = {
            let mut asked = pin!(pipe.request_in(&mut buffer[..usize::from(hub.status.packet)]));
            loop {
                match select(asked.as_mut(), attention(&link, ports)).await {
                    Either::First(asked) => break asked,
                    Either::Second(index) => ports[index].attend(&link).await?,
                }
            }
        };
        changes = match asked {
            Ok(count) => {
                errors = 0;
                let bytes = buffer.iter().take(count.min(size_of::<Changes>())).rev();
                bytes.fold(0, |changes, &byte| changes << 8 | Changes::from(byte))
            }
            Err(error) => {
                if errors >= READ_ERRORS_MAXIMUM {
                    return Err(Fault::Transfer { doing: Step::Port, error });
                }
                link.bus.sleep(READ_PAUSE_US << errors).await;
                errors += 1;
                if error == PipeError::Stall {
                    let endpoint = 0x80 | hub.status.number;
                    link.write(Step::Port, Setup::clear_halt(endpoint), &[]).await?;
                    pipe.reset_data_toggle();
                }
                0
            }
        };
    }
}

/// Looks at everything that has changed.
async fn look<'d, A: UsbHostAllocator<'d>, K: Clock>(
    link: &Link<'_, A, K>,
    ports: &mut [Port],
    changes: Changes,
) -> Result<(), Fault> {
    if changes & 1 != 0 {
        port::look_at_hub(link).await?;
    }
    for port in ports.iter_mut().filter(|port| changes >> port.number() & 1 != 0) {
        port.look(link).await?;
    }
    Ok(())
}

/// Waits until a port wants something done; returns its index.
async fn attention<'d, A: UsbHostAllocator<'d>, K: Clock>(link: &Link<'_, A, K>, ports: &[Port]) -> usize {
    poll_fn(|_| {
        let wanting = ports.iter().position(|port| port.wants_attention(link));
        wanting.map_or(Poll::Pending, Poll::Ready)
    })
    .await
}

/// Returns where a device at a port of this hub is.
fn place_below(hub: Place, port: u8) -> Option<Place> {
    hub.below(port)
}
