// Follows one primitive, any one, and one pixel of its box, any one, through the traversal.
//
// `take_i` picks the primitive. From then on the marks do what the planes do: each starts where the
// primitive does, and moves by a tile's steps when the design says that it moves by a tile. They are
// worked out from the primitive alone, never read from the design. The target is the pixel's tile.
// `target_i` are the planes there: what they may be, the proof assumes.
`default_nettype none

module followed_primitive
  import raster_pkg::*;
  import traversal_proof_pkg::*;
#(
    parameter int unsigned PixelUnits = 8
) (
    input logic clk_i,
    input logic clear_i,

    input logic       take_i,
    input primitive_t primitive_i,
    input column_t    pixel_column_i,
    input row_t       pixel_row_i,
    input mark_t      target_i,

    input logic load_i,         // the walker takes what setup offers
    input logic step_left_i,    // the walker's steps
    input logic step_right_i,
    input logic step_down_i,
    input logic push_i,         // the queue takes a start, into its
    input logic push_low_i,     // lower place
    input logic pop_i,          // the scanner takes a start
    input logic pop_first_i,    // that brings constants
    input logic scanner_steps_i,
    input logic tile_valid_i,

    output presence_t           in_o,
    output primitive_t          primitive_o,
    output box_t                box_o,
    output logic                exhaustive_o,
    output value_t [Planes-1:0] step_x_o,
    output value_t [Planes-1:0] step_y_o,
    output value_t [Planes-1:0] across_o,    // a tile's width
    output value_t [Planes-1:0] reach_x_o,   // what an edge gains at most within a tile
    output value_t [Planes-1:0] reach_y_o,
    output value_t [Planes-1:0] at_pixel_o,  // the planes at the pixel
    output mark_t               first_o,     // the box's first tile
    output mark_t               target_o,
    output mark_t               walker_o,
    output mark_t [1:0]         queue_o,
    output mark_t               scanner_o,
    output row_t                shown_row_o,  // of the tile that was shown last
    output column_t             shown_column_o,
    output logic                target_shown_o
);

  localparam int unsigned TileWidth = tile_width(PixelUnits);
  localparam int unsigned TileHeight = tile_height(PixelUnits);
  localparam int unsigned ColumnShift = $clog2(TileWidth);
  localparam int unsigned RowShift = $clog2(TileHeight);
  localparam logic [1:0] LastX = 2'(TileWidth - 1);
  localparam logic LastY = 1'(TileHeight - 1);
  localparam value_t FirstLimit = 1 <<< 30;

  presence_t in_q;
  primitive_t primitive_q;
  logic [1:0] pixel_x_q;
  logic pixel_y_q;
  mark_t target_q, walker_q, scanner_q;
  mark_t [1:0] queue_q;
  row_t shown_row_q;
  column_t shown_column_q;
  value_t [Planes-1:0] down;

  assign in_o           = in_q;
  assign primitive_o    = primitive_q;
  assign target_o       = target_q;
  assign walker_o       = walker_q;
  assign queue_o        = queue_q;
  assign scanner_o      = scanner_q;
  assign shown_row_o    = shown_row_q;
  assign shown_column_o = shown_column_q;
  assign target_shown_o = tile_valid_i && in_q.scanner && scanner_q.row == target_q.row &&
                          scanner_q.column == target_q.column;

  assign box_o = '{
          first_column: primitive_q.first_column >> ColumnShift,
          last_column: primitive_q.last_column >> ColumnShift,
          first_row: primitive_q.first_row >> RowShift,
          last_row: primitive_q.last_row >> RowShift,
          left: 2'(primitive_q.first_column) & LastX,
          right: 2'(primitive_q.last_column) & LastX,
          top: 1'(primitive_q.first_row) & LastY,
          bottom: 1'(primitive_q.last_row) & LastY
      };

  always_comb begin
    value_t [Planes-1:0] corner;
    exhaustive_o = 1'b0;
    for (int unsigned i = 0; i < Edges; i++) begin
      corner[i]    = primitive_q.edge_value[i];
      step_x_o[i]  = value_t'(primitive_q.step_x[i]);
      step_y_o[i]  = value_t'(primitive_q.step_y[i]);
      reach_x_o[i] = step_x_o[i] > 0 ? times(step_x_o[i], LastX) : '0;
      reach_y_o[i] = step_y_o[i] > 0 ? times(step_y_o[i], {1'b0, LastY}) : '0;
      if (corner[i] >= FirstLimit || corner[i] < -FirstLimit) exhaustive_o = 1'b1;
    end
    corner[Edges]    = primitive_q.depth;
    step_x_o[Edges]  = primitive_q.depth_step_x;
    step_y_o[Edges]  = primitive_q.depth_step_y;
    reach_x_o[Edges] = '0;
    reach_y_o[Edges] = '0;
    for (int unsigned i = 0; i < Planes; i++) begin
      across_o[i]   = step_x_o[i] * value_t'(TileWidth);
      down[i]       = step_y_o[i] * value_t'(TileHeight);
      at_pixel_o[i] = target_q.value[i] - reach_x_o[i] - reach_y_o[i] + times(step_x_o[i], pixel_x_q) +
                      times(step_y_o[i], {1'b0, pixel_y_q});
      first_o.value[i] = corner[i] + (reach_x_o[i] - times(step_x_o[i], box_o.left)) +
                         (reach_y_o[i] - times(step_y_o[i], {1'b0, box_o.top}));
    end
    // The same sum, in the order in which the design adds it: solvers are slow at regrouping.
    first_o.value[Edges] = corner[Edges] -
        (times(step_x_o[Edges], box_o.left) + times(step_y_o[Edges], {1'b0, box_o.top}));
    first_o.colour = difference(primitive_q.plane, sum(channels_times(primitive_q.plane_step_x, box_o.left),
                                channels_times(primitive_q.plane_step_y, {1'b0, box_o.top})));
    first_o.column = box_o.first_column;
    first_o.row    = box_o.first_row;
  end

  function automatic mark_t beside(mark_t mark, logic right);
    mark_t moved;
    channels_t colour_across;
    colour_across = channels_across(primitive_q.plane_step_x, TileWidth);
    moved         = mark;
    moved.column  = right ? mark.column + 1'b1 : mark.column - 1'b1;
    moved.colour  = right ? sum(mark.colour, colour_across) : difference(mark.colour, colour_across);
    for (int unsigned i = 0; i < Planes; i++) begin
      moved.value[i] = right ? mark.value[i] + across_o[i] : mark.value[i] - across_o[i];
    end
    return moved;
  endfunction

  function automatic mark_t below(mark_t mark);
    mark_t moved;
    moved        = mark;
    moved.row    = mark.row + 1'b1;
    moved.colour = sum(mark.colour, channels_across(primitive_q.plane_step_y, TileHeight));
    for (int unsigned i = 0; i < Planes; i++) moved.value[i] = mark.value[i] + down[i];
    return moved;
  endfunction

  always_ff @(posedge clk_i) begin
    if (clear_i) begin
      in_q <= '0;
    end else begin
      if (take_i) in_q.followed <= 1'b1;
      if (take_i) in_q.setup <= 1'b1;
      else if (load_i) in_q.setup <= 1'b0;
      if (load_i) in_q.walker <= in_q.setup;
      if (pop_i) in_q.queue <= {1'b0, in_q.queue[1]};
      if (push_i && push_low_i) in_q.queue[0] <= in_q.walker;
      if (push_i && !push_low_i) in_q.queue[1] <= in_q.walker;
      if (pop_i) in_q.scanner <= in_q.queue[0];
      else if (!scanner_steps_i) in_q.scanner <= 1'b0;
      if (pop_i && pop_first_i) in_q.scanner_constants <= in_q.queue[0];
      if (tile_valid_i && in_q.scanner) in_q.shown <= 1'b1;
      if (target_shown_o) in_q.seen <= 1'b1;
    end
  end

  always_ff @(posedge clk_i) begin
    if (take_i) begin
      primitive_q     <= primitive_i;
      pixel_x_q       <= 2'(pixel_column_i) & LastX;
      pixel_y_q       <= 1'(pixel_row_i) & LastY;
      target_q        <= target_i;
      target_q.column <= pixel_column_i >> ColumnShift;
      target_q.row    <= pixel_row_i >> RowShift;
    end
    if (load_i) walker_q <= first_o;
    else if (step_left_i) walker_q <= beside(walker_q, 1'b0);
    else if (step_right_i) walker_q <= beside(walker_q, 1'b1);
    else if (step_down_i) walker_q <= below(walker_q);
    if (pop_i) queue_q[0] <= queue_q[1];
    if (push_i && push_low_i) queue_q[0] <= walker_q;
    if (push_i && !push_low_i) queue_q[1] <= walker_q;
    if (pop_i) scanner_q <= queue_q[0];
    else scanner_q <= beside(scanner_q, 1'b1);
    if (tile_valid_i && in_q.scanner) begin
      shown_row_q    <= scanner_q.row;
      shown_column_q <= scanner_q.column;
    end
  end

endmodule

`default_nettype wire
