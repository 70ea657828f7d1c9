// Carries single, independent levels into another clock domain through two flip-flops.
//
// A level must come from a flip-flop of its own domain, and last longer than a period of `clk_i`
// to be seen for certain. Latency 1 to 2 clocks. Bits of one bus may arrive in different clocks.
// Constraint for timing analysis: false path to `first_q`. The attribute has Quartus know the two for a
// synchronizer: placed together, never duplicated or retimed, with metastability reported.
`default_nettype none

module synchronizer #(
    parameter int unsigned Width = 1
) (
    input  logic             clk_i,
    input  logic             rst_ni,
    input  logic [Width-1:0] level_i,
    output logic [Width-1:0] level_o
);

  (* altera_attribute = "-name SYNCHRONIZER_IDENTIFICATION FORCED" *)
  logic [Width-1:0] first_q, second_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      first_q  <= '0;
      second_q <= '0;
    end else begin
      first_q  <= level_i;
      second_q <= first_q;
    end
  end

  assign level_o = second_q;

endmodule

`default_nettype wire
