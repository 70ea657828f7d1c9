# Platform Designer's description of the rasterizer: module `halfspace` in rtl/.
#
# The sources are those of rtl/files.f, in its order. Interfaces: `registers` and `fifo` (Avalon-MM
# agents), `interrupt`, and `vga` for the pins.

package require -exact qsys 16.0

set_module_property NAME halfspace
set_module_property DISPLAY_NAME "Halfspace rasterizer"
set_module_property DESCRIPTION "Draws the triangles of a command stream into a double-buffered VGA picture"
set_module_property GROUP "Halfspace"
set_module_property VERSION 1.0
set_module_property EDITABLE false

add_fileset synthesis QUARTUS_SYNTH add_sources
set_fileset_property synthesis TOP_LEVEL halfspace

proc add_sources {entity} {
    set rtl [file join [get_module_property MODULE_DIRECTORY] .. .. rtl]
    set list [open [file join $rtl files.f]]
    set lines [split [read $list] "\n"]
    close $list
    foreach line $lines {
        if {$line ne "" && ![string match "//*" $line]} {
            add_fileset_file $line SYSTEM_VERILOG PATH [file join $rtl $line]
        }
    }
}

# Parameters of the module.

add_parameter PixelUnits POSITIVE 8
set_parameter_property PixelUnits DISPLAY_NAME "Pixel units"
set_parameter_property PixelUnits DESCRIPTION "Pixels drawn a clock at most"
set_parameter_property PixelUnits ALLOWED_RANGES {1 2 4 8}
set_parameter_property PixelUnits HDL_PARAMETER true

add_parameter FifoDepth POSITIVE 1024
set_parameter_property FifoDepth DISPLAY_NAME "FIFO depth"
set_parameter_property FifoDepth DESCRIPTION "Words that the command FIFO holds"
set_parameter_property FifoDepth ALLOWED_RANGES {64 128 256 512 1024 2048 4096}
set_parameter_property FifoDepth HDL_PARAMETER true

# Clocks and reset.

add_interface clock clock end
add_interface_port clock clk_i clk Input 1

add_interface reset reset end
set_interface_property reset associatedClock clock
set_interface_property reset synchronousEdges DEASSERT
add_interface_port reset rst_ni reset_n Input 1

add_interface vga_clock clock end
add_interface_port vga_clock vga_clk_i clk Input 1

# The register agent: reads answer in the clock after, nothing ever waits.

add_interface registers avalon end
set_interface_property registers associatedClock clock
set_interface_property registers associatedReset reset
set_interface_property registers addressUnits WORDS
set_interface_property registers readLatency 1
set_interface_property registers readWaitTime 0
set_interface_property registers writeWaitTime 0
add_interface_port registers register_address_i address Input 10
add_interface_port registers register_read_i read Input 1
add_interface_port registers register_readdata_o readdata Output 32
add_interface_port registers register_write_i write Input 1
add_interface_port registers register_writedata_i writedata Input 32

# The FIFO's aperture: a write waits while the FIFO is full; a read gets 0 in the same clock.

add_interface fifo avalon end
set_interface_property fifo associatedClock clock
set_interface_property fifo associatedReset reset
set_interface_property fifo addressUnits WORDS
set_interface_property fifo readLatency 0
set_interface_property fifo readWaitTime 0
set_interface_property fifo writeWaitTime 0
add_interface_port fifo fifo_address_i address Input 10
add_interface_port fifo fifo_read_i read Input 1
add_interface_port fifo fifo_readdata_o readdata Output 32
add_interface_port fifo fifo_write_i write Input 1
add_interface_port fifo fifo_writedata_i writedata Input 32
add_interface_port fifo fifo_waitrequest_o waitrequest Output 1

# The interrupt.

add_interface interrupt interrupt end
set_interface_property interrupt associatedAddressablePoint registers
set_interface_property interrupt associatedClock clock
set_interface_property interrupt associatedReset reset
add_interface_port interrupt irq_o irq Output 1

# The pins of VGA, and the switch for the test pattern.

add_interface vga conduit end
add_interface_port vga test_pattern_i test_pattern Input 1
add_interface_port vga vga_red_o red Output 8
add_interface_port vga vga_green_o green Output 8
add_interface_port vga vga_blue_o blue Output 8
add_interface_port vga vga_hsync_no hsync_n Output 1
add_interface_port vga vga_vsync_no vsync_n Output 1
add_interface_port vga vga_blank_no blank_n Output 1
add_interface_port vga vga_sync_no sync_n Output 1
