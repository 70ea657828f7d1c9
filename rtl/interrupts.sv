// ERRORS and INTERRUPTS: set by events, cleared by writing ones, and the interrupt line.
//
// An event in the clock of a clearing write wins. The line is a level: some bit of INTERRUPTS is
// set and CONTROL enables its interrupt. INTERRUPTS.error is raised by every event, even if the
// flag in ERRORS is set already.
`default_nettype none

module interrupts #(
    parameter int unsigned LevelWidth = 11
) (
    input  logic                       clk_i,
    input  logic                       rst_ni,
    input  logic                       clear_i,

    input  logic [LevelWidth-1:0]      level_i,  // of the FIFO
    input  logic [31:0]                low_water_i,
    input  logic                       swapped_i,
    input  logic                       fenced_i,
    input  logic                       bad_packet_i,
    input  logic                       overflow_i,

    input  logic [3:0]                 clear_interrupts_i,
    input  logic [1:0]                 clear_errors_i,
    input  logic [3:0]                 enable_i,  // in the order of INTERRUPTS

    output halfspace_pkg::interrupts_t interrupts_o,
    output halfspace_pkg::errors_t     errors_o,
    output logic                       irq_o
);

  import halfspace_pkg::*;

  logic [3:0] interrupts_q, interrupts_d;
  logic [1:0] errors_q, errors_d;
  logic [LevelWidth-1:0] level_q;  // a clock ago
  logic fell, irq_q;

  // Both sides are held against the same mark: one that is moved above the level is no fall.
  assign fell = 32'(level_q) > low_water_i && 32'(level_i) <= low_water_i;

  always_comb begin
    interrupts_t raised;
    errors_t failed;
    raised              = '0;
    raised.low_water    = fell;
    raised.swap         = swapped_i;
    raised.fence        = fenced_i;
    raised.error        = bad_packet_i || overflow_i;
    failed              = '0;
    failed.bad_packet   = bad_packet_i;
    failed.fifo_overflow = overflow_i;
    interrupts_d = (interrupts_q & ~clear_interrupts_i) | 4'(raised);
    errors_d     = (errors_q & ~clear_errors_i) | 2'(failed);
    if (clear_i) begin
      interrupts_d = '0;
      errors_d     = '0;
    end
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      interrupts_q <= '0;
      errors_q     <= '0;
      level_q      <= '0;
      irq_q        <= 1'b0;
    end else begin
      interrupts_q <= interrupts_d;
      errors_q     <= errors_d;
      level_q      <= clear_i ? '0 : level_i;
      irq_q        <= (interrupts_q & enable_i) != '0;
    end
  end

  assign interrupts_o = interrupts_t'(32'(interrupts_q));
  assign errors_o     = errors_t'(32'(errors_q));
  assign irq_o        = irq_q;

endmodule

`default_nettype wire
