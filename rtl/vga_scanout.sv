// Reads the front buffer in step with VGA's raster, every pixel twice and every row twice.
//
// Pipeline on VGA's clock, with syncs and blank delayed alike: counters; index of the tile and
// number of its pixel unit; memory (latency 1); colour; pins. The front buffer is looked at once a
// frame, in the blank's last line, so no frame shows two.
// `test_pattern_i` shows bars, steps and a frame instead, and needs no software.
`default_nettype none

module vga_scanout #(
    parameter int unsigned PixelUnits = 8,
    // Follows from the others; never given.
    parameter int unsigned IndexWidth = $clog2(halfspace_pkg::Width * halfspace_pkg::Height / PixelUnits)
) (
    input  logic                       clk_i,
    input  logic                       rst_ni,

    input  logic                       front_i,  // synchronized
    input  logic                       test_pattern_i,  // synchronized

    output logic [IndexWidth-1:0]      index_o,
    output logic                       buffer_o,
    input  logic [PixelUnits-1:0][7:0] colour_i,

    output logic                       vertical_blank_o,
    output logic                       swap_window_o,

    output logic [7:0]                 red_o,
    output logic [7:0]                 green_o,
    output logic [7:0]                 blue_o,
    output logic                       hsync_no,
    output logic                       vsync_no,
    output logic                       blank_no
);

  import halfspace_pkg::*;
  import raster_pkg::*;

  localparam int unsigned TileWidth = tile_width(PixelUnits);
  localparam int unsigned TileHeight = tile_height(PixelUnits);
  localparam int unsigned ColumnShift = 1 + $clog2(TileWidth);  // from VGA's pixels to tiles
  localparam logic [9:0] LastLineOfTile = 10'(2 * TileHeight - 1);
  localparam int unsigned UnitWidth = (PixelUnits > 1) ? $clog2(PixelUnits) : 1;

  typedef struct packed {
    logic visible;
    logic hsync_n;
    logic vsync_n;
  } sync_t;

  logic [9:0] x, y;
  sync_t sync0, sync1_q, sync2_q, sync3_q;
  logic frame_start;
  logic front_q;

  logic [IndexWidth-1:0] row_index_q, row_index_d, index1_q;
  logic [UnitWidth-1:0] unit, unit1_q, unit2_q;
  logic [7:0] pattern, pattern1_q, pattern2_q;
  logic [7:0] colour;
  logic [7:0] red_q, green_q, blue_q;

  vga_timing u_timing (
      .clk_i,
      .rst_ni,
      .x_o          (x),
      .y_o          (y),
      .visible_o    (sync0.visible),
      .hsync_no     (sync0.hsync_n),
      .vsync_no     (sync0.vsync_n),
      .frame_start_o(frame_start),
      .vertical_blank_o,
      .swap_window_o
  );

  // The index of a row's first tile, moved on in the horizontal blank.
  always_comb begin
    row_index_d = row_index_q;
    if (frame_start) row_index_d = '0;
    else if (x == 10'(2 * Width) && y < 10'(2 * Height) && (y & LastLineOfTile) == LastLineOfTile) begin
      row_index_d = row_index_q + IndexWidth'(Width / TileWidth);
    end
  end

  assign unit = UnitWidth'((x >> 1) % 10'(TileWidth)) +
                UnitWidth'(((y >> 1) % 10'(TileHeight)) * 10'(TileWidth));

  // Eight bars with full and half colours above, every colour in turn below, a white frame around.
  always_comb begin
    if (y < 10'd320) pattern = {{3{x[8]}}, {3{x[7]}}, {2{x[6]}}};
    else pattern = {y[6:4], x[8:4]};
    if (x < 10'd2 || x >= 10'(2 * Width - 2) || y < 10'd2 || y >= 10'(2 * Height - 2)) pattern = '1;
  end

  assign index_o  = index1_q;
  assign buffer_o = front_q;
  assign colour   = test_pattern_i ? pattern2_q : colour_i[unit2_q];

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      front_q     <= 1'b0;
      row_index_q <= '0;
      sync1_q     <= '{visible: 1'b0, hsync_n: 1'b1, vsync_n: 1'b1};
      sync2_q     <= '{visible: 1'b0, hsync_n: 1'b1, vsync_n: 1'b1};
      sync3_q     <= '{visible: 1'b0, hsync_n: 1'b1, vsync_n: 1'b1};
    end else begin
      if (frame_start) front_q <= front_i;
      row_index_q <= row_index_d;
      sync1_q     <= sync0;
      sync2_q     <= sync1_q;
      sync3_q     <= sync2_q;
    end
  end

  always_ff @(posedge clk_i) begin
    index1_q   <= row_index_q + (IndexWidth'(x) >> ColumnShift);
    unit1_q    <= unit;
    unit2_q    <= unit1_q;
    pattern1_q <= pattern;
    pattern2_q <= pattern1_q;
    // Full scale is 255 in every channel, by repeating bits.
    red_q      <= sync2_q.visible ? {colour[7:5], colour[7:5], colour[7:6]} : '0;
    green_q    <= sync2_q.visible ? {colour[4:2], colour[4:2], colour[4:3]} : '0;
    blue_q     <= sync2_q.visible ? {4{colour[1:0]}} : '0;
  end

  assign red_o    = red_q;
  assign green_o  = green_q;
  assign blue_o   = blue_q;
  assign hsync_no = sync3_q.hsync_n;
  assign vsync_no = sync3_q.vsync_n;
  assign blank_no = sync3_q.visible;

endmodule

`default_nettype wire
