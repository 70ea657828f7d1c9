//! A hub: its ports, and what is plugged into them.

mod port;

use core::convert::Infallible;
use core::future::poll_fn;
use core::task::Poll;

use embassy_futures::select::{Either, select};

use crate::bring_up::Hub;
use crate::link::Link;
use crate::listen::Patience;
use crate::setup::Setup;
use crate::{Fault, Step};
use port::{Port, feature};

/// Ports of a hub that are served, from port 1 on.
pub const HUB_PORTS_MAXIMUM: u8 = 8;

/// Bit `n` for port `n`, bit 0 for the hub itself (USB 2.0 §11.12.4).
type Changes = u32;

/// Serves a hub's ports until the hub fails.
pub(crate) async fn serve(link: Link<'_>, hub: Hub) -> Result<Infallible, Fault> {
    if hub.ports > HUB_PORTS_MAXIMUM {
        link.memory.tell_fault(link.route.place, Fault::TooManyPorts { ports: hub.ports }).await;
    }
    let count = hub.ports.min(HUB_PORTS_MAXIMUM);
    for port in 1..=count {
        link.write(Step::Port, Setup::set_port_feature(feature::POWER, port), &[]).await?;
    }
    link.memory.sleep(hub.power_good_us).await;
    let mut ports: [Port; HUB_PORTS_MAXIMUM as usize] = core::array::from_fn(|index| Port::new(index as u8 + 1));
    let ports = &mut ports[..usize::from(count)];
    let mut patience = Patience::default();
    link.listen(hub.status);
    // What was plugged in before power came need not be told of as a change.
    let mut changes = Changes::MAX;
    loop {
        if changes & 1 != 0 {
            port::look_at_hub(&link).await?;
        }
        for port in ports.iter_mut().filter(|port| changes >> port.number() & 1 != 0) {
            port.look(&link).await?;
        }
        changes = match select(link.mailbox().packet(changes_of), attention(&link, ports)).await {
            Either::First(Ok(changes)) => {
                patience = Patience::default();
                changes
            }
            Either::First(Err(error)) => {
                patience.recover(&link, Step::Port, hub.status, error).await?;
                0
            }
            Either::Second(index) => {
                ports[index].attend(&link).await?;
                0
            }
        };
    }
}

fn changes_of(packet: &[u8]) -> Changes {
    packet.iter().take(size_of::<Changes>()).rev().fold(0, |changes, &byte| changes << 8 | Changes::from(byte))
}

/// Waits until a port wants something done; returns its index.
async fn attention(link: &Link<'_>, ports: &[Port]) -> usize {
    poll_fn(|_| {
        let wanting = ports.iter().position(|port| port.wants_attention(link));
        wanting.map_or(Poll::Pending, Poll::Ready)
    })
    .await
}
