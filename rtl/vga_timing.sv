// VGA's raster: 640x480 at 59.94 Hz from 25.175 MHz (VESA DMT; 60 Hz at 25.2 MHz).
//
// `x_o`, `y_o` count the whole raster, 800 x 525, visible part first. Outputs are registered, but
// for the two counters' decodes, which the scan-out registers with its pixels.
//
// The swap window is the vertical blank without its last two lines, so that a swap in its last clock
// has crossed into this domain before `frame_start_o`, which falls into the blank's last line.
`default_nettype none

module vga_timing (
    input  logic       clk_i,
    input  logic       rst_ni,

    output logic [9:0] x_o,
    output logic [9:0] y_o,
    output logic       visible_o,
    output logic       hsync_no,
    output logic       vsync_no,
    output logic       frame_start_o,

    output logic       vertical_blank_o,  // a level from a flip-flop, to be synchronized
    output logic       swap_window_o      // likewise
);

  localparam logic [9:0] VisibleX = 10'd640;
  localparam logic [9:0] HsyncStart = 10'd656;
  localparam logic [9:0] HsyncEnd = 10'd752;
  localparam logic [9:0] TotalX = 10'd800;
  localparam logic [9:0] VisibleY = 10'd480;
  localparam logic [9:0] VsyncStart = 10'd490;
  localparam logic [9:0] VsyncEnd = 10'd492;
  localparam logic [9:0] TotalY = 10'd525;

  logic [9:0] x_q, x_d, y_q, y_d;
  logic vertical_blank_q, swap_window_q;

  always_comb begin
    x_d = x_q + 1'b1;
    y_d = y_q;
    if (x_q == TotalX - 1'b1) begin
      x_d = '0;
      y_d = (y_q == TotalY - 1'b1) ? '0 : y_q + 1'b1;
    end
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      x_q              <= '0;
      y_q              <= '0;
      vertical_blank_q <= 1'b0;
      swap_window_q    <= 1'b0;
    end else begin
      x_q              <= x_d;
      y_q              <= y_d;
      vertical_blank_q <= y_q >= VisibleY;
      swap_window_q    <= y_q >= VisibleY && y_q < TotalY - 10'd2;
    end
  end

  assign x_o              = x_q;
  assign y_o              = y_q;
  assign visible_o        = x_q < VisibleX && y_q < VisibleY;
  assign hsync_no         = !(x_q >= HsyncStart && x_q < HsyncEnd);
  assign vsync_no         = !(y_q >= VsyncStart && y_q < VsyncEnd);
  assign frame_start_o    = x_q == '0 && y_q == TotalY - 1'b1;
  assign vertical_blank_o = vertical_blank_q;
  assign swap_window_o    = swap_window_q;

endmodule

`default_nettype wire
