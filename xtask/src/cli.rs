//! The command line: which commands there are, their flags, and what `--help` says.

mod arguments;
mod board;
#[cfg(test)]
mod tests;
mod values;

use std::fmt::Write as _;

use clap::{Command, CommandFactory, FromArgMatches, Parser, Subcommand};

use crate::commands;

pub use arguments::{
    AreaArguments, BenchArguments, DecodeArguments, DemoArguments, GenerateArguments, ImageArguments, MeshArguments,
    PadArguments, ProveArguments, RenderArguments, ReplayArguments, RunArguments, TestArguments,
};
pub use board::Board;
pub use values::Rotation;

/// The commands as `--help` groups them, in the order a newcomer meets them.
const COMMAND_GROUPS: [(&str, &[&str]); 5] = [
    ("See it work", &["demo", "run", "pad"]),
    ("Put it on a board", &["image"]),
    ("Draw a picture on this computer", &["render", "mesh", "replay", "decode"]),
    ("Check and measure", &["test", "bench", "prove", "area"]),
    ("Keep generated files fresh", &["generate"]),
];

const EXAMPLES: &str = "\
Examples:
  cargo xtask demo                                  boot the firmware, save what it draws
  cargo xtask run                                   the same, live in a window
  cargo xtask render assets/icosphere.obj -o sphere.png --rotate 20,30,0
  cargo xtask demo --help                           all flags of one command

Results go to target/<command>/ unless -o or --output names another place.
What is missing (Rust target, QEMU, Verilator) is installed where that needs no question;
otherwise the command to type is printed.";

/// Runs every task of the Halfspace project.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask", disable_help_subcommand = true)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Task,
}

/// One task.
#[derive(Debug, Subcommand)]
pub enum Task {
    /// Boots the firmware in an emulator, plays a controller session, saves the frames
    ///
    /// Leaves in target/demo: a PNG file for each frame, demo.png (all of them as an animation,
    /// which browsers play), report.json, and what the firmware said in console.txt and log.txt.
    Demo(DemoArguments),
    /// Runs everything that CI runs
    Test(TestArguments),
    /// Runs the firmware live: a window and the keyboard, or --headless
    ///
    /// With --headless the recorded session of the demo moves the scenes, from its first frame
    /// on, and again from there when it is over; every run gives the same frames.
    Run(RunArguments),
    /// Plays a session as a DualShock 3 at a socket, for run --pad
    ///
    /// QEMU's usb-redir calls there. The session is played at 60 reports a second, and again when it
    /// is over, until Ctrl-C.
    Pad(PadArguments),
    /// Makes what goes on the DE1-SoC's SD card, and the whole card as a file
    ///
    /// Leaves in target/de1-soc: halfspace-sd.img, the card; card/, what to copy onto a card that
    /// starts already; and their parts. The same input gives the same bytes. U-Boot is built from
    /// Debian's source package, which takes a minute the first time. README §Flash goes on from there.
    Image(ImageArguments),
    /// Draws a model to a PNG file
    ///
    /// Takes OBJ, STL, Babylon JSON (.babylon), binary glTF (.glb), 99-bit lines (.rom, .mem, .coe)
    /// and .mesh; the file's name tells which. The same geometry as on the board, and the FPGA's
    /// software model: 320×240 pixels. Front
    /// faces go counter-clockwise. The view is from +z, fitted to the model, field of view 45°;
    /// the light comes from above on the left, in front. With --mvp the matrix is used as it is,
    /// and the light shines in the model's own space.
    Render(RenderArguments),
    /// Turns a model into a .mesh file, which the firmware draws
    ///
    /// Reads what render reads. The file is compact, checked whole before it is drawn, and has a model of
    /// any size in blocks. By default it has what flat and smooth drawing want.
    Mesh(MeshArguments),
    /// Draws a file of packet words to a PNG file
    ///
    /// Shows the front buffer or, if the stream has no swap, the back buffer. Bad packets are
    /// skipped with a warning. A stream that ends inside a packet is an error: nothing is written.
    /// With --rtl the FPGA's SystemVerilog draws, clock by clock, in Verilator: what comes out is
    /// compared with the software model, and what each frame cost is shown. A word goes in each
    /// clock; waiting for the vertical blank is cut short and not counted.
    Replay(ReplayArguments),
    /// Prints a file of packet words as text
    ///
    /// A line of JSON for each packet; `word` is where it starts. A bad packet has the kind `bad`
    /// and a reason. A stream that ends inside a packet is an error, after the lines before it.
    Decode(DecodeArguments),
    /// Measures the cost per vertex, triangle and pixel
    ///
    /// Counts the Cortex-A9's instructions in QEMU and the FPGA's clocks in Verilator, and times
    /// geometry and software model on this computer, as an optimised build: median of several runs.
    Bench(BenchArguments),
    /// Proves theorems about the FPGA's design
    ///
    /// That the command FIFO loses nothing and that the traversal visits every covered pixel's tile
    /// exactly once, at full size: Yosys makes the formulas, Bitwuzla decides them. Both come from PyPI
    /// into target/setup; formulas and logs stay in target/prove. rtl/formal has the theorems.
    Prove(ProveArguments),
    /// Counts what the FPGA's design takes of the device, with Yosys
    ///
    /// Writes the table into rtl/README.md; logs stay in target/area. Yosys maps to the Cyclone V's
    /// cells but places nothing: only Quartus can tell whether it fits and how fast it is.
    Area(AreaArguments),
    /// Writes the files that are generated and committed
    Generate(GenerateArguments),
}

/// Parses the command line and runs the task.
///
/// Wrong flags and `--help` print their text and end the process, as clap does.
///
/// # Errors
///
/// Whatever the task reports.
pub fn run() -> anyhow::Result<()> {
    let matches = command().get_matches();
    let cli = Cli::from_arg_matches(&matches).unwrap_or_else(|error| error.exit());
    match &cli.command {
        Task::Demo(arguments) => commands::demo::run(arguments),
        Task::Test(arguments) => commands::test::run(arguments),
        Task::Run(arguments) => commands::run::run(arguments),
        Task::Pad(arguments) => commands::pad::run(arguments),
        Task::Image(arguments) => commands::image::run(arguments),
        Task::Render(arguments) => commands::render::run(arguments),
        Task::Mesh(arguments) => commands::mesh::run(arguments),
        Task::Replay(arguments) => commands::replay::run(arguments),
        Task::Decode(arguments) => commands::decode::run(arguments),
        Task::Bench(arguments) => commands::bench::run(arguments),
        Task::Prove(arguments) => commands::prove::run(arguments),
        Task::Area(arguments) => commands::area::run(arguments),
        Task::Generate(arguments) => commands::generate::run(arguments),
    }
}

/// Returns clap's description of the command line, with the commands grouped.
fn command() -> Command {
    let command = Cli::command();
    let groups = grouped_commands(&command);
    command.help_template(format!("{{about}}\n\n{{usage-heading}} {{usage}}\n\n{groups}{EXAMPLES}\n"))
}

/// Lists the commands under their groups' headings, each with its one line.
fn grouped_commands(command: &Command) -> String {
    let mut text = String::new();
    for (heading, names) in COMMAND_GROUPS {
        let _ = writeln!(text, "{heading}:");
        for name in names {
            let about =
                command.find_subcommand(name).and_then(Command::get_about).map(ToString::to_string).unwrap_or_default();
            let _ = writeln!(text, "  {name:<10}{about}");
        }
        text.push('\n');
    }
    text
}
