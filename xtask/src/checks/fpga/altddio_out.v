// Intel's output register for both clock edges, as far as a lint needs it: parameters and ports.
/* verilator lint_off DECLFILENAME */
/* verilator lint_off UNUSEDPARAM */
/* verilator lint_off UNUSEDSIGNAL */
module altddio_out #(
    parameter width = 1,
    parameter power_up_high = "OFF",
    parameter oe_reg = "UNUSED",
    parameter extend_oe_disable = "UNUSED",
    parameter intended_device_family = "Cyclone V",
    parameter invert_output = "OFF",
    parameter lpm_type = "altddio_out",
    parameter lpm_hint = "UNUSED"
) (
    input  wire [width-1:0] datain_h,
    input  wire [width-1:0] datain_l,
    input  wire             outclock,
    input  wire             outclocken,
    input  wire             aset,
    input  wire             aclr,
    input  wire             sset,
    input  wire             sclr,
    input  wire             oe,
    output wire [width-1:0] dataout,
    output wire [width-1:0] oe_out
);
  assign dataout = outclock ? datain_h : datain_l;
  assign oe_out  = {width{oe}};
endmodule
