// Primitives in, tiles out: visits every tile of a primitive that may be covered, once.
//
// Setup, walker, queue and scanner in a row, each busy with its own part, so that a primitive
// follows the one before without a pause as long as its tiles outnumber its walker's steps.
// Latency from a primitive taken to its first tile: 6 clocks, and one for each tile that the first
// covered one lies right of the box's left side. Rows that hold nothing cost the walker a clock and
// the pixel units none.
`default_nettype none

module traversal #(
    parameter int unsigned PixelUnits = 8
) (
    input  logic                   clk_i,
    input  logic                   rst_ni,
    input  logic                   clear_i,

    input  logic                   valid_i,
    output logic                   ready_o,
    input  raster_pkg::primitive_t primitive_i,

    output logic                   valid_o,
    output raster_pkg::tile_t      tile_o,
    output raster_pkg::constants_t constants_o,

    output logic                   idle_o
);

  import raster_pkg::*;

  logic setup_valid, setup_ready, setup_idle;
  constants_t setup_constants;
  place_t setup_place;
  row_t setup_rows;

  logic walk_valid, walk_ready, walk_idle;
  span_start_t walk_start;
  constants_t walk_constants;

  logic queue_valid, queue_ready, queue_idle, handed_on;
  span_start_t queue_start;

  triangle_setup #(
      .PixelUnits(PixelUnits)
  ) u_setup (
      .clk_i,
      .rst_ni,
      .clear_i,
      .valid_i,
      .ready_o,
      .primitive_i,
      .valid_o    (setup_valid),
      .ready_i    (setup_ready),
      .constants_o(setup_constants),
      .place_o    (setup_place),
      .rows_o     (setup_rows),
      .idle_o     (setup_idle)
  );

  row_walker #(
      .PixelUnits(PixelUnits)
  ) u_walker (
      .clk_i,
      .rst_ni,
      .clear_i,
      .valid_i    (setup_valid),
      .ready_o    (setup_ready),
      .constants_i(setup_constants),
      .place_i    (setup_place),
      .rows_i     (setup_rows),
      .valid_o    (walk_valid),
      .ready_i    (walk_ready),
      .start_o    (walk_start),
      .constants_o(walk_constants),
      .handed_on_i(handed_on),
      .idle_o     (walk_idle)
  );

  span_queue u_queue (
      .clk_i,
      .rst_ni,
      .clear_i,
      .valid_i    (walk_valid),
      .ready_o    (walk_ready),
      .start_i    (walk_start),
      .valid_o    (queue_valid),
      .ready_i    (queue_ready),
      .start_o    (queue_start),
      .handed_on_o(handed_on),
      .idle_o     (queue_idle)
  );

  span_scanner #(
      .PixelUnits(PixelUnits)
  ) u_scanner (
      .clk_i,
      .rst_ni,
      .clear_i,
      .valid_i    (queue_valid),
      .ready_o    (queue_ready),
      .start_i    (queue_start),
      .constants_i(walk_constants),
      .valid_o,
      .tile_o,
      .constants_o
  );

  assign idle_o = setup_idle && walk_idle && queue_idle && !valid_o;

endmodule

`default_nettype wire
