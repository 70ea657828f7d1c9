//! The SystemVerilog package of the board's keys, switches, lights and displays.

use fpga_regs::board_io::BOARD_REGISTERS;

use super::rtl_package::register_table;

/// Returns the package.
pub fn text() -> String {
    let mut package = String::from(
        "// Registers of the board's keys, switches, lights and displays: byte offsets and fields.\n\
         // Generated from the crate fpga-regs by `cargo xtask generate`: change it there.\n\
         `default_nettype none\n\n\
         package board_io_pkg;\n\n",
    );
    register_table(&mut package, BOARD_REGISTERS);
    package.push_str("endpackage\n\n`default_nettype wire\n");
    package
}
