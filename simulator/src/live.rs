//! The board in a window, with the PC's keyboard as its USB keyboard.

#[cfg(target_os = "linux")]
mod gamepad;
mod keys;

use std::error::Error;
use std::fs::File;
use std::io::{Write, stdout};
use std::time::{Duration, Instant};

use controls::serial::{self, FRAME_SIZE_MAXIMUM, kind};
use minifb::{Key, Window, WindowOptions};

use crate::fpga::{Fpga, Screen};
use crate::machine::{Event, Machine};
use crate::time::{Clocks, in_milliseconds, milliseconds};
use keys::{FIRST_MODIFIER, OnBoard, on_board, usage};

/// How often the window is drawn: 60 times a second.
const FRAME: Clocks = milliseconds(50) / 3;
const FRAME_TIME: Duration = Duration::from_micros(16_667);
const WIDTH: usize = Screen::WIDTH as usize;
const HEIGHT: usize = Screen::HEIGHT as usize;

/// Runs the machine in a window until that is closed, in real time where the PC is fast enough. What
/// the console says goes to the terminal and to a file.
///
/// # Errors
/// When there is no display, or the simulator stops the program.
pub fn run(machine: Machine, file: File) -> Result<(), Box<dyn Error>> {
    let mut window = Window::new("DE1-SoC", WIDTH, HEIGHT, WindowOptions::default())
        .map_err(|error| format!("no window ({error}): use --headless, or start an X server"))?;
    machine.hardware(|hardware| hardware.usb.plug_keyboard());
    let mut live = Live {
        machine,
        file,
        written: 0,
        keys: Vec::new(),
        switches: 0,
        #[cfg(target_os = "linux")]
        gamepad: None,
    };
    #[cfg(target_os = "linux")]
    live.find_gamepad();
    let mut pixels = vec![0; WIDTH * HEIGHT];
    let mut meter = Meter::new();
    while window.is_open() {
        let started = Instant::now();
        live.take_keys(window.get_keys());
        #[cfg(target_os = "linux")]
        live.take_gamepad();
        live.run()?;
        let now = live.machine.now();
        let screen = live.machine.hardware(|hardware| {
            hardware.fpga.scanned_out(now);
            hardware.fpga.screen()
        });
        if let Some(screen) = screen {
            for (pixel, [red, green, blue]) in pixels.iter_mut().zip(screen.pixels()) {
                *pixel = u32::from_be_bytes([0, *red, *green, *blue]);
            }
        }
        window.update_with_buffer(&pixels, WIDTH, HEIGHT)?;
        if let Some(title) = meter.frame(&live.machine) {
            window.set_title(&title);
        }
        std::thread::sleep(FRAME_TIME.saturating_sub(started.elapsed()));
    }
    Ok(())
}

struct Live {
    machine: Machine,
    file: File,
    /// Bytes of the console's line that were shown.
    written: usize,
    keys: Vec<Key>,
    switches: u16,
    /// A gamepad of the PC, which is the board's DualShock 3.
    #[cfg(target_os = "linux")]
    gamepad: Option<gamepad::Gamepad>,
}

impl Live {
    fn run(&mut self) -> Result<(), Box<dyn Error>> {
        let event = self.machine.run(FRAME);
        let said = &self.machine.console()[self.written..];
        stdout().write_all(&text(said))?;
        self.file.write_all(said)?;
        self.written += said.len();
        if let Event::Reset(cause) = event? {
            println!("[{:.0} ms: reset by {cause:?}]", in_milliseconds(self.machine.now()));
        }
        Ok(())
    }

    /// Plugs a DualShock 3 in if the PC has a gamepad.
    #[cfg(target_os = "linux")]
    fn find_gamepad(&mut self) {
        match gamepad::Gamepad::find() {
            Some((gamepad, name)) => {
                println!("{name} is the board's DualShock 3, without its tilt");
                self.gamepad = Some(gamepad);
                self.machine.hardware(|hardware| hardware.usb.plug_pad());
            }
            None => println!("no gamepad that may be read is plugged into this computer: the board has none"),
        }
    }

    #[cfg(target_os = "linux")]
    fn take_gamepad(&mut self) {
        let Some(gamepad) = &mut self.gamepad else { return };
        if let Some(report) = gamepad.report() {
            self.machine.hardware(|hardware| hardware.usb.pad().lock().function.set(|bytes| *bytes = report));
        } else {
            println!("the gamepad has gone");
            self.gamepad = None;
            self.machine.hardware(|hardware| hardware.usb.unplug_pad());
        }
    }

    fn take_keys(&mut self, keys: Vec<Key>) {
        if keys == self.keys {
            return;
        }
        let before = std::mem::replace(&mut self.keys, keys);
        self.press_on_board(&before);
        let usages = |keys: &[Key]| keys.iter().copied().filter_map(usage).collect::<Vec<u8>>();
        let (before, now) = (usages(&before), usages(&self.keys));
        if before != now {
            self.press_on_keyboard(&before, &now);
        }
    }

    fn press_on_board(&mut self, before: &[Key]) {
        let held = |what: OnBoard| self.keys.iter().any(|key| on_board(*key) == Some(what));
        let pressed = (0..4).fold(0, |pressed, number| pressed | u8::from(held(OnBoard::Key(number))) << number);
        let hps_key = held(OnBoard::HpsKey);
        for key in self.keys.iter().filter(|key| !before.contains(key)) {
            if let Some(OnBoard::Switch(number)) = on_board(*key) {
                self.switches ^= 1 << number;
            }
        }
        let switches = self.switches;
        self.machine.hardware(|hardware| {
            hardware.board_io.keys = hardware.board_io.keys.with_pressed(pressed);
            hardware.board_io.switches = hardware.board_io.switches.with_up(switches);
            hardware.set_hps_key(hps_key);
        });
    }

    /// Tells the board which keys changed: over USB once the program drives the controller, before
    /// that as reports over the console's line.
    fn press_on_keyboard(&mut self, before: &[u8], now: &[u8]) {
        if self.machine.hardware(|hardware| hardware.usb_runs()) {
            self.machine.hardware(|hardware| {
                let mut keyboard = hardware.usb.keyboard().lock();
                before.iter().filter(|key| !now.contains(key)).for_each(|key| keyboard.function.release(*key));
                now.iter().filter(|key| !before.contains(key)).for_each(|key| keyboard.function.press(*key));
            });
            return;
        }
        let mut report = [0; 8];
        let (modifiers, others): (Vec<u8>, Vec<u8>) = now.iter().partition(|key| **key >= FIRST_MODIFIER);
        report[0] = modifiers.iter().fold(0, |bits, key| bits | 1 << (key - FIRST_MODIFIER));
        report[2..].iter_mut().zip(others).for_each(|(slot, key)| *slot = key);
        let mut buffer = [0; FRAME_SIZE_MAXIMUM];
        if let Ok(bytes) = serial::encode(kind::KEYBOARD, &report, &mut buffer) {
            self.machine.send(bytes);
        }
    }
}

/// Returns what a person reads of the console's bytes, which may be binary messages, too.
fn text(bytes: &[u8]) -> Vec<u8> {
    bytes.iter().copied().filter(|byte| matches!(byte, b'\n' | b' '..=b'~')).collect()
}

/// How fast it goes.
struct Meter {
    since: Instant,
    windows: u32,
    frames: u64,
}

impl Meter {
    fn new() -> Self {
        Self { since: Instant::now(), windows: 0, frames: 0 }
    }

    /// Counts a frame of the window; once a second returns the title that says all.
    fn frame(&mut self, machine: &Machine) -> Option<String> {
        self.windows += 1;
        let passed = self.since.elapsed();
        if passed < Duration::from_secs(1) {
            return None;
        }
        let frames = machine.frames_shown();
        let rate = (frames - self.frames) as f64 / passed.as_secs_f64();
        let speed = 100.0 * f64::from(self.windows) * FRAME_TIME.as_secs_f64() / passed.as_secs_f64();
        *self = Self { since: Instant::now(), windows: 0, frames };
        let (leds, displays, led) =
            machine.hardware(|board| (board.board_io.leds().lit(), board.board_io.displays(), board.hps_led()));
        let led = if led { "on" } else { "off" };
        Some(format!(
            "DE1-SoC: {rate:.0} frames/s, {speed:.0} % of real time; HEX [{displays}] LEDR {leds:010b} HPS LED {led}"
        ))
    }
}
