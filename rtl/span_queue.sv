// Two places for starts of rows between the walker, which runs ahead, and the scanner.
//
// Handshake: valid/ready on both sides; latency 1; a start in and a start out every clock.
// `handed_on_o` is 1 when no start with `first` is inside, nor stays inside after this clock.
`default_nettype none

module span_queue (
    input  logic                    clk_i,
    input  logic                    rst_ni,
    input  logic                    clear_i,

    input  logic                    valid_i,
    output logic                    ready_o,
    input  raster_pkg::span_start_t start_i,

    output logic                    valid_o,
    input  logic                    ready_i,
    output raster_pkg::span_start_t start_o,

    output logic                    handed_on_o,
    output logic                    idle_o
);

  import raster_pkg::*;

  span_start_t [1:0] starts_q;
  logic [1:0] valid_q, valid_d;
  logic push, pop;

  // Does not look at ready_i: with two places that costs no throughput, and cuts the path back.
  assign ready_o = !valid_q[1];
  assign valid_o = valid_q[0];
  assign start_o = starts_q[0];
  assign push    = valid_i && ready_o;
  assign pop     = valid_o && ready_i;
  assign idle_o  = valid_q == '0;
  // A start with `first` can only be followed by starts of the same primitive.
  assign handed_on_o = !(valid_q[0] && starts_q[0].first && !pop) && !(valid_q[1] && starts_q[1].first);

  always_comb begin
    valid_d = valid_q;
    if (pop) valid_d = {1'b0, valid_q[1]};
    if (push) valid_d = {valid_d[0], 1'b1};
    if (clear_i) valid_d = '0;
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      valid_q <= '0;
    end else begin
      valid_q <= valid_d;
    end
  end

  always_ff @(posedge clk_i) begin
    if (pop) starts_q[0] <= starts_q[1];
    if (push) begin
      if (!valid_q[0] || pop) starts_q[0] <= start_i;
      else starts_q[1] <= start_i;
    end
  end

`ifndef SYNTHESIS
  always_ff @(posedge clk_i) begin
    if (rst_ni) assert (valid_q != 2'b10) else $error("a hole in the queue");
  end
`endif

endmodule

`default_nettype wire
