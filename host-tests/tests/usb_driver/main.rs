//! The USB host driver against the strict model of its core.

mod gadget;
mod rig;
mod stack;

mod root;
