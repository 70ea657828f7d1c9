//! What a report descriptor says about reports (HID 1.11 §6.2.2), as far as keyboards and pads need it.
//!
//! | module | holds |
//! | --- | --- |
//! | `item` | the items that a descriptor is made of |
//! | `field` | numbers in a report |
//! | `inputs` | which usage is where in which report |
//! | `layout` | a keyboard or a pad, made of these |
//! | `keyboard` | a keyboard's report to a boot keyboard's |
//! | `pad` | a pad's report to a DualShock 3's |

mod field;
mod inputs;
mod item;
mod keyboard;
mod layout;
mod pad;

pub(crate) use layout::{Form, Layout};
