# Platform Designer's description of the board's keys, switches, lights and displays: board_io.sv.

package require -exact qsys 16.0

set_module_property NAME board_io
set_module_property DISPLAY_NAME "DE1-SoC keys, switches, LEDs and hex displays"
set_module_property DESCRIPTION "The board's inputs and outputs as registers"
set_module_property GROUP "Halfspace"
set_module_property VERSION 1.0
set_module_property EDITABLE false

add_fileset synthesis QUARTUS_SYNTH add_sources
set_fileset_property synthesis TOP_LEVEL board_io

proc add_sources {entity} {
    set here [get_module_property MODULE_DIRECTORY]
    add_fileset_file board_io_pkg.sv SYSTEM_VERILOG PATH [file join $here .. board_io_pkg.sv]
    add_fileset_file synchronizer.sv SYSTEM_VERILOG PATH [file join $here .. .. rtl synchronizer.sv]
    add_fileset_file board_io.sv SYSTEM_VERILOG PATH [file join $here .. board_io.sv]
}

add_interface clock clock end
add_interface_port clock clk_i clk Input 1

add_interface reset reset end
set_interface_property reset associatedClock clock
set_interface_property reset synchronousEdges DEASSERT
add_interface_port reset rst_ni reset_n Input 1

# The register agent: reads answer in the clock after, nothing ever waits.

add_interface registers avalon end
set_interface_property registers associatedClock clock
set_interface_property registers associatedReset reset
set_interface_property registers addressUnits WORDS
set_interface_property registers readLatency 1
set_interface_property registers readWaitTime 0
set_interface_property registers writeWaitTime 0
add_interface_port registers address_i address Input 3
add_interface_port registers read_i read Input 1
add_interface_port registers readdata_o readdata Output 32
add_interface_port registers write_i write Input 1
add_interface_port registers writedata_i writedata Input 32

add_interface pins conduit end
add_interface_port pins keys_ni keys_n Input 4
add_interface_port pins switches_i switches Input 10
add_interface_port pins leds_o leds Output 10
add_interface_port pins hex0_no hex0_n Output 7
add_interface_port pins hex1_no hex1_n Output 7
add_interface_port pins hex2_no hex2_n Output 7
add_interface_port pins hex3_no hex3_n Output 7
add_interface_port pins hex4_no hex4_n Output 7
add_interface_port pins hex5_no hex5_n Output 7
