// Proves `command_fifo`: the n-th word that comes out is the n-th that went in, for every n.
//
// Words are counted modulo 2^32 on both sides. `number_q` is any number; `word_q` remembers the word
// of that number. So nothing is doubled, put out of order or made up, at any level; and nothing is
// lost or kept back, because the oldest word shows as soon as it has been in for a clock.
`default_nettype none

module command_fifo_proof #(
    parameter int unsigned Depth = 1024,
    localparam int unsigned LevelWidth = $clog2(Depth) + 1,
    localparam int unsigned AddressWidth = $clog2(Depth)
) (
    input logic        clk_i,
    input logic        rst_ni,
    input logic        clear_i,
    input logic        valid_i,
    input logic [31:0] word_i,
    input logic        ready_i
);

  logic ready, valid;
  logic [31:0] word;
  logic [LevelWidth-1:0] level;

  command_fifo #(
      .Depth(Depth)
  ) u_fifo (
      .clk_i,
      .rst_ni,
      .clear_i,
      .valid_i,
      .ready_o(ready),
      .word_i,
      .valid_o(valid),
      .ready_i,
      .word_o (word),
      .level_o(level)
  );

  logic [31:0] number_q;  // never set, never changed: any value
  logic [31:0] word_q;
  logic [31:0] in_q, out_q;  // words that have gone in and come out
  logic [31:0] in_before_q;  // words that had gone in a clock ago
  logic started_q;

  always_ff @(posedge clk_i) begin
    number_q <= number_q;
    if (valid_i && ready && in_q == number_q) word_q <= word_i;
  end

  initial started_q = 1'b0;
  always_ff @(posedge clk_i) begin
    started_q <= 1'b1;
    if (!started_q) assume (!rst_ni);
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      in_q        <= '0;
      out_q       <= '0;
      in_before_q <= '0;
    end else if (clear_i) begin
      in_q        <= '0;
      out_q       <= '0;
      in_before_q <= '0;
    end else begin
      in_before_q <= in_q;
      in_q  <= in_q + 32'(valid_i && ready);
      out_q <= out_q + 32'(valid && ready_i);
    end
  end

  logic held;
  assign held = number_q - out_q < in_q - out_q;

  always_ff @(posedge clk_i) begin
    if (rst_ni && started_q) begin
      assert (32'(level) == in_q - out_q);
      assert (32'(level) <= Depth);
      assert (ready == (32'(level) < Depth));
      assert (valid == (out_q != in_before_q));
      if (valid && ready_i && out_q == number_q) assert (word == word_q);
      // invariants
      assert (in_q - in_before_q <= 32'd1 && in_before_q - out_q <= Depth);
      assert (u_fifo.write_q == LevelWidth'(in_q));
      assert (u_fifo.read_q == LevelWidth'(out_q));
      if (held) assert (u_fifo.u_words.mem[number_q[AddressWidth-1:0]] == word_q);
      if (valid && number_q == out_q) assert (word == word_q);
      // What must be possible.
      if (valid && ready_i && out_q == number_q && number_q == 32'd2) cover (1'b1);
    end
  end

endmodule

`default_nettype wire
