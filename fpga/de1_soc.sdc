# Timing constraints. Platform Designer adds those of the processor and of its reset controllers.

create_clock -name board_clock -period 20.000 [get_ports {CLOCK_50}]

# The bus and raster clock (bus_pll) and VGA's pixel clock (vga_pll).
derive_pll_clocks
derive_clock_uncertainty

# Crossings between the two. Both clocks come from one board clock, so every path between them is
# analysed unless it is named here: a crossing that was forgotten fails timing.

# Levels, through two flip-flops; only the first may go metastable.
set_false_path -to [get_registers {*|synchronizer:u_to_vga|first_q[*]}]
set_false_path -to [get_registers {*|synchronizer:u_from_vga|first_q[*]}]

# Resets: asserted at any time, released with the clock they are for.
set_false_path -to [get_pins -compatibility_mode {*|u_reset|first_q|clrn}]
set_false_path -to [get_pins -compatibility_mode {*|u_reset|second_q|clrn}]
set_false_path -to [get_pins -compatibility_mode {*|u_vga_reset|first_q|clrn}]
set_false_path -to [get_pins -compatibility_mode {*|u_vga_reset|second_q|clrn}]

# Pixels cross in the colour memories (ram_1w1r:u_colour): each of an M10K's two ports has its own
# clock, address and data registers, so there is no path from one clock to the other.

# Inputs from fingers, through two flip-flops; lights for eyes.
set_false_path -from [get_ports {KEY[*]}] -to [get_registers {*|synchronizer:u_inputs|first_q[*]}]
set_false_path -from [get_ports {SW[*]}] -to [get_registers {*|synchronizer:u_inputs|first_q[*]}]
set_false_path -to [get_ports {LEDR[*]}]
set_false_path -to [get_ports {HEX0[*]}]
set_false_path -to [get_ports {HEX1[*]}]
set_false_path -to [get_ports {HEX2[*]}]
set_false_path -to [get_ports {HEX3[*]}]
set_false_path -to [get_ports {HEX4[*]}]
set_false_path -to [get_ports {HEX5[*]}]

# VGA: the converter takes a pixel at the rising edge on VGA_CLK, which is vga_pll's clock inverted;
# so half a period (19.9 ns) lies between a change and its edge, and 2 ns on either side are easy.
set vga_clock_pins [get_pins -compatibility_mode {*|vga_pll|*|divclk}]
if {[get_collection_size $vga_clock_pins] != 1} {
    post_message -type critical_warning "de1_soc.sdc: no single output of vga_pll was found, so the VGA pins are not constrained"
}
create_generated_clock -name vga_clock_pin -source $vga_clock_pins -invert [get_ports {VGA_CLK}]
foreach port {VGA_R[*] VGA_G[*] VGA_B[*] VGA_HS VGA_VS VGA_BLANK_N} {
    set_output_delay -clock vga_clock_pin -max 2.0 [get_ports $port]
    set_output_delay -clock vga_clock_pin -min -2.0 [get_ports $port]
}
# A constant.
set_false_path -to [get_ports {VGA_SYNC_N}]
