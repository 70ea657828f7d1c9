//! The C interface of the verilated builds, as tables of functions.

use std::ffi::{c_char, c_void};

/// One build's functions; `shim.cpp` says what each does.
pub(crate) struct Calls {
    pub(crate) new: unsafe extern "C" fn(u32) -> *mut c_void,
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
    pub(crate) read_aperture: unsafe extern "C" fn(*mut c_void) -> u64,
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
    pub(crate) watch: unsafe extern "C" fn(*mut c_void, u32),
    pub(crate) scanned: unsafe extern "C" fn(*const c_void, *mut u8, *mut u64) -> u32,
    pub(crate) scan_left: unsafe extern "C" fn(*mut c_void, *mut u64) -> u64,
}

/// Declares a build's functions, `halfspace_BUILD_FIELD` each.
macro_rules! table {
    ($build:literal: $($field:ident($($argument:ty),*) $(-> $result:ty)?;)+) => {{
        unsafe extern "C" {
            $(
                #[link_name = concat!("halfspace_", $build, "_", stringify!($field))]
                fn $field($(_: $argument),*) $(-> $result)?;
            )+
        }
        Calls { $($field),+ }
    }};
}

macro_rules! builds {
    ($($(#[doc = $doc:literal])+ $name:ident $build:literal;)+) => {
        $(
            $(#[doc = $doc])+
            pub(crate) static $name: Calls = table! { $build:
                new(u32) -> *mut c_void;
                free(*mut c_void);
                clock(*mut c_void, u64);
                vga_ratio(*mut c_void, u32);
                hurry(*mut c_void, u32);
                free_words(*const c_void) -> u32;
                test_pattern(*mut c_void, u32);
                clocks(*const c_void) -> u64;
                tiles(*const c_void) -> u64;
                irq(*const c_void) -> u32;
                busy(*const c_void) -> u32;
                swap_pending(*const c_void) -> u32;
                push(*mut c_void, u32) -> u64;
                read_aperture(*mut c_void) -> u64;
                push_all(*mut c_void, *const u32, u64);
                write(*mut c_void, u32, u32);
                read(*mut c_void, u32) -> u32;
                rest(*mut c_void, u64) -> u32;
                memory(*mut c_void, *mut u8, *mut u8, *mut u16);
                wave(*mut c_void, *const c_char, u64, u64) -> u32;
                vga_clock(*mut c_void) -> u32;
                run(*mut c_void, u64, u32) -> u64;
                swaps(*const c_void) -> u64;
                scan(*mut c_void, u32);
                watch(*mut c_void, u32);
                scanned(*const c_void, *mut u8, *mut u64) -> u32;
                scan_left(*mut c_void, *mut u64) -> u64;
            };
        )+
    };
}

builds! {
    /// 1 pixel unit.
    UNITS_1 "1";
    /// 2 pixel units.
    UNITS_2 "2";
    /// 4 pixel units.
    UNITS_4 "4";
    /// 8 pixel units.
    UNITS_8 "8";
    /// 2 pixel units, a small FIFO, no interrupt line, and any state at power-on.
    SCRAMBLED "scrambled";
}
