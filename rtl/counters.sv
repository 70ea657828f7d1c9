// Counters of what has happened since reset; each wraps.
`default_nettype none

module counters #(
    parameter int unsigned PixelUnits = 8
) (
    input  logic clk_i,
    input  logic rst_ni,
    input  logic clear_i,

    input  logic                  triangle_i,
    input  logic [PixelUnits-1:0] tested_i,
    input  logic [PixelUnits-1:0] written_i,
    input  logic                  busy_i,
    input  logic                  stalled_i,
    input  logic                  swapped_i,
    input  logic                  bad_packet_i,

    output logic [31:0] triangles_o,
    output logic [31:0] pixels_tested_o,
    output logic [31:0] pixels_written_o,
    output logic [31:0] busy_cycles_o,
    output logic [31:0] stalled_cycles_o,
    output logic [31:0] frames_shown_o,
    output logic [31:0] bad_packets_o,

    // A pixel count stands in the first of the two stages.
    output logic idle_o
);

  localparam int unsigned CountWidth = $clog2(PixelUnits + 1);

  logic [CountWidth-1:0] tested_q, tested_d, written_q, written_d;

  always_comb begin
    tested_d  = '0;
    written_d = '0;
    for (int unsigned k = 0; k < PixelUnits; k++) begin
      tested_d  = tested_d + CountWidth'(tested_i[k]);
      written_d = written_d + CountWidth'(written_i[k]);
    end
  end

  assign idle_o = tested_q == '0;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      tested_q         <= '0;
      written_q        <= '0;
      triangles_o      <= '0;
      pixels_tested_o  <= '0;
      pixels_written_o <= '0;
      busy_cycles_o    <= '0;
      stalled_cycles_o <= '0;
      frames_shown_o   <= '0;
      bad_packets_o    <= '0;
    end else if (clear_i) begin
      tested_q         <= '0;
      written_q        <= '0;
      triangles_o      <= '0;
      pixels_tested_o  <= '0;
      pixels_written_o <= '0;
      busy_cycles_o    <= '0;
      stalled_cycles_o <= '0;
      frames_shown_o   <= '0;
      bad_packets_o    <= '0;
    end else begin
      tested_q         <= tested_d;
      written_q        <= written_d;
      triangles_o      <= triangles_o + 32'(triangle_i);
      pixels_tested_o  <= pixels_tested_o + 32'(tested_q);
      pixels_written_o <= pixels_written_o + 32'(written_q);
      busy_cycles_o    <= busy_cycles_o + 32'(busy_i);
      stalled_cycles_o <= stalled_cycles_o + 32'(stalled_i);
      frames_shown_o   <= frames_shown_o + 32'(swapped_i);
      bad_packets_o    <= bad_packets_o + 32'(bad_packet_i);
    end
  end

endmodule

`default_nettype wire
