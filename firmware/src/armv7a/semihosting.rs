//! Leaving an emulator (QEMU with `-semihosting`) with an exit code.

/// SYS_EXIT_EXTENDED: R1 points at a reason and a code.
const SYS_EXIT_EXTENDED: u32 = 0x20;
/// The reason `ADP_Stopped_ApplicationExit`: the code counts.
const APPLICATION_EXIT: u32 = 0x2_0026;

/// Ends the emulator with `code` as its exit code. Sleeps for ever where there is none to take
/// the call: the supervisor call handler then just returns.
pub fn exit(code: u32) -> ! {
    let block = [APPLICATION_EXIT, code];
    // SAFETY: SVC 0x123456 is ARM's semihosting call from ARM state (ARM "Semihosting for AArch32
    // and AArch64"). It reads the block, which lives on; the handler keeps all registers but LR.
    unsafe {
        core::arch::asm!(
            "svc 0x123456",
            inout("r0") SYS_EXIT_EXTENDED => _,
            in("r1") &raw const block,
            out("lr") _,
            options(nostack, readonly)
        );
    }
    super::exceptions::park()
}
