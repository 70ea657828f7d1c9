//! What there is to look at, and what a controller does to it; nothing of boards.
//!
//! | module | what it holds |
//! | --- | --- |
//! | [`viewer`] | which scene is shown, and how |
//! | [`act`] | what each scene does: from what the controllers say to a stage |
//! | [`scene`] | meshes, and a stage of them with camera and light |
//! | [`style`] | how scenes are drawn |
//! | [`legend`] | what each key does, as the console tells it |

#![no_std]
#![forbid(unsafe_code)]

pub mod act;
pub mod legend;
pub mod scene;
pub mod style;
pub mod viewer;
