// What waits for the picture to be complete: swaps and fences, and which buffer is in front.
//
// A fence is passed when everything before it is in memory (`drained_i`). A swap too, and it waits
// for VGA's swap window besides, which is the vertical blank but for its last lines. One swap a
// blank: a second waits for the next, so every frame that is counted was shown.
// `front_o` changes in the clock after `swapped_o`.
`default_nettype none

module buffer_control (
    input  logic        clk_i,
    input  logic        rst_ni,
    input  logic        clear_i,        // forgets a waiting packet; the front buffer stays

    input  logic        drained_i,
    input  logic        swap_window_i,  // synchronized

    input  logic        swap_valid_i,
    output logic        swap_ready_o,
    input  logic        fence_valid_i,
    output logic        fence_ready_o,
    input  logic [31:0] fence_tag_i,

    output logic        front_o,
    output logic        swapped_o,
    output logic        fenced_o,
    output logic [31:0] fence_o
);

  logic front_q, front_d, window_used_q, window_used_d;
  logic [31:0] fence_q, fence_d;

  assign swap_ready_o  = drained_i && swap_window_i && !window_used_q;
  assign fence_ready_o = drained_i;
  assign swapped_o     = swap_valid_i && swap_ready_o && !clear_i;
  assign fenced_o      = fence_valid_i && fence_ready_o && !clear_i;
  assign front_o       = front_q;
  assign fence_o       = fence_q;

  always_comb begin
    front_d       = front_q ^ swapped_o;
    window_used_d = swap_window_i && (window_used_q || swapped_o);
    fence_d       = fenced_o ? fence_tag_i : fence_q;
    if (clear_i) fence_d = '0;
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      front_q       <= 1'b0;
      window_used_q <= 1'b0;
      fence_q       <= '0;
    end else begin
      front_q       <= front_d;
      window_used_q <= window_used_d;
      fence_q       <= fence_d;
    end
  end

endmodule

`default_nettype wire
