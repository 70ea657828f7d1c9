//! What the application asks of a board.

use core::fmt::Write;

use fpga_regs::Port;

use crate::intake::Intake;

/// A board, beside its renderer's port: a clock, a console, controllers, a line to a PC.
pub trait Board {
    /// The board's name, as in `--board`.
    const NAME: &'static str;
    /// What the board lacks of the product, for the banner.
    const LACKS: &'static str;
    /// Ticks of [`ticks`](Board::ticks) in a second.
    const TICKS_PER_SECOND: u32;
    /// Text for a person.
    type Console: Write;
    /// The FPGA.
    type Port: Port;

    /// Returns the time since start, in ticks.
    fn ticks(&self) -> u64;

    /// Returns the console.
    fn console(&mut self) -> &mut Self::Console;

    /// Hands the board's own controllers' new reports to `intake`: a keyboard on PS/2 or USB,
    /// a pad. Returns how many could not be read.
    fn poll_controllers(&mut self, intake: &mut Intake) -> u32;

    /// Reads bytes that a PC sent into `buffer` and returns how many; 0 when there are none.
    fn read_link(&mut self, buffer: &mut [u8]) -> usize;

    /// Sends bytes to the PC, as many as go in a bounded time.
    fn write_link(&mut self, bytes: &[u8]);

    /// Returns the CRC-32 of the picture that shows, where the processor can see it.
    fn picture_checksum(&mut self, port: &mut Self::Port) -> Option<u32>;

    /// Returns memory that begins with a mesh file which somebody left there before the program started, if
    /// something is there. Asked once.
    fn mesh_file(&mut self) -> Option<&'static [u8]> {
        None
    }

    /// Waits until the next frame is due, where showing one does not wait by itself.
    fn pace(&mut self);

    /// Shows a sign of life; called once a frame.
    fn heartbeat(&mut self, frame: u32);

    /// Shows the points of the game, where the board has digits for them; `None` while no game is played. Called
    /// once a frame.
    fn show_score(&mut self, _score: Option<u32>) {}

    /// Shows that something went wrong; the console says what.
    fn show_fault(&mut self) {}

    /// Sleeps until something may have happened.
    fn sleep(&mut self);
}
