# Where the board has its pins. All are 3.3-V LVTTL.
#
# Source: pin_assignment_DE1_SoC.tcl of sahandKashani/SoC-FPGA-Design-Guide, compared with quartus/de1.tcl
# of atthecodeface/quartus. HPS_DDR3_* have fixed places in the chip; their I/O standards come from
# the memory controller's own script (see Makefile).

# Assigns a port's pins, index 0 first; a port of one bit has no index.
proc pins {port places} {
    set index 0
    foreach place $places {
        set bit [expr {[llength $places] == 1 ? $port : "$port\[$index\]"}]
        set_location_assignment PIN_$place -to $bit
        set_instance_assignment -name IO_STANDARD "3.3-V LVTTL" -to $bit
        incr index
    }
}

pins CLOCK_50 AF14

pins KEY {AA14 AA15 W15 Y16}
pins SW {AB12 AC12 AF9 AF10 AD11 AD12 AE11 AC9 AD10 AE12}
pins LEDR {V16 W16 V17 V18 W17 W19 Y19 W20 W21 Y21}

# Segments a to g.
pins HEX0 {AE26 AE27 AE28 AG27 AF28 AG28 AH28}
pins HEX1 {AJ29 AH29 AH30 AG30 AF29 AF30 AD27}
pins HEX2 {AB23 AE29 AD29 AC28 AD30 AC29 AC30}
pins HEX3 {AD26 AC27 AD25 AC25 AB28 AB25 AB22}
pins HEX4 {AA24 Y23 Y24 W22 W24 V23 W25}
pins HEX5 {V25 AA28 Y27 AB27 AB26 AA26 AA25}

pins VGA_CLK A11
pins VGA_R {A13 C13 E13 B12 C12 D12 E12 F13}
pins VGA_G {J9 J10 H12 G10 G11 G12 F11 E11}
pins VGA_B {B13 G13 H13 F14 H14 F15 G15 J14}
pins VGA_HS B11
pins VGA_VS D11
pins VGA_BLANK_N F10
pins VGA_SYNC_N C10
