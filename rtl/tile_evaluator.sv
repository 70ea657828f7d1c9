// Tiles in, covered pixels with their depths and colours out: two pipeline stages, never held back.
//
// Stage 1 takes each edge from its largest value in the tile back to the tile's upper left pixel,
// and works out what every pixel adds to it. Stage 2 adds: a pixel is covered where it lies in the
// box and all three sums are 0 or more. All modulo 2^32, colours modulo 2^21. Latency 2 clocks.
`default_nettype none

module tile_evaluator #(
    parameter int unsigned PixelUnits = 8
) (
    input  logic                                 clk_i,
    input  logic                                 rst_ni,
    input  logic                                 clear_i,

    input  logic                                 valid_i,
    input  raster_pkg::tile_t                    tile_i,
    input  raster_pkg::constants_t               constants_i,

    output logic [PixelUnits-1:0]                covered_o,
    output raster_pkg::value_t [PixelUnits-1:0]  depth_o,
    output raster_pkg::index_t                   index_o,
    output raster_pkg::wholes_t [PixelUnits-1:0] plane_o,      // the colour of shaded pixels
    output logic [PixelUnits-1:0][3:0]           threshold_o,  // its dither
    output logic [7:0]                           colour_o,
    output raster_pkg::pixel_mode_t              mode_o,       // which colour is meant, and more

    output logic                                 idle_o
);

  import halfspace_pkg::*;
  import raster_pkg::*;

  localparam int unsigned TileWidth = tile_width(PixelUnits);
  localparam int unsigned TileHeight = tile_height(PixelUnits);

  typedef logic signed [20:0] offset_t;  // up to three steps in x and one in y

  // Stage 1.
  logic valid1_q;
  value_t [Edges-1:0] origin_q, origin_d;
  offset_t [PixelUnits-1:0][Edges-1:0] offset_q, offset_d;
  value_t [PixelUnits-1:0] depth_offset_q, depth_offset_d;
  value_t depth_origin_q;
  logic [PixelUnits-1:0] in_box_q, in_box_d;
  index_t index1_q;
  channels_t plane_origin_q;
  channels_t [PixelUnits-1:0] plane_offset_q, plane_offset_d;
  logic [1:0] column1_q, row1_q;
  logic [7:0] colour1_q;
  pixel_mode_t mode1_q;

  // Stage 2.
  logic [PixelUnits-1:0] covered_q, covered_d;
  value_t [PixelUnits-1:0] depth_q, depth_d;
  index_t index2_q;
  wholes_t [PixelUnits-1:0] plane_q, plane_d;
  logic [PixelUnits-1:0][3:0] threshold_q, threshold_d;
  logic [7:0] colour2_q;
  pixel_mode_t mode2_q;

  always_comb begin
    for (int unsigned i = 0; i < Edges; i++) begin
      origin_d[i] = tile_i.place.largest[i] - constants_i.reach[i];
    end
    for (int unsigned k = 0; k < PixelUnits; k++) begin
      automatic logic [1:0] x = 2'(k % TileWidth);
      automatic logic y = 1'(k / TileWidth);
      for (int unsigned i = 0; i < Edges; i++) begin
        offset_d[k][i] = (x[0] ? offset_t'(constants_i.step_x[i]) : '0) +
                         (x[1] ? offset_t'(constants_i.step_x[i]) <<< 1 : '0) +
                         (y ? offset_t'(constants_i.step_y[i]) : '0);
      end
      depth_offset_d[k] = (x[0] ? constants_i.depth_step_x : '0) +
                          (x[1] ? constants_i.depth_step_x <<< 1 : '0) +
                          (y ? constants_i.depth_step_y : '0);
      plane_offset_d[k] = sum(channels_times(constants_i.plane_step_x, x),
                              y ? constants_i.plane_step_y : '0);
      in_box_d[k] = !(tile_i.at_left && x < constants_i.left) &&
                    !(tile_i.at_right && x > constants_i.right) &&
                    !(tile_i.at_top && y < constants_i.top) &&
                    !(tile_i.at_bottom && y > constants_i.bottom);
    end
  end

  always_comb begin
    for (int unsigned k = 0; k < PixelUnits; k++) begin
      covered_d[k] = in_box_q[k];
      for (int unsigned i = 0; i < Edges; i++) begin
        automatic value_t value = origin_q[i] + value_t'(offset_q[k][i]);
        if (value < 0) covered_d[k] = 1'b0;
      end
      depth_d[k] = depth_origin_q + depth_offset_q[k];
    end
  end

  always_comb begin
    for (int unsigned k = 0; k < PixelUnits; k++) begin
      automatic channels_t plane = sum(plane_origin_q, plane_offset_q[k]);
      automatic logic [1:0] x = 2'(column1_q * TileWidth + (k % TileWidth));
      automatic logic [1:0] y = 2'(row1_q * TileHeight + (k / TileWidth));
      plane_d[k] = '{
          red: plane.red[ChannelBits-1:ColourFractionBits],
          green: plane.green[ChannelBits-1:ColourFractionBits],
          blue: plane.blue[ChannelBits-1:ColourFractionBits]
      };
      threshold_d[k] = Dither[{y, x}];
    end
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      valid1_q  <= 1'b0;
      covered_q <= '0;
    end else begin
      valid1_q  <= valid_i && !clear_i;
      covered_q <= (valid1_q && !clear_i) ? covered_d : '0;
    end
  end

  always_ff @(posedge clk_i) begin
    origin_q       <= origin_d;
    offset_q       <= offset_d;
    depth_offset_q <= depth_offset_d;
    depth_origin_q <= tile_i.place.depth;
    in_box_q       <= in_box_d;
    index1_q       <= tile_i.place.index;
    plane_origin_q <= tile_i.place.plane;
    plane_offset_q <= plane_offset_d;
    column1_q      <= tile_i.place.column[1:0];
    row1_q         <= tile_i.place.row;
    colour1_q      <= constants_i.colour;
    mode1_q        <= constants_i.mode;

    depth_q       <= depth_d;
    index2_q      <= index1_q;
    plane_q       <= plane_d;
    threshold_q   <= threshold_d;
    colour2_q     <= colour1_q;
    mode2_q       <= mode1_q;
  end

  assign covered_o    = covered_q;
  assign depth_o      = depth_q;
  assign index_o      = index2_q;
  assign plane_o      = plane_q;
  assign threshold_o  = threshold_q;
  assign colour_o     = colour2_q;
  assign mode_o       = mode2_q;
  assign idle_o       = !valid1_q && covered_q == '0;

endmodule

`default_nettype wire
