//! The USB host driver against the strict model of its core.

mod cores;
mod devices;
mod gadget;
mod plugging;
mod rig;
mod stack;
mod times;

mod hubs;
mod root;
mod rules;
mod whole;
