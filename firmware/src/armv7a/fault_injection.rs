//! Faults on purpose, to see their reports (feature `fault-injection`).

use crate::link::Fault;

/// An address in a hole of every board's map.
const HOLE: usize = 0x5000_0000;

/// Commits the fault. Does not come back.
pub fn inject(fault: Fault) -> ! {
    match fault {
        // SAFETY: there is none: the fault is what is asked for, and its report ends the program.
        Fault::DataAbort => unsafe {
            core::ptr::with_exposed_provenance_mut::<u32>(HOLE).write_volatile(1);
        },
        // SAFETY: as above.
        Fault::PrefetchAbort => unsafe {
            core::arch::asm!("bx {}", in(reg) HOLE, options(noreturn));
        },
        // SAFETY: as above.
        Fault::WriteToCode => unsafe {
            (inject as fn(Fault) -> ! as *mut u32).write_volatile(0);
        },
        // SAFETY: as above.
        Fault::UndefinedInstruction => unsafe { core::arch::asm!("udf #0", options(noreturn)) },
        Fault::StackOverflow => {
            deeper(0);
        }
        Fault::Panic => panic!("ordered by fault injection"),
    }
    unreachable!("{fault:?} did not fault")
}

/// Uses stack until there is none; the array keeps the call from becoming a loop.
#[inline(never)]
#[expect(unconditional_recursion, reason = "the stack is to overflow")]
fn deeper(depth: u32) -> u32 {
    let frame = core::hint::black_box([depth; 256]);
    core::hint::black_box(deeper(depth + 1)) + frame[0]
}
