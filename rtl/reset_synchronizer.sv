// A reset that begins at once and ends with the clock: asynchronous assertion, synchronous release.
`default_nettype none

module reset_synchronizer (
    input  logic clk_i,
    input  logic rst_ni,
    output logic rst_no
);

  logic first_q, second_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      first_q  <= 1'b0;
      second_q <= 1'b0;
    end else begin
      first_q  <= 1'b1;
      second_q <= first_q;
    end
  end

  assign rst_no = second_q;

endmodule

`default_nettype wire
