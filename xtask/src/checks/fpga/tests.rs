//! The lint finds what it is for: each mistake is made in a copy of the project, and must be named.

use std::fs;
use std::path::Path;

use super::{Tools, build, check};
use crate::paths::{TemporaryFolder, workspace_root};
use crate::progress::Progress;

/// A mistake: the file, what is replaced by what, and what the lint must say of it.
struct Mistake(&'static str, &'static str, &'static str, &'static str);

const MISTAKES: &[Mistake] = &[
    // Tcl.
    Mistake("fpga/pins.tcl", "pins VGA_HS B11", "pins VGA_HS {B11", "fpga/pins.tcl:"),
    Mistake(
        "fpga/pins.tcl",
        "set_location_assignment",
        "set_locaton_assignment",
        "set_locaton_assignment is neither a command",
    ),
    Mistake("fpga/system.tcl", "create_system", "project_new", "project_new is neither a command"),
    Mistake("fpga/system.tcl", "$pixel_units\n", "$pixels\n", "can't read \"pixels\""),
    // Pins.
    Mistake("fpga/pins.tcl", "pins VGA_VS D11\n", "", "fpga/de1_soc.sv:27: VGA_VS has no pin"),
    Mistake("fpga/pins.tcl", "pins KEY {AA14 AA15 W15 Y16}", "pins KEY {AA14 AA15 W15}", "KEY[3] has no pin"),
    Mistake(
        "fpga/pins.tcl",
        "pins VGA_HS B11",
        "pins VGA_HSYNC B11",
        "`VGA_HSYNC` is assigned, but the top level has no",
    ),
    Mistake("fpga/pins.tcl", "pins VGA_HS B11", "pins VGA_HS D11", "PIN_D11 of VGA_VS has been given to VGA_HS before"),
    Mistake("fpga/pins.tcl", "pins VGA_HS B11", "pins VGA_HS B11\npins VGA_HS C11", "VGA_HS has a second pin"),
    Mistake("fpga/pins.tcl", "pins VGA_HS B11", "pins VGA_HS 11B", "`PIN_11B` of VGA_HS is no pin"),
    Mistake("fpga/pins.tcl", "-name IO_STANDARD", "-name IO_STANDARDS", "has no I/O standard"),
    Mistake("fpga/pins.tcl", "pins VGA_HS", "pins HPS_DDR3_CKE C3\npins VGA_HS", "`HPS_DDR3_CKE` is the processor's"),
    Mistake(
        "fpga/de1_soc.sv",
        "output logic        VGA_HS,",
        "output logic        VGA_HS,\n    output logic SPARE,",
        "SPARE has no pin",
    ),
    // Components.
    Mistake(
        "fpga/ip/halfspace_hw.tcl",
        "register_address_i address Input 10",
        "register_address_i address Input 8",
        "`register_address_i` has 8 bits here and 10 in rtl/halfspace.sv",
    ),
    Mistake("fpga/ip/halfspace_hw.tcl", "irq_o irq Output", "irq_o irq Input", "`irq_o` is Input here and Output"),
    Mistake("fpga/ip/halfspace_hw.tcl", "fifo_write_i write", "fifo_wr_i write", "halfspace has no port `fifo_wr_i`"),
    Mistake(
        "fpga/ip/halfspace_hw.tcl",
        "add_interface_port vga vga_sync_no sync_n Output 1\n",
        "",
        "port `vga_sync_no` is in no interface",
    ),
    Mistake(
        "fpga/ip/halfspace_hw.tcl",
        "FifoDepth POSITIVE 1024",
        "FifoDepth POSITIVE 512",
        "`FifoDepth` is 512 by default here and 1024",
    ),
    Mistake(
        "fpga/ip/halfspace_hw.tcl",
        "add_parameter PixelUnits",
        "add_parameter Pixelunits",
        "has no parameter `Pixelunits`",
    ),
    Mistake(
        "fpga/ip/halfspace_hw.tcl",
        "fifo associatedClock clock",
        "fifo associatedClock clk",
        "there is no interface `clk`",
    ),
    Mistake("fpga/ip/board_io_hw.tcl", "TOP_LEVEL board_io", "TOP_LEVEL board", "TOP_LEVEL is board, but the module"),
    Mistake(
        "rtl/halfspace.sv",
        "output logic        irq_o,",
        "output logic        irq_o,\n    input  logic        more_i,",
        "port `more_i` is in no interface",
    ),
    // The system.
    Mistake(
        "fpga/system.tcl",
        "board_io.registers 0x2000",
        "board_io.registers 0x3000",
        "0x3000, but 0x2000 in fpga-regs",
    ),
    Mistake(
        "fpga/system.tcl",
        "irqNumber 0",
        "irqNumber 1",
        "irqNumber of hps.f2h_irq0/halfspace.interrupt is 1, but 0x0",
    ),
    Mistake(
        "fpga/system.tcl",
        "attach h2f_axi_master halfspace.fifo 0x0000\n",
        "",
        "`halfspace.fifo` is neither connected nor exported",
    ),
    Mistake("fpga/system.tcl", "halfspace.vga_clock", "halfspace.vga_clk", "halfspace has no interface `vga_clk`"),
    Mistake(
        "fpga/system.tcl",
        "add_connection bus_pll.outclk0 hps.h2f_axi_clock",
        "add_connection pll.outclk0 hps.h2f_axi_clock",
        "there is no instance `pll`",
    ),
    Mistake("fpga/system.tcl", "export vga conduit", "export video conduit", "vga_red"),
    Mistake("fpga/system.tcl", "MEM_ROW_ADDR_WIDTH 15", "MEM_ROW_ADDR_WIDTH 14", "memory_mem_a"),
    Mistake("fpga/de1_soc.sv", ".vga_sync_n           (VGA_SYNC_N)", ".vga_sync             (VGA_SYNC_N)", "vga_sync"),
    // Sources.
    Mistake("fpga/project.tcl", "$here de1_soc.sv", "$here de1soc.sv", "there is no file"),
    Mistake("fpga/ip/board_io_hw.tcl", "rtl synchronizer.sv]", "rtl synchroniser.sv]", "there is no file"),
    Mistake(
        "fpga/ip/halfspace_hw.tcl",
        "$line ne \"\"",
        "$line ne \"\" && $line ne \"counters.sv\"",
        "missing: [\"counters.sv\"]",
    ),
    Mistake("rtl/files.f", "counters.sv\n", "counters.sv\ncounter.sv\n", "[\"rtl/counter.sv\"] are not there"),
    // Timing.
    Mistake(
        "fpga/de1_soc.sdc",
        "{*|synchronizer:u_to_vga|first_q[*]}",
        "{*|synchronizer:u_tovga|first_q[*]}",
        "no synchronizer is called `u_tovga`",
    ),
    Mistake(
        "fpga/de1_soc.sdc",
        "{*|synchronizer:u_to_vga|first_q[*]}",
        "{*|synchronizer:u_to_vga|meta_q[*]}",
        "synchronizer has no register `meta_q`",
    ),
    Mistake(
        "fpga/de1_soc.sdc",
        "{*|u_vga_reset|first_q|clrn}",
        "{*|u_vga_rst|first_q|clrn}",
        "`*|u_vga_rst|first_q|clrn` finds nothing",
    ),
    Mistake("fpga/de1_soc.sdc", "{*|vga_pll|*|divclk}", "{*|pll|*|divclk}", "`*|pll|*|divclk` finds nothing"),
    Mistake("fpga/de1_soc.sdc", "get_ports {CLOCK_50}", "get_ports {CLOCK50}", "the top level has no port `CLOCK50`"),
    Mistake("fpga/de1_soc.sdc", "get_ports {LEDR[*]}", "get_ports {LEDR}", "`LEDR` finds no bit of LEDR"),
    Mistake("fpga/de1_soc.sdc", "set_false_path -to [get_ports {HEX3[*]}]\n", "", "HEX3 has no timing"),
    Mistake("fpga/de1_soc.sdc", "derive_pll_clocks\n", "", "derive_pll_clocks is missing"),
    Mistake(
        "rtl/halfspace.sv",
        ") u_from_vga (",
        ") u_out_of_vga (",
        "the crossing u_out_of_vga is not in fpga/de1_soc.sdc",
    ),
    // The language.
    Mistake(
        "rtl/span_queue.sv",
        "module span_queue (",
        "module span_queue\n  import raster_pkg::*;\n(",
        "no import in a module's header",
    ),
    Mistake(
        "rtl/ram_1w1r.sv",
        "parameter int unsigned Depth = 1024\n",
        "parameter int unsigned Depth = 1024,\n localparam int A = 1\n",
        "no localparam among the parameters",
    ),
    Mistake("rtl/halfspace.sv", "for (k = 0", "for (genvar k = 0", "declare the genvar before the loop"),
    Mistake("rtl/halfspace.sv", "  generate\n", "", "put generate and endgenerate around"),
    Mistake(
        "rtl/buffer_control.sv",
        "endmodule",
        "always_comb unique case (1'b1)\n default: ;\nendcase\nendmodule",
        "gets case (1'b1) wrong",
    ),
];

/// Mistakes in the Makefile.
const BUILD_MISTAKES: &[Mistake] = &[
    Mistake("fpga/Makefile", "bitstream_compression=on", "bitstream_compression=off", "the tools are called as"),
    Mistake("fpga/Makefile", "\tcd build && quartus_cdb --merge de1_soc\n", "", "the tools are called as"),
    Mistake("fpga/Makefile", "set bus_mhz $(BUS_MHZ)", "set bus_mhz 50", "do not reach system.tcl"),
    Mistake("fpga/Makefile", "$$3 < 0", "$$3 < -9", "a negative slack does not stop the build"),
    Mistake(
        "fpga/Makefile",
        "\t@rm -f $@ build/halfspace.sof\n",
        "",
        "a negative slack does not stop the build, or leaves an image",
    ),
    Mistake(
        "fpga/Makefile",
        "| cmp -s - build/settings ||",
        "| false ||",
        "a second build with the same settings calls",
    ),
    Mistake("fpga/Makefile", ",1 2 4 8)", ",1 2 3 4 8)", "PIXEL_UNITS=3 is not refused"),
    Mistake("fpga/Makefile", "ifneq ($(MISSING),)", "ifneq (,)", "does not name the missing tools"),
];

/// Copies the project, makes the mistake and returns what `found` says of it.
fn outcome(mistake: &Mistake, found: impl Fn(&Path) -> anyhow::Result<()>) -> Result<(), String> {
    let Mistake(file, from, to, expected) = mistake;
    let folder = TemporaryFolder::new().expect("folders can be made");
    for part in ["fpga", "fpga/ip", "fpga/lint", "rtl"] {
        fs::create_dir_all(folder.path().join(part)).expect("folders can be made");
        for entry in fs::read_dir(workspace_root().join(part)).expect("the project is there") {
            let path = entry.expect("readable").path();
            if let (true, Some(name)) = (path.is_file(), path.file_name()) {
                fs::copy(&path, folder.path().join(part).join(name)).expect("files can be copied");
            }
        }
    }
    let path = folder.path().join(file);
    let text = fs::read_to_string(&path).expect("the file is there");
    if !text.contains(from) {
        return Err(format!("{file} has no {from:?} any more: mend the test"));
    }
    fs::write(&path, text.replacen(from, to, 1)).expect("files can be written");
    match found(folder.path()) {
        Ok(()) => Err(format!("{file}: {from:?} as {to:?} was not found")),
        Err(error) if format!("{error:#}").contains(expected) => Ok(()),
        Err(error) => Err(format!("{file}: {from:?} as {to:?} was not called {expected:?} but:\n{error:#}")),
    }
}

fn all_are_found(mistakes: &[Mistake], found: impl Fn(&Path) -> anyhow::Result<()>) {
    let missed: Vec<String> = mistakes.iter().filter_map(|mistake| outcome(mistake, &found).err()).collect();
    assert!(missed.is_empty(), "{} of {}:\n{}", missed.len(), mistakes.len(), missed.join("\n"));
}

#[test]
#[ignore = "wants tclsh and Verilator: `cargo xtask test` runs it"]
fn every_mistake_is_found() {
    let tools = Tools::find(&Progress::quiet()).expect("the tools are there");
    check(&tools, &workspace_root()).expect("the project is right as it is");
    all_are_found(MISTAKES, |root| check(&tools, root));
}

#[test]
#[ignore = "wants make: `cargo xtask test` runs it"]
fn every_mistake_of_the_makefile_is_found() {
    let tools = Tools::find(&Progress::quiet()).expect("the tools are there");
    build::check(&tools.make, &workspace_root()).expect("the Makefile is right as it is");
    all_are_found(BUILD_MISTAKES, |root| build::check(&tools.make, root));
}
