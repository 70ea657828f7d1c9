// Scans a row from its start to the right, a tile a clock, and leaves it when it cannot be covered again.
//
// Handshake: takes a start (valid/ready) in the clock in which the previous row's last tile is
// shown, so there is no clock without a tile while starts are there. Tiles go out with `valid_o`
// and cannot be held back. `constants_o` belongs to the tile that is shown.
`default_nettype none

module span_scanner #(
    parameter int unsigned PixelUnits = 8
) (
    input  logic                    clk_i,
    input  logic                    rst_ni,
    input  logic                    clear_i,

    input  logic                    valid_i,
    output logic                    ready_o,
    input  raster_pkg::span_start_t start_i,
    input  raster_pkg::constants_t  constants_i,  // taken with a start that is `first`

    output logic                    valid_o,
    output raster_pkg::tile_t       tile_o,
    output raster_pkg::constants_t  constants_o
);

  import raster_pkg::*;

  localparam int unsigned TileWidth = tile_width(PixelUnits);

  logic valid_q, valid_d;
  logic top_q, bottom_q;
  place_t place_q, to_the_right;
  constants_t constants_q;
  logic row_done, load;

  always_comb begin
    row_done = place_q.column == constants_q.last_column;
    for (int unsigned i = 0; i < Edges; i++) begin
      to_the_right.largest[i] =
          place_q.largest[i] + value_t'(constants_q.step_x[i]) * value_t'(TileWidth);
      if (to_the_right.largest[i][31] && constants_q.step_x[i] <= 0 && !constants_q.exhaustive) begin
        row_done = 1'b1;
      end
    end
    to_the_right.depth  = place_q.depth + constants_q.depth_step_x * value_t'(TileWidth);
    to_the_right.plane  = sum(place_q.plane, channels_across(constants_q.plane_step_x, TileWidth));
    to_the_right.column = place_q.column + 1'b1;
    to_the_right.row    = place_q.row;
    to_the_right.index  = place_q.index + 1'b1;
  end

  assign ready_o = !valid_q || row_done;
  assign load    = valid_i && ready_o;
  assign valid_d = load || (valid_q && !row_done);
  assign valid_o = valid_q;
  assign constants_o = constants_q;
  assign tile_o = '{
          at_left: place_q.column == constants_q.first_column,
          at_right: place_q.column == constants_q.last_column,
          at_top: top_q,
          at_bottom: bottom_q,
          place: place_q
      };

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      valid_q <= 1'b0;
    end else begin
      valid_q <= valid_d && !clear_i;
    end
  end

  always_ff @(posedge clk_i) begin
    if (load) begin
      place_q  <= start_i.place;
      top_q    <= start_i.top;
      bottom_q <= start_i.bottom;
      if (start_i.first) constants_q <= constants_i;
    end else begin
      place_q <= to_the_right;
    end
  end

`ifndef SYNTHESIS
  always_ff @(posedge clk_i) begin
    if (rst_ni && valid_q) begin
      assert (place_q.column >= constants_q.first_column && place_q.column <= constants_q.last_column)
      else $error("scanned out of the box");
    end
  end
`endif

endmodule

`default_nettype wire
