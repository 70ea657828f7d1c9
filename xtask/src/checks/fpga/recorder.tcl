# Runs a script of Quartus in a plain Tcl interpreter and writes down what it asks Quartus for.
#
#   tclsh recorder.tcl KIND SCRIPT [SETTINGS]
#
# KIND says whose script it is; a command that neither that tool nor Tcl has is an error. Each call goes
# to standard output as fields (file, line, command, arguments) that end in 0x1f, and ends in 0x1e.

lassign $argv kind script settings
set recorder [file normalize [info script]]

set commands(system) {
    create_system set_project_property add_instance set_instance_parameter_value add_interface
    set_interface_property add_connection set_connection_parameter_value set_interconnect_requirement save_system
}
set commands(component) {
    set_module_property add_fileset set_fileset_property add_fileset_file add_parameter set_parameter_property
    add_interface set_interface_property add_interface_port
}
set commands(project) {
    project_new set_global_assignment set_location_assignment set_instance_assignment export_assignments project_close
}
set commands(timing) {
    create_clock create_generated_clock derive_pll_clocks derive_clock_uncertainty set_false_path set_multicycle_path
    set_clock_groups set_input_delay set_output_delay get_ports get_pins get_registers get_clocks post_message
}

package provide qsys 16.0
package provide ::quartus::project 1.0
fconfigure stdout -encoding utf-8 -translation lf

# Returns file and line of a call: of the file that has it, the place where that file's own code began.
proc place {} {
    set here [list "" 0]
    for {set level [expr {[info frame] - 1}]} {$level > 0} {incr level -1} {
        set frame [info frame $level]
        if {![dict exists $frame file] || [dict get $frame file] eq $::recorder} {
            continue
        }
        if {[lindex $here 0] ni [list "" [dict get $frame file]]} {
            break
        }
        set here [list [dict get $frame file] [dict get $frame line]]
    }
    return $here
}

proc record {name arguments} {
    foreach field [concat [place] [list $name] $arguments] {
        puts -nonewline "$field\x1f"
    }
    puts -nonewline "\x1e"
    # What a query gives is handed to other commands: here, the query itself.
    return [concat $name $arguments]
}

foreach name $commands($kind) {
    proc $name {args} "record $name \$args"
}
if {$kind eq "timing"} {
    proc get_collection_size {collection} {
        return 1
    }
}
if {$kind eq "component"} {
    proc get_module_property {name} {
        return [file dirname $::script]
    }
}
proc unknown {name args} {
    error "$name is neither a command of Tcl nor one that a $::kind script of Quartus has"
}

foreach {name value} $settings {
    set $name $value
}
if {[catch {
    source $script
    if {$kind eq "component"} {
        # The sources come when Platform Designer asks for them.
        add_sources top
    }
} message options]} {
    set trace [dict get $options -errorinfo]
    if {![regexp {\(file "([^"]+)" line (\d+)\)} $trace -> file line]} {
        set file $script
        set line 0
    }
    puts stderr "$file:$line: $message"
    exit 1
}
