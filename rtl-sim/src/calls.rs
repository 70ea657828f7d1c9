//! The C interface of the four verilated builds, as tables of functions.

use std::ffi::{c_char, c_void};

/// One build's functions; `shim.cpp` says what each does.
pub(crate) struct Calls {
    pub(crate) new: unsafe extern "C" fn() -> *mut c_void,
    pub(crate) free: unsafe extern "C" fn(*mut c_void),
    pub(crate) clock: unsafe extern "C" fn(*mut c_void, u64),
    pub(crate) vga_ratio: unsafe extern "C" fn(*mut c_void, u32),
    pub(crate) hurry: unsafe extern "C" fn(*mut c_void, u32),
    pub(crate) free_words: unsafe extern "C" fn(*const c_void) -> u32,
    pub(crate) test_pattern: unsafe extern "C" fn(*mut c_void, u32),
    pub(crate) clocks: unsafe extern "C" fn(*const c_void) -> u64,
    pub(crate) tiles: unsafe extern "C" fn(*const c_void) -> u64,
    pub(crate) irq: unsafe extern "C" fn(*const c_void) -> u32,
    pub(crate) busy: unsafe extern "C" fn(*const c_void) -> u32,
    pub(crate) swap_pending: unsafe extern "C" fn(*const c_void) -> u32,
    pub(crate) push: unsafe extern "C" fn(*mut c_void, u32) -> u64,
    pub(crate) push_all: unsafe extern "C" fn(*mut c_void, *const u32, u64),
    pub(crate) write: unsafe extern "C" fn(*mut c_void, u32, u32),
    pub(crate) read: unsafe extern "C" fn(*mut c_void, u32) -> u32,
    pub(crate) rest: unsafe extern "C" fn(*mut c_void, u64) -> u32,
    pub(crate) memory: unsafe extern "C" fn(*mut c_void, *mut u8, *mut u8, *mut u16),
    pub(crate) wave: unsafe extern "C" fn(*mut c_void, *const c_char, u64, u64) -> u32,
    pub(crate) vga_clock: unsafe extern "C" fn(*mut c_void) -> u32,
    pub(crate) run: unsafe extern "C" fn(*mut c_void, u64, u32) -> u64,
    pub(crate) swaps: unsafe extern "C" fn(*const c_void) -> u64,
    pub(crate) scan: unsafe extern "C" fn(*mut c_void, u32),
    pub(crate) scanned: unsafe extern "C" fn(*const c_void, *mut u8, *mut u64) -> u32,
    pub(crate) scan_left: unsafe extern "C" fn(*const c_void, *mut u64) -> u64,
}

macro_rules! build {
    ($build:ident: $($field:ident = $symbol:ident ( $($argument:ty),* ) $(-> $result:ty)?;)+) => {
        pub(crate) static $build: Calls = {
            unsafe extern "C" {
                $(fn $symbol($(_: $argument),*) $(-> $result)?;)+
            }
            Calls { $($field: $symbol),+ }
        };
    };
}

macro_rules! builds {
    ($($build:ident $new:ident $free:ident $clock:ident $ratio:ident $hurry:ident $free_words:ident $pattern:ident $clocks:ident $tiles:ident $irq:ident
       $busy:ident $pending:ident $push:ident $push_all:ident $write:ident $read:ident $rest:ident $memory:ident $wave:ident $vga:ident
       $run:ident $swaps:ident $scan:ident $scanned:ident $scan_left:ident;)+) => {
        $(build! { $build:
            new = $new() -> *mut c_void;
            free = $free(*mut c_void);
            clock = $clock(*mut c_void, u64);
            vga_ratio = $ratio(*mut c_void, u32);
            hurry = $hurry(*mut c_void, u32);
            free_words = $free_words(*const c_void) -> u32;
            test_pattern = $pattern(*mut c_void, u32);
            clocks = $clocks(*const c_void) -> u64;
            tiles = $tiles(*const c_void) -> u64;
            irq = $irq(*const c_void) -> u32;
            busy = $busy(*const c_void) -> u32;
            swap_pending = $pending(*const c_void) -> u32;
            push = $push(*mut c_void, u32) -> u64;
            push_all = $push_all(*mut c_void, *const u32, u64);
            write = $write(*mut c_void, u32, u32);
            read = $read(*mut c_void, u32) -> u32;
            rest = $rest(*mut c_void, u64) -> u32;
            memory = $memory(*mut c_void, *mut u8, *mut u8, *mut u16);
            wave = $wave(*mut c_void, *const c_char, u64, u64) -> u32;
            vga_clock = $vga(*mut c_void) -> u32;
            run = $run(*mut c_void, u64, u32) -> u64;
            swaps = $swaps(*const c_void) -> u64;
            scan = $scan(*mut c_void, u32);
            scanned = $scanned(*const c_void, *mut u8, *mut u64) -> u32;
            scan_left = $scan_left(*const c_void, *mut u64) -> u64;
        })+
    };
}

builds! {
    UNITS_1 halfspace_1_new halfspace_1_free halfspace_1_clock halfspace_1_vga_ratio halfspace_1_hurry halfspace_1_free_words halfspace_1_test_pattern halfspace_1_clocks halfspace_1_tiles halfspace_1_irq halfspace_1_busy halfspace_1_swap_pending halfspace_1_push halfspace_1_push_all halfspace_1_write halfspace_1_read halfspace_1_rest halfspace_1_memory halfspace_1_wave halfspace_1_vga_clock halfspace_1_run halfspace_1_swaps halfspace_1_scan halfspace_1_scanned halfspace_1_scan_left;
    UNITS_2 halfspace_2_new halfspace_2_free halfspace_2_clock halfspace_2_vga_ratio halfspace_2_hurry halfspace_2_free_words halfspace_2_test_pattern halfspace_2_clocks halfspace_2_tiles halfspace_2_irq halfspace_2_busy halfspace_2_swap_pending halfspace_2_push halfspace_2_push_all halfspace_2_write halfspace_2_read halfspace_2_rest halfspace_2_memory halfspace_2_wave halfspace_2_vga_clock halfspace_2_run halfspace_2_swaps halfspace_2_scan halfspace_2_scanned halfspace_2_scan_left;
    UNITS_4 halfspace_4_new halfspace_4_free halfspace_4_clock halfspace_4_vga_ratio halfspace_4_hurry halfspace_4_free_words halfspace_4_test_pattern halfspace_4_clocks halfspace_4_tiles halfspace_4_irq halfspace_4_busy halfspace_4_swap_pending halfspace_4_push halfspace_4_push_all halfspace_4_write halfspace_4_read halfspace_4_rest halfspace_4_memory halfspace_4_wave halfspace_4_vga_clock halfspace_4_run halfspace_4_swaps halfspace_4_scan halfspace_4_scanned halfspace_4_scan_left;
    UNITS_8 halfspace_8_new halfspace_8_free halfspace_8_clock halfspace_8_vga_ratio halfspace_8_hurry halfspace_8_free_words halfspace_8_test_pattern halfspace_8_clocks halfspace_8_tiles halfspace_8_irq halfspace_8_busy halfspace_8_swap_pending halfspace_8_push halfspace_8_push_all halfspace_8_write halfspace_8_read halfspace_8_rest halfspace_8_memory halfspace_8_wave halfspace_8_vga_clock halfspace_8_run halfspace_8_swaps halfspace_8_scan halfspace_8_scanned halfspace_8_scan_left;
}
