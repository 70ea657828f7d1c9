// Walks down a primitive's left side: finds, row by row, the first tile that may be covered.
//
// Handshake: valid/ready on both sides; a primitive is taken when the one before is finished and
// its constants have been handed on (`handed_on_i`: no start with `first` is on its way).
// `constants_o` belongs to the starts that are offered, and holds until the first has been taken.
// Time: a clock a tile row, and one for each tile that the row's first tile lies away from the
// previous row's. So it keeps ahead of the scanner behind it, which needs a clock for every tile.
//
// The rule needs no memory. With `largest` the edge's largest value in a tile:
//  - left_out:  an edge is negative and does not fall to the right: nothing here or further left.
//  - right_out: an edge is negative and does not rise to the right: nothing here or further right.
// If left_out alone, go right. If not left_out and the left neighbour is not either, go left.
// Otherwise this is the row's first tile, if the row has one; offer it and go down.
// Values that may wrap (`exhaustive`) give every row from the box's first tile.
`default_nettype none

module row_walker #(
    parameter int unsigned PixelUnits = 8
) (
    input  logic                    clk_i,
    input  logic                    rst_ni,
    input  logic                    clear_i,

    input  logic                    valid_i,
    output logic                    ready_o,
    input  raster_pkg::constants_t  constants_i,
    input  raster_pkg::place_t      place_i,
    input  raster_pkg::row_t        rows_i,

    output logic                    valid_o,
    input  logic                    ready_i,
    output raster_pkg::span_start_t start_o,
    output raster_pkg::constants_t  constants_o,
    input  logic                    handed_on_i,

    output logic                    idle_o
);

  import halfspace_pkg::*;
  import raster_pkg::*;

  localparam int unsigned TileWidth = tile_width(PixelUnits);
  localparam int unsigned TileHeight = tile_height(PixelUnits);
  localparam index_t TilesPerRow = index_t'(Width / TileWidth);

  logic busy_q, busy_d;
  logic first_q, first_d;
  logic top_q, top_d;
  row_t rows_q, rows_d;
  constants_t constants_q;
  place_t place_q, place_d;

  place_t to_the_left, to_the_right, below;
  logic left_out, right_out, neighbour_left_out;
  logic load, start, step_left, step_right, step_down, bottom;

  assign bottom = rows_q == '0;

  always_comb begin
    left_out           = 1'b0;
    right_out          = 1'b0;
    neighbour_left_out = 1'b0;
    for (int unsigned i = 0; i < Edges; i++) begin
      value_t across, down;
      logic rises, level;
      across = value_t'(constants_q.step_x[i]) * value_t'(TileWidth);
      down   = value_t'(constants_q.step_y[i]) * value_t'(TileHeight);
      level  = constants_q.step_x[i] == '0;
      rises  = !constants_q.step_x[i][$bits(step_t)-1];
      to_the_left.largest[i]  = place_q.largest[i] - across;
      to_the_right.largest[i] = place_q.largest[i] + across;
      below.largest[i]        = place_q.largest[i] + down;
      if (place_q.largest[i][31] && rises) left_out = 1'b1;
      if (place_q.largest[i][31] && (level || !rises)) right_out = 1'b1;
      if (to_the_left.largest[i][31] && rises) neighbour_left_out = 1'b1;
    end
    to_the_left.depth   = place_q.depth - constants_q.depth_step_x * value_t'(TileWidth);
    to_the_right.depth  = place_q.depth + constants_q.depth_step_x * value_t'(TileWidth);
    below.depth         = place_q.depth + constants_q.depth_step_y * value_t'(TileHeight);
    to_the_left.plane   = difference(place_q.plane, channels_across(constants_q.plane_step_x, TileWidth));
    to_the_right.plane  = sum(place_q.plane, channels_across(constants_q.plane_step_x, TileWidth));
    below.plane         = sum(place_q.plane, channels_across(constants_q.plane_step_y, TileHeight));
    to_the_left.column  = place_q.column - 1'b1;
    to_the_right.column = place_q.column + 1'b1;
    below.column        = place_q.column;
    to_the_left.row     = place_q.row;
    to_the_right.row    = place_q.row;
    below.row           = place_q.row + 1'b1;
    to_the_left.index   = place_q.index - 1'b1;
    to_the_right.index  = place_q.index + 1'b1;
    below.index         = place_q.index + TilesPerRow;
  end

  always_comb begin
    step_left  = 1'b0;
    step_right = 1'b0;
    start      = 1'b0;
    if (busy_q) begin
      if (constants_q.exhaustive) begin
        start = 1'b1;
      end else if (left_out) begin
        step_right = !right_out && place_q.column != constants_q.last_column;
      end else if (!neighbour_left_out && place_q.column != constants_q.first_column) begin
        step_left = 1'b1;
      end else begin
        start = !right_out;
      end
    end
    // An empty row takes no start, and so waits for nobody.
    step_down = busy_q && !step_left && !step_right && (!start || ready_i);
  end

  assign valid_o = start;
  assign start_o = '{first: first_q, top: top_q, bottom: bottom, place: place_q};
  assign constants_o = constants_q;
  assign ready_o = !busy_q && handed_on_i;
  assign load    = valid_i && ready_o;
  assign idle_o  = !busy_q;

  always_comb begin
    busy_d  = busy_q;
    first_d = first_q;
    top_d   = top_q;
    rows_d  = rows_q;
    place_d = place_q;
    if (step_left) begin
      place_d = to_the_left;
    end else if (step_right) begin
      place_d = to_the_right;
    end else if (step_down) begin
      place_d = below;
      top_d   = 1'b0;
      first_d = first_q && !start;
      rows_d  = rows_q - 1'b1;
      busy_d  = !bottom;
    end
    if (load) begin
      busy_d  = 1'b1;
      first_d = 1'b1;
      top_d   = 1'b1;
      rows_d  = rows_i;
      place_d = place_i;
    end
    if (clear_i) busy_d = 1'b0;
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      busy_q <= 1'b0;
    end else begin
      busy_q <= busy_d;
    end
  end

  always_ff @(posedge clk_i) begin
    first_q <= first_d;
    top_q   <= top_d;
    rows_q  <= rows_d;
    place_q <= place_d;
    if (load) constants_q <= constants_i;
  end

`ifndef SYNTHESIS
  always_ff @(posedge clk_i) begin
    if (rst_ni && busy_q) begin
      assert (place_q.column >= constants_q.first_column && place_q.column <= constants_q.last_column)
      else $error("walked out of the box");
      assert ($onehot0({step_left, step_right, step_down})) else $error("two steps at once");
    end
  end
`endif

endmodule

`default_nettype wire
