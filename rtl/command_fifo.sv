// The command FIFO: words in, words out, first come first.
//
// Handshake: a word moves in a clock where valid and ready are both 1. `word_o` shows the oldest
// word (show-ahead). Latency from push to show: 2 clocks. Throughput: a word in and a word out
// every clock. `clear_i` empties it; a push in
// the same clock is lost (the agent in front of it makes none).
// Constraint: Depth is a power of two, at least 4.
`default_nettype none

module command_fifo #(
    parameter int unsigned Depth = 1024
) (
    input  logic                   clk_i,
    input  logic                   rst_ni,
    input  logic                   clear_i,

    input  logic                   valid_i,
    output logic                   ready_o,
    input  logic [31:0]            word_i,

    output logic                   valid_o,
    input  logic                   ready_i,
    output logic [31:0]            word_o,

    output logic [$clog2(Depth):0] level_o
);

  localparam int unsigned AddressWidth = $clog2(Depth);
  localparam int unsigned LevelWidth = AddressWidth + 1;

  // One bit more than an address, so that full and empty differ.
  logic [LevelWidth-1:0] write_q, write_d, read_q, read_d;
  logic                  valid_q, valid_d;
  logic                  push, pop;

  assign level_o = write_q - read_q;
  assign ready_o = level_o != LevelWidth'(Depth);
  assign valid_o = valid_q;
  assign push    = valid_i && ready_o;
  assign pop     = valid_o && ready_i;

  always_comb begin
    write_d = write_q + LevelWidth'(push);
    read_d  = read_q + LevelWidth'(pop);
    // The word that is pushed now can be read from the next clock on.
    valid_d = read_d != write_q;
    if (clear_i) begin
      write_d = '0;
      read_d  = '0;
      valid_d = 1'b0;
    end
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      write_q <= '0;
      read_q  <= '0;
      valid_q <= 1'b0;
    end else begin
      write_q <= write_d;
      read_q  <= read_d;
      valid_q <= valid_d;
    end
  end

  ram_1w1r #(
      .Width(32),
      .Depth(Depth)
  ) u_words (
      .write_clk_i    (clk_i),
      .write_i        (push),
      .write_address_i(write_q[AddressWidth-1:0]),
      .write_data_i   (word_i),
      .read_clk_i     (clk_i),
      .read_address_i (read_d[AddressWidth-1:0]),
      .read_data_o    (word_o)
  );

`ifndef SYNTHESIS
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      assert (level_o <= LevelWidth'(Depth)) else $error("level above depth");
      assert (!(valid_o && level_o == '0)) else $error("a word shown by an empty FIFO");
    end
  end
`endif

endmodule

`default_nettype wire
