//! One file per command; each has a `run` that takes the command's flags.

pub mod area;
pub mod bench;
pub mod decode;
pub mod demo;
pub mod generate;
pub mod image;
pub mod mesh;
pub mod pad;
pub mod prove;
pub mod render;
pub mod replay;
pub mod run;
pub mod test;
