//! Keyboards and pads through `usb-input`, from the wire to the [`ControllerState`](controls::ControllerState).
//!
//! | module | shows |
//! | --- | --- |
//! | `devices` | each kind of device, what it is told and what comes of its reports |
//! | `hubs` | hubs, hubs behind hubs, splits, limits |
//! | `plugging` | plugging in, pulling out in every stage, swapping, faults and what follows them |
//! | `timing` | the waits, the time to the first report and from a report to the state |
//! | `rogues` | devices that are wrong, 10,000 of them |

mod bench;
mod devices;
mod hubs;
mod plugging;
mod rogues;
mod timing;
