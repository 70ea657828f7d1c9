# The Platform Designer system: the processor, both PLLs, the rasterizer, the board's inputs and outputs.
#
#   qsys-script --search-path=ip,$ --cmd="set bus_mhz 50; set pixel_units 8" --script=system.tcl
#
# writes halfspace_system.qsys into the current folder. `bus_mhz` is the clock of both bridges and of the
# rasterizer, `pixel_units` is 1, 2, 4 or 8. Addresses are those of fpga-regs/src/de1_soc.rs.

package require -exact qsys 16.0

if {![info exists bus_mhz]} {
    set bus_mhz 50
}
if {![info exists pixel_units]} {
    set pixel_units 8
}

create_system halfspace_system
set_project_property DEVICE_FAMILY {Cyclone V}
set_project_property DEVICE {5CSEMA5F31C6}

# Sets many parameters of an instance.
proc set_parameters {instance parameters} {
    foreach {name value} $parameters {
        set_instance_parameter_value $instance $name $value
    }
}

# Brings an interface of an instance out of the system under a name.
proc export {name kind direction interface} {
    add_interface $name $kind $direction
    set_interface_property $name EXPORT_OF $interface
}

# The processor. Peripherals' pins are the preloader's matter and none is named here; see README.md.

add_instance hps altera_hps
set_parameters hps {
    LWH2F_Enable        true
    S2F_Width           1
    F2S_Width           0
    F2SDRAM_Type        {}
    F2SDRAM_Width       {}
    F2SINTERRUPT_Enable 1
    MPU_EVENTS_Enable   0
}

# Its DDR3: 32 bits wide, 1 GiB.
set_parameters hps {
    HPS_PROTOCOL       DDR3
    REF_CLK_FREQ       25.0
    MEM_CLK_FREQ       400.0
    MEM_CLK_FREQ_MAX   800.0
    MEM_VOLTAGE        {1.5V DDR3}
    MEM_DQ_WIDTH       32
    MEM_ROW_ADDR_WIDTH 15
    MEM_COL_ADDR_WIDTH 10
    MEM_BANKADDR_WIDTH 3
    MEM_TCL            11
    MEM_WTCL           8
    MEM_DRV_STR        RZQ/7
    MEM_RTT_NOM        RZQ/4
    MEM_RTT_WR         RZQ/4
    MEM_TINIT_US       500
    MEM_TMRD_CK        4
    MEM_TRAS_NS        35.0
    MEM_TRCD_NS        13.75
    MEM_TRP_NS         13.75
    MEM_TREFI_US       7.8
    MEM_TRFC_NS        260.0
    MEM_TWR_NS         15.0
    MEM_TWTR           4
    MEM_TFAW_NS        30.0
    MEM_TRRD_NS        7.5
    MEM_TRTP_NS        7.5
    TIMING_TIS         180
    TIMING_TIH         140
    TIMING_TDS         30
    TIMING_TDH         65
    TIMING_TDQSQ       125
    TIMING_TQH         0.38
    TIMING_TDQSCK      255
    TIMING_TDQSS       0.25
    TIMING_TQSH        0.4
    TIMING_TDSH        0.2
    TIMING_TDSS        0.2
    TIMING_BOARD_MAX_CK_DELAY        0.03
    TIMING_BOARD_MAX_DQS_DELAY       0.02
    TIMING_BOARD_SKEW_CKDQS_DIMM_MIN 0.09
    TIMING_BOARD_SKEW_CKDQS_DIMM_MAX 0.16
    TIMING_BOARD_SKEW_WITHIN_DQS     0.01
    TIMING_BOARD_SKEW_BETWEEN_DQS    0.08
    TIMING_BOARD_DQ_TO_DQS_SKEW      0.0
    TIMING_BOARD_AC_SKEW             0.03
    TIMING_BOARD_AC_TO_CK_SKEW       0.0
}
export memory conduit end hps.memory

# Clocks: 50 MHz from the board, and from it one for bus and rasterizer, one for VGA.

add_instance board_clock clock_source
set_parameters board_clock {
    clockFrequency        50000000.0
    clockFrequencyKnown   1
    resetSynchronousEdges NONE
}
export clk clock sink board_clock.clk_in
export reset reset sink board_clock.clk_in_reset

set frequencies [list bus_pll {Integer-N PLL} $bus_mhz vga_pll {Fractional-N PLL} 25.175]
foreach {pll mode megahertz} $frequencies {
    add_instance $pll altera_pll
    set_parameters $pll {
        gui_reference_clock_frequency 50.0
        gui_operation_mode            direct
        gui_number_of_clocks          1
        gui_use_locked                1
    }
    set_instance_parameter_value $pll gui_pll_mode $mode
    set_instance_parameter_value $pll gui_output_clock_frequency0 $megahertz
    add_connection board_clock.clk $pll.refclk
    add_connection board_clock.clk_reset $pll.reset
    export ${pll}_locked conduit end $pll.locked
}

add_instance vga_clock altera_clock_bridge
add_connection vga_pll.outclk0 vga_clock.in_clk
export vga_clk clock source vga_clock.out_clk

# Reset: while a PLL has not locked, and while the processor is in reset. A lock comes and goes at any time, so the
# bridge promises no edge; Platform Designer then synchronizes the release for each agent that asks for it.

add_instance lock altera_reset_bridge
set_parameters lock {
    ACTIVE_LOW_RESET  1
    SYNCHRONOUS_EDGES none
}
export lock reset sink lock.in_reset

# The rasterizer and the board's inputs and outputs.

add_instance halfspace halfspace
set_instance_parameter_value halfspace PixelUnits $pixel_units
add_connection vga_pll.outclk0 halfspace.vga_clock
export vga conduit end halfspace.vga

add_instance board_io board_io
export board conduit end board_io.pins

foreach instance {halfspace board_io} {
    add_connection bus_pll.outclk0 $instance.clock
    add_connection hps.h2f_reset $instance.reset
    add_connection lock.out_reset $instance.reset
}

# Bridges: registers on the lightweight one, the FIFO on the wide one. The wide one is 32 bits wide
# too: the FIFO agent takes whole words only, and a wider bridge would need an adapter that splits.

add_connection bus_pll.outclk0 hps.h2f_lw_axi_clock
add_connection bus_pll.outclk0 hps.h2f_axi_clock

proc attach {bridge agent address} {
    add_connection hps.$bridge $agent
    set_connection_parameter_value hps.$bridge/$agent baseAddress $address
}
attach h2f_lw_axi_master halfspace.registers 0x0000
attach h2f_lw_axi_master board_io.registers 0x2000
attach h2f_axi_master halfspace.fifo 0x0000

add_connection hps.f2h_irq0 halfspace.interrupt
set_connection_parameter_value hps.f2h_irq0/halfspace.interrupt irqNumber 0

# An access to an address where nothing is gets an error, not the nearest agent.
set_interconnect_requirement {$system} qsys_mm.insertDefaultSlave TRUE
set_interconnect_requirement {$system} qsys_mm.maxAdditionalLatency 2

save_system halfspace_system.qsys
