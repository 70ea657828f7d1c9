# Makes the Quartus project in the current folder, from nothing: quartus_sh -t ../project.tcl
#
# The Platform Designer system has been generated there before.

package require ::quartus::project

set here [file dirname [info script]]

project_new -overwrite de1_soc

set_global_assignment -name FAMILY "Cyclone V"
set_global_assignment -name DEVICE 5CSEMA5F31C6
set_global_assignment -name TOP_LEVEL_ENTITY de1_soc
set_global_assignment -name PROJECT_OUTPUT_DIRECTORY output_files
set_global_assignment -name NUM_PARALLEL_PROCESSORS ALL
set_global_assignment -name OPTIMIZATION_MODE "HIGH PERFORMANCE EFFORT"
set_global_assignment -name RESERVE_ALL_UNUSED_PINS_WEAK_PULLUP "AS INPUT TRI-STATED WITH WEAK PULL-UP"

# Leaves the simulation's assertions out.
set_global_assignment -name VERILOG_MACRO "SYNTHESIS=1"

set_global_assignment -name QIP_FILE halfspace_system/synthesis/halfspace_system.qip
set_global_assignment -name SYSTEMVERILOG_FILE [file join $here de1_soc.sv]
set_global_assignment -name SDC_FILE [file join $here de1_soc.sdc]

source [file join $here pins.tcl]

export_assignments
project_close
