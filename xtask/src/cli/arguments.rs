//! The flags of each command.

use std::path::PathBuf;

use clap::Args;
use firmware::scene::Scene;
use firmware::style::Style;

use super::board::Board;
use super::values::{Rotation, parse_rotation, parse_scene, parse_style, parse_units, parse_usb_ids};
use crate::card::parse_options;
use crate::qemu::UsbIds;

/// Flags of `demo`.
#[derive(Debug, Args)]
pub struct DemoArguments {
    /// Board to run on
    #[arg(long, value_enum, default_value_t = Board::VexpressA9)]
    pub board: Board,
    /// Plays the pictures of the five systems that the project grows out of instead
    #[arg(long)]
    pub seeds: bool,
    /// Plays this scene's parts of both sessions alone
    #[arg(long, value_name = "NAME", conflicts_with = "seeds", value_parser = parse_scene)]
    pub scene: Option<Scene>,
    /// Writes the packet words of all frames as well, for replay and decode
    #[arg(long, value_name = "FILE")]
    pub dump: Option<PathBuf>,
}

/// Flags of `test`.
#[derive(Debug, Args)]
pub struct TestArguments {
    /// Runs only the steps with TEXT in their name (`usb`, say)
    #[arg(long, value_name = "TEXT")]
    pub only: Option<String>,
    /// Runs just the step of this name; so the command itself runs steps beside each other
    #[arg(long, value_name = "NAME", hide = true, conflicts_with = "only")]
    pub step: Option<String>,
}

/// Flags of `run`.
#[derive(Debug, Args)]
pub struct RunArguments {
    /// Board to run on
    #[arg(long, value_enum, default_value_t = Board::VexpressA9)]
    pub board: Board,
    /// Scene to begin with: plate, torus, tunnel, solids, wireframe, polygons, model or game
    #[arg(long, value_name = "NAME", value_parser = parse_scene)]
    pub scene: Option<Scene>,
    /// Style to begin with: flat, smooth, wireframe, hidden-lines or depth-as-grey
    #[arg(long, value_name = "STYLE", value_parser = parse_style)]
    pub style: Option<Style>,
    /// Has the FPGA's design in Verilator draw, clock by clock, its picture from the VGA pins (de1-soc)
    #[arg(long)]
    pub rtl: bool,
    /// Opens no window; stops after --frames and leaves them in --output
    #[arg(long, requires = "frames", requires = "output")]
    pub headless: bool,
    /// Number of frames to draw (with --headless)
    #[arg(long, value_name = "N", requires = "headless", value_parser = clap::value_parser!(u32).range(1..))]
    pub frames: Option<u32>,
    /// Shows a model: one of those that render reads, put into the board's memory as a .mesh file
    #[arg(long, value_name = "MODEL")]
    pub model: Option<PathBuf>,
    /// Plugs in what a usbredir server at this Unix socket has: `cargo xtask pad SOCKET`, say
    #[arg(long, value_name = "SOCKET", conflicts_with = "headless")]
    pub pad: Option<PathBuf>,
    /// Hands a USB device of this computer to the board, by its ids as lsusb shows them; see the
    /// README on permissions
    #[arg(long, value_name = "VENDOR:PRODUCT", conflicts_with = "headless", value_parser = parse_usb_ids)]
    pub usb_host: Option<UsbIds>,
    /// Folder for the frames (with --headless)
    #[arg(long, value_name = "DIR", requires = "headless")]
    pub output: Option<PathBuf>,
}

/// Flags of `pad`.
#[derive(Debug, Args)]
pub struct PadArguments {
    /// Unix socket to listen at; it is made
    #[arg(value_name = "SOCKET")]
    pub socket: PathBuf,
    /// Session to play instead of the demo's
    #[arg(long, value_name = "FILE")]
    pub session: Option<PathBuf>,
}

/// Flags of `image`.
#[derive(Debug, Args)]
pub struct ImageArguments {
    /// FPGA image for the card: fpga/build/halfspace.rbf
    #[arg(long, value_name = "FILE")]
    pub rbf: Option<PathBuf>,
    /// Model that is shown from the card: one of those that render reads, put on it as a .mesh file
    #[arg(long, value_name = "MODEL")]
    pub mesh: Option<PathBuf>,
    /// What the program is told at its start, in docs/flash.md's words: "usb full", "usb pulse" or both
    #[arg(long, value_name = "WORDS", value_parser = parse_options)]
    pub options: Option<String>,
    /// U-Boot with its preloader (u-boot-with-spl.sfp) instead of one that is built here
    #[arg(long, value_name = "FILE")]
    pub uboot: Option<PathBuf>,
    /// Folder for the results
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
}

/// Flags of `render`.
#[derive(Debug, Args)]
pub struct RenderArguments {
    /// The model: .obj, .stl, .babylon, .glb, .rom or .mesh
    #[arg(value_name = "MODEL")]
    pub model: PathBuf,
    /// PNG file to write
    #[arg(short, long, value_name = "OUT.png")]
    pub output: PathBuf,
    /// Turns the model: degrees about the x axis, then y, then z; the axes stay in place
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = parse_rotation)]
    pub rotate: Option<Rotation>,
    /// Model-view-projection matrix instead of the fitted view: a file of 16 numbers, row by row
    #[arg(long, value_name = "FILE", conflicts_with = "rotate")]
    pub mvp: Option<PathBuf>,
    /// How it is drawn: flat, smooth, wireframe, hidden-lines or depth-as-grey; a model of lines is always
    /// drawn as lines
    #[arg(long, value_name = "STYLE", value_parser = parse_style, default_value = "flat")]
    pub style: Style,
    /// Draws triangles that face away as well
    #[arg(long)]
    pub two_sided: bool,
    /// Writes the packet words as well, for replay and decode: 32 bits each, little-endian
    #[arg(long, value_name = "FILE")]
    pub dump: Option<PathBuf>,
    /// Writes the drawn triangles as text, each a line: x y depth of three corners (sixteenths of
    /// a pixel), then red green blue
    #[arg(long, value_name = "FILE")]
    pub triangles: Option<PathBuf>,
    /// Writes the depth buffer as a 16-bit PGM file
    #[arg(long, value_name = "FILE")]
    pub depth: Option<PathBuf>,
}

/// Flags of `mesh`.
#[derive(Debug, Args)]
pub struct MeshArguments {
    /// The model: .obj, .stl, .babylon, .glb, .rom or .mesh
    #[arg(value_name = "MODEL")]
    pub model: PathBuf,
    /// File to write
    #[arg(short, long, value_name = "FILE.mesh")]
    pub output: PathBuf,
    /// Keeps no more than flat drawing wants
    #[arg(long, conflicts_with = "smooth")]
    pub flat: bool,
    /// Keeps no more than smooth drawing wants
    #[arg(long)]
    pub smooth: bool,
    /// Moves the model's middle to the origin and scales it to a radius of 1
    #[arg(long)]
    pub scale_to_fit: bool,
    /// Has faces seen from both sides
    #[arg(long)]
    pub two_sided: bool,
    /// Takes the model's faces as going clockwise, seen from outside
    #[arg(long)]
    pub clockwise: bool,
}

/// Flags of `replay`.
#[derive(Debug, Args)]
pub struct ReplayArguments {
    /// Packet words, as render --dump writes them
    #[arg(value_name = "WORDS")]
    pub words: PathBuf,
    /// PNG file to write
    #[arg(short, long, value_name = "OUT.png")]
    pub output: PathBuf,
    /// Writes the depth buffer as a 16-bit PGM file
    #[arg(long, value_name = "FILE")]
    pub depth: Option<PathBuf>,
    /// Draws with the FPGA's design in Verilator instead of the software model
    #[arg(long)]
    pub rtl: bool,
    /// Pixel units that the design is built with
    #[arg(long, value_name = "N", requires = "rtl", default_value_t = 8, value_parser = parse_units)]
    pub units: u32,
    /// Takes the picture, 640×480, from the VGA pins
    #[arg(long, requires = "rtl")]
    pub pins: bool,
    /// Records every signal of a few clocks in an FST file, for GTKWave or Surfer
    #[arg(long, value_name = "FILE", requires = "rtl")]
    pub wave: Option<PathBuf>,
    /// First clock of --wave: 20 ns each, counted as in the table
    #[arg(long, value_name = "CLOCK", requires = "wave", default_value_t = 0)]
    pub from: u64,
    /// Number of clocks of --wave, each about 300 bytes in the file
    #[arg(long, value_name = "N", requires = "wave", default_value_t = 20_000, value_parser = clap::value_parser!(u64).range(1..))]
    pub clocks: u64,
}

/// Flags of `decode`.
#[derive(Debug, Args)]
pub struct DecodeArguments {
    /// Packet words, as render --dump writes them
    #[arg(value_name = "WORDS")]
    pub words: PathBuf,
}

/// Flags of `area`.
#[derive(Debug, Args)]
pub struct AreaArguments {
    /// Writes nothing and fails when the table is stale
    #[arg(long)]
    pub check: bool,
    /// Synthesizes only this number of pixel units, and writes nothing
    #[arg(long, value_name = "1|2|4|8", value_parser = parse_units)]
    pub units: Option<u32>,
}

/// Flags of `prove`.
#[derive(Debug, Args)]
pub struct ProveArguments {
    /// Proves what depends on the number of pixel units for this number only
    #[arg(long, value_name = "1|2|4|8", value_parser = parse_units)]
    pub units: Option<u32>,
}

/// Flags of `bench`.
#[derive(Debug, Args)]
pub struct BenchArguments {
    /// Prints JSON instead of a table
    #[arg(long)]
    pub json: bool,
    /// Draws what 1, 2, 4 and 8 pixel units bring on real scenes, as SVG
    #[arg(long, value_name = "OUT.svg")]
    pub plot: Option<PathBuf>,
}

/// Flags of `generate`.
#[derive(Debug, Args)]
pub struct GenerateArguments {
    /// Writes nothing; fails when a file is stale
    #[arg(long)]
    pub check: bool,
    /// Writes the demo's golden checksums as well, from a run on this computer: look at its
    /// pictures first
    #[arg(long, conflicts_with = "check")]
    pub golden: bool,
}
