//! How scenes are drawn.

use fpga_regs::packet::PixelMode;
use fpga_regs::screen::Rgb332;
use geometry::LineStyle;

/// A way to draw meshes.
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

/// How space becomes flat.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Projection {
    /// The farther, the smaller.
    #[default]
    Perspective,
    /// Parallel.
    Orthographic,
}

impl Projection {
    /// Returns the projection's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Perspective => "perspective",
            Self::Orthographic => "orthographic",
        }
    }

    /// Returns the other projection.
    #[must_use]
    pub fn other(self) -> Self {
        match self {
            Self::Perspective => Self::Orthographic,
            Self::Orthographic => Self::Perspective,
        }
    }
}

/// How a scene is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Manner {
    /// Faces or lines, and in which colours.
    pub style: Style,
    /// How space becomes flat.
    pub projection: Projection,
}

/// A step of drawing a frame: every object goes through it before the next one begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pass {
    /// Faces, a colour each.
    Flat,
    /// Faces, a colour a corner.
    Smooth,
    /// Faces' depth alone, to hide lines.
    Hiding,
    /// Faces, depth as grey.
    DepthGrey,
    /// Edges.
    Lines,
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

    /// Returns the style of a number, if there is one.
    pub fn from_index(index: usize) -> Option<Self> {
        Self::ALL.get(index).copied()
    }

    /// Returns the style's number.
    pub fn index(self) -> usize {
        self as usize
    }

    /// Returns the steps that it takes.
    pub fn passes(self) -> &'static [Pass] {
        match self {
            Style::Flat => &[Pass::Flat],
            Style::Smooth => &[Pass::Smooth],
            Style::Wire => &[Pass::Lines],
            Style::HiddenLines => &[Pass::Hiding, Pass::Lines],
            Style::DepthGrey => &[Pass::DepthGrey],
        }
    }

    /// Returns the next style, the first after the last.
    pub fn next(self) -> Self {
        Self::from_index(self.index() + 1).unwrap_or_default()
    }
}
