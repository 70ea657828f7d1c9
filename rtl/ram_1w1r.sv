// Memory with one write port and one read port, each with its own clock, that infers as M10K.
//
// Read latency 1. A read of the word that is written at the same edge returns an unspecified
// value: callers on one clock forward the write themselves. Contents start unspecified (an FPGA's
// configuration makes them 0). An address past the end writes nothing and reads an unspecified value.
// The attribute is Quartus's: without `no_rw_check` it adds logic where both ports have one clock.
`default_nettype none

module ram_1w1r #(
    parameter int unsigned Width = 8,
    parameter int unsigned Depth = 1024
) (
    input  logic                     write_clk_i,
    input  logic                     write_i,
    input  logic [$clog2(Depth)-1:0] write_address_i,
    input  logic [Width-1:0]         write_data_i,

    input  logic                     read_clk_i,
    input  logic [$clog2(Depth)-1:0] read_address_i,
    output logic [Width-1:0]         read_data_o
);

  (* ramstyle = "M10K, no_rw_check" *) logic [Width-1:0] mem[Depth];

  always_ff @(posedge write_clk_i) begin
    if (write_i) mem[write_address_i] <= write_data_i;
  end

  always_ff @(posedge read_clk_i) begin
    read_data_o <= mem[read_address_i];
  end

endmodule

`default_nettype wire
