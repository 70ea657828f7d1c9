// The FIFO's aperture on the bus: writes of Avalon-MM, 32 bits, any address pushes. Reads are not its matter
// (`halfspace` answers 0) and never wait: waitrequest is for writes alone.
//
// A word that comes in the clock of a reset waits for the next, so that it is not lost with those before.
// While the FIFO is full and the device enabled, waitrequest holds the bus: the FIFO will drain.
// So that a write can never hang the processor for ever, a word is dropped, flagged by a clock of
// `overflow_o`, instead of held
//  - when the FIFO is full and the device disabled;
//  - when it has been held for `Patience` clocks (longer than any packet takes, a swap included),
//    and from then on every word that finds the FIFO full, until it has been seen with space.
`default_nettype none

module fifo_agent #(
    parameter int unsigned Patience = 1 << 22
) (
    input  logic        clk_i,
    input  logic        rst_ni,
    input  logic        clear_i,
    input  logic        enable_i,

    input  logic        write_i,
    input  logic [31:0] writedata_i,
    output logic        waitrequest_o,

    output logic        valid_o,
    input  logic        ready_i,
    output logic [31:0] word_o,

    output logic        overflow_o
);

  localparam int unsigned HeldWidth = $clog2(Patience + 1);

  // Stays at Patience, and so impatient, while the FIFO stays full.
  logic [HeldWidth-1:0] held_q, held_d;
  logic impatient;

  assign impatient     = held_q == HeldWidth'(Patience);
  assign valid_o       = write_i && !clear_i;
  assign word_o        = writedata_i;
  assign waitrequest_o = write_i && (clear_i || (!ready_i && enable_i && !impatient));
  assign overflow_o    = write_i && !ready_i && !waitrequest_o;

  always_comb begin
    held_d = held_q;
    if (ready_i || clear_i) held_d = '0;
    else if (waitrequest_o) held_d = held_q + 1'b1;
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      held_q <= '0;
    end else begin
      held_q <= held_d;
    end
  end

endmodule

`default_nettype wire
