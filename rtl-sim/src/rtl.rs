//! The verilated device and its clocks.

use std::ffi::{CString, c_void};
use std::fs::File;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::{error, fmt, io, ptr};

use fpga_regs::Port;
use fpga_regs::registers::{Capabilities, Register, Status};

use crate::calls::{Calls, SCRAMBLED, UNITS_1, UNITS_2, UNITS_4, UNITS_8};
use crate::memories::Memories;
use crate::vga::Frame;

/// The numbers of pixel units that there are builds for.
pub const UNITS: [u32; 4] = [1, 2, 4, 8];
/// Pixel units of [`Rtl::scrambled`].
const SCRAMBLED_UNITS: u32 = 2;

/// Why a wave cannot be written.
#[derive(Debug)]
pub enum WaveError {
    /// This build has no waves.
    NotBuiltIn,
    /// The file cannot be written.
    File {
        /// Which.
        file: PathBuf,
        /// Why.
        error: io::Error,
    },
}

impl fmt::Display for WaveError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotBuiltIn => out.write_str("this build writes no waves: build rtl-sim with --features waves"),
            Self::File { file, error } => write!(out, "cannot write {}: {error}", file.display()),
        }
    }
}

impl error::Error for WaveError {}

/// A device in simulation, just out of reset. Its memories hold anything until they are cleared.
///
/// The bus clock runs while something is done on the bus and in [`clock`](Rtl::clock);
/// VGA's clock stands still, but for [`set_vga_ratio`](Rtl::set_vga_ratio) and while a swap waits
/// with [`set_hurry`](Rtl::set_hurry).
pub struct Rtl {
    calls: &'static Calls,
    sim: *mut c_void,
    units: u32,
}

impl Rtl {
    /// Returns a device with `units` pixel units, one of [`UNITS`].
    ///
    /// # Panics
    /// For any other number.
    pub fn new(units: u32) -> Self {
        let calls = match units {
            1 => &UNITS_1,
            2 => &UNITS_2,
            4 => &UNITS_4,
            8 => &UNITS_8,
            _ => panic!("no build has {units} pixel units: there are {UNITS:?}"),
        };
        Self::of(calls, units, 0)
    }

    /// Returns a device that differs from the others in all that may differ: 2 pixel units, a FIFO of
    /// [`SCRAMBLED_FIFO_DEPTH`](Self::SCRAMBLED_FIFO_DEPTH) words, no interrupt line; and what reset does
    /// not set, flip-flops and memories, begins as `seed` says, the same with every run.
    pub fn scrambled(seed: u32) -> Self {
        Self::of(&SCRAMBLED, SCRAMBLED_UNITS, seed)
    }

    /// Words in the FIFO of [`scrambled`](Self::scrambled), the smallest that the component offers.
    pub const SCRAMBLED_FIFO_DEPTH: usize = 64;

    fn of(calls: &'static Calls, units: u32, seed: u32) -> Self {
        // Safety: makes a new simulation, which `drop` frees.
        let sim = unsafe { (calls.new)(seed) };
        Self { calls, sim, units }
    }

    /// Returns how many pixel units it has.
    pub fn units(&self) -> u32 {
        self.units
    }

    /// Runs the bus clock.
    pub fn clock(&mut self, count: u64) {
        // Safety: `sim` lives as long as `self`, here and in every call below.
        unsafe { (self.calls.clock)(self.sim, count) }
    }

    /// Lets VGA's clock run with the bus clock: `ratio` is VGA clocks a bus clock, in 1/65,536.
    pub fn set_vga_ratio(&mut self, ratio: u32) {
        // Safety: as above.
        unsafe { (self.calls.vga_ratio)(self.sim, ratio) }
    }

    /// Says whether VGA is moved to the vertical blank when a swap has waited for it for 1,500 bus
    /// clocks. It is unless told otherwise: a frame's 420,000 VGA clocks take far longer than its
    /// drawing. The next frame on the pins that begins after that is whole again.
    pub fn set_hurry(&mut self, on: bool) {
        // Safety: as above.
        unsafe { (self.calls.hurry)(self.sim, on.into()) }
    }

    /// Runs the bus clock as [`clock`](Rtl::clock) does, but may leave clocks out in which nothing
    /// changes except time: nothing is under way, or a swap waits for the vertical blank alone. VGA's
    /// clocks all run. Returns how many were left out: [`clocks`](Rtl::clocks) lacks them, and so do BUSY_CYCLES
    /// and STALLED_CYCLES where a swap waited.
    ///
    /// A swap then takes place up to a line of VGA later, and nothing else differs.
    pub fn run(&mut self, count: u64) -> u64 {
        // Safety: as above.
        unsafe { (self.calls.run)(self.sim, count, 1) }
    }

    /// Returns how many swaps took place.
    pub fn swaps(&self) -> u64 {
        // Safety: as above.
        unsafe { (self.calls.swaps)(self.sim) }
    }

    /// Takes every picture from the VGA pins from now on, or none any more.
    pub fn set_scan(&mut self, on: bool) {
        // Safety: as above.
        unsafe { (self.calls.scan)(self.sim, on.into()) }
    }

    /// Says whether anyone looks at the VGA pins, as is taken for granted until told otherwise. While nobody does, no
    /// picture is taken from them, and VGA's clocks are left out in lines in which nothing else depends on them. All
    /// else happens in the same clock as it would. A picture that begins after someone looks again is whole.
    pub fn set_watched(&mut self, on: bool) {
        // Safety: as above.
        unsafe { (self.calls.watch)(self.sim, on.into()) }
    }

    /// Returns the last whole picture that was taken from the pins, and how many swaps came before it.
    pub fn scanned(&self) -> Option<(Frame, u64)> {
        let (mut pixels, mut swaps) = (vec![[0; 3]; Frame::PIXELS], 0);
        // Safety: as above; `pixels` has room for three bytes of each.
        let there = unsafe { (self.calls.scanned)(self.sim, pixels.as_mut_ptr().cast(), &mut swaps) != 0 };
        there.then(|| (Frame::of(pixels), swaps))
    }

    /// Returns how many swaps came before the last whole picture.
    pub fn swaps_scanned(&self) -> Option<u64> {
        let mut swaps = 0;
        // Safety: as above; no pixels are asked for.
        let there = unsafe { (self.calls.scanned)(self.sim, std::ptr::null_mut(), &mut swaps) != 0 };
        there.then_some(swaps)
    }

    /// Returns in how many VGA clocks, at most, the next picture is whole, and how many swaps came
    /// before it; more may come while VGA is in its blank.
    pub fn scan_left(&self) -> (u64, u64) {
        let mut swaps = 0;
        // Safety: as above.
        let left = unsafe { (self.calls.scan_left)(self.sim, &mut swaps) };
        (left, swaps)
    }

    /// Turns the test-pattern switch.
    pub fn set_test_pattern(&mut self, on: bool) {
        // Safety: as above.
        unsafe { (self.calls.test_pattern)(self.sim, on.into()) }
    }

    /// Returns how many bus clocks have run.
    pub fn clocks(&self) -> u64 {
        // Safety: as above.
        unsafe { (self.calls.clocks)(self.sim) }
    }

    /// Returns how many tiles the traversal has visited.
    pub fn tiles(&self) -> u64 {
        // Safety: as above.
        unsafe { (self.calls.tiles)(self.sim) }
    }

    /// Returns the interrupt line.
    pub fn irq(&self) -> bool {
        // Safety: as above.
        unsafe { (self.calls.irq)(self.sim) != 0 }
    }

    /// Returns STATUS.busy, without a bus access.
    pub fn busy(&self) -> bool {
        // Safety: as above.
        unsafe { (self.calls.busy)(self.sim) != 0 }
    }

    /// Returns STATUS.swap_pending, without a bus access.
    pub fn swap_pending(&self) -> bool {
        // Safety: as above.
        unsafe { (self.calls.swap_pending)(self.sim) != 0 }
    }

    /// Writes a word to the aperture and returns for how many clocks the bus was held.
    pub fn push_word(&mut self, word: u32) -> u64 {
        // Safety: as above.
        unsafe { (self.calls.push)(self.sim, word) }
    }

    /// Reads a word of the aperture; returns what stands on the bus in the same clock, or `None` when the bus is held.
    pub fn read_aperture(&mut self) -> Option<u32> {
        // Safety: as above.
        let answer = unsafe { (self.calls.read_aperture)(self.sim) };
        (answer >> 32 == 0).then_some(answer as u32)
    }

    /// Reads the word at a byte offset of the register agent, whether or not a register is there.
    pub fn read_offset(&mut self, offset: u32) -> u32 {
        // Safety: as above.
        unsafe { (self.calls.read)(self.sim, offset) }
    }

    /// Writes the word at a byte offset of the register agent.
    pub fn write_offset(&mut self, offset: u32, value: u32) {
        // Safety: as above.
        unsafe { (self.calls.write)(self.sim, offset, value) }
    }

    /// Runs until the device is at rest.
    ///
    /// # Panics
    /// When it has not come to rest within `limit` bus clocks.
    pub fn rest(&mut self, limit: u64) {
        // Safety: as above.
        let rests = unsafe { (self.calls.rest)(self.sim, limit) != 0 };
        assert!(rests, "not at rest after {limit} clocks");
    }

    /// Runs until the FIFO is empty, even if the stream then stands inside a packet.
    ///
    /// # Panics
    /// When it is not empty within `limit` bus clocks.
    pub fn drain(&mut self, limit: u64) {
        let depth = u32::from(Capabilities(Port::read(self, Register::Capabilities)).fifo_depth());
        let end = self.clocks() + limit;
        // Safety: as above.
        while unsafe { (self.calls.free_words)(self.sim) } < depth {
            assert!(self.clocks() < end, "words in the FIFO after {limit} clocks");
            self.clock(1);
        }
    }

    /// Returns what the memories hold.
    pub fn memories(&mut self) -> Memories {
        let front = Status(Port::read(self, Register::Status)).front_buffer();
        let mut memories = Memories::zeroed(front.into());
        let [first, second] = &mut memories.colours;
        // Safety: each points to room for all of a screen's pixels.
        unsafe {
            (self.calls.memory)(self.sim, first.as_mut_ptr(), second.as_mut_ptr(), memories.depths.as_mut_ptr());
        }
        memories
    }

    /// Has everything that happens from one bus clock up to another written to an FST file, for
    /// GTKWave or Surfer. A bus clock takes 20 ns there, so clock 1,000 is at 20 µs.
    ///
    /// The file is whole when the device has passed the last clock, after [`end_wave`](Rtl::end_wave),
    /// or when the device has been dropped.
    ///
    /// # Errors
    /// [`WaveError`] when waves are not built in, or the file cannot be written.
    pub fn record_wave(&mut self, file: &Path, clocks: Range<u64>) -> Result<(), WaveError> {
        let refused = |error| WaveError::File { file: file.into(), error };
        File::create(file).map_err(refused)?;
        let name = CString::new(file.as_os_str().as_encoded_bytes()).map_err(|error| refused(error.into()))?;
        // Safety: as above; the simulation copies the name.
        let built_in = unsafe { (self.calls.wave)(self.sim, name.as_ptr(), clocks.start, clocks.end) };
        if built_in == 0 { Err(WaveError::NotBuiltIn) } else { Ok(()) }
    }

    /// Ends the recording of a wave, if there is one.
    pub fn end_wave(&mut self) {
        // Safety: as above; without a name nothing is opened.
        unsafe { (self.calls.wave)(self.sim, ptr::null(), 0, 0) };
    }

    /// Gives VGA one clock and returns its pins, as [`crate::vga::Pins`] reads them.
    pub(crate) fn vga_clock(&mut self) -> u32 {
        // Safety: as above.
        unsafe { (self.calls.vga_clock)(self.sim) }
    }
}

impl Drop for Rtl {
    fn drop(&mut self) {
        // Safety: made by `new`, freed once.
        unsafe { (self.calls.free)(self.sim) }
    }
}

impl Port for Rtl {
    fn read(&mut self, register: Register) -> u32 {
        self.read_offset(register as u32)
    }

    fn write(&mut self, register: Register, value: u32) {
        self.write_offset(register as u32, value);
    }

    fn push(&mut self, words: &[u32]) {
        // Safety: `words` is as long as it says.
        unsafe { (self.calls.push_all)(self.sim, words.as_ptr(), words.len() as u64) }
    }
}
