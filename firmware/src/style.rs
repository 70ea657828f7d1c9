//! How a mesh is drawn, whatever the scene.

use fpga_regs::packet::PixelMode;
use fpga_regs::screen::Rgb332;
use geometry::LineStyle;

/// A way to draw a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Style {
    /// A colour a face, lit by its normal.
    #[default]
    Flat,
    /// Lit at every vertex, the colour changing over the face.
    Smooth,
    /// All edges.
    Wire,
    /// The edges that no face hides.
    HiddenLines,
    /// Depth as grey, the farther the darker.
    DepthGrey,
}

impl Style {
    /// All styles, in the order in which Triangle goes through them.
    pub const ALL: &'static [Style] = &[Style::Flat, Style::Smooth, Style::Wire, Style::HiddenLines, Style::DepthGrey];

    /// Green, as on the displays that had nothing but lines; drawn by depth, so that they can hide.
    pub const LINES: LineStyle = LineStyle { colour: Rgb332(0x1c), mode: PixelMode::USUAL };

    /// Returns the style's name.
    pub fn name(self) -> &'static str {
        match self {
            Style::Flat => "flat",
            Style::Smooth => "smooth",
            Style::Wire => "wireframe",
            Style::HiddenLines => "hidden lines",
            Style::DepthGrey => "depth as grey",
        }
    }

    /// Returns the next style, the first after the last.
    pub fn next(self) -> Self {
        let index = Self::ALL.iter().position(|style| *style == self).unwrap_or(0);
        Self::ALL[(index + 1) % Self::ALL.len()]
    }
}
