// Moves a primitive's start to the tile grid and works out what stays the same over it.
//
// Handshake: valid/ready on both sides. Takes a primitive when it holds none; offers it 3 clocks
// later, and holds it until it is taken. Adds, shifts and selects only.
//
// An edge is carried as its *largest* value in a tile, so that its sign says whether the tile may
// hold a pixel inside that edge: largest = value at the tile's upper left pixel + reach.
`default_nettype none

module triangle_setup #(
    parameter int unsigned PixelUnits = 8
) (
    input  logic                   clk_i,
    input  logic                   rst_ni,
    input  logic                   clear_i,

    input  logic                   valid_i,
    output logic                   ready_o,
    input  raster_pkg::primitive_t primitive_i,

    output logic                   valid_o,
    input  logic                   ready_i,
    output raster_pkg::constants_t constants_o,
    output raster_pkg::place_t     place_o,
    output raster_pkg::row_t       rows_o,  // tile rows after the first

    output logic                   idle_o
);

  import halfspace_pkg::*;
  import raster_pkg::*;

  localparam int unsigned TileWidth = tile_width(PixelUnits);
  localparam int unsigned TileHeight = tile_height(PixelUnits);
  localparam int unsigned ColumnShift = $clog2(TileWidth);
  localparam int unsigned RowShift = $clog2(TileHeight);
  localparam logic [1:0] LastX = 2'(TileWidth - 1);
  localparam logic LastY = 1'(TileHeight - 1);

  typedef enum logic [1:0] {
    Idle,
    Multiply,
    Add,
    Offer
  } state_e;

  state_e state_q, state_d;
  primitive_t primitive_q;
  // Moves from the box's corner to the corner of the tile in which the edge is largest.
  value_t [Edges-1:0] move_x_q, move_x_d, move_y_q, move_y_d;
  value_t [Edges-1:0] reach_q, reach_d;
  value_t depth_move_q, depth_move_d;
  channels_t plane_move_q, plane_move_d;
  place_t place_q, place_d;
  logic [1:0] left;
  logic top;

  assign left = 2'(primitive_q.first_column) & LastX;
  assign top  = 1'(primitive_q.first_row) & LastY;

  // 0, 1, 2 or 3 times a value.
  function automatic value_t times(value_t value, logic [1:0] factor);
    return (factor[0] ? value : '0) + (factor[1] ? value <<< 1 : '0);
  endfunction

  always_comb begin
    for (int unsigned i = 0; i < Edges; i++) begin
      value_t step_x, step_y;
      logic up_x, up_y;
      step_x = value_t'(primitive_q.step_x[i]);
      step_y = value_t'(primitive_q.step_y[i]);
      up_x   = step_x > 0;
      up_y   = step_y > 0;
      move_x_d[i] = up_x ? times(step_x, LastX - left) : -times(step_x, left);
      move_y_d[i] = up_y ? times(step_y, {1'b0, LastY & ~top}) : -times(step_y, {1'b0, top});
      reach_d[i]  = (up_x ? times(step_x, LastX) : '0) + (up_y ? times(step_y, {1'b0, LastY}) : '0);
    end
    depth_move_d = times(primitive_q.depth_step_x, left) + times(primitive_q.depth_step_y, {1'b0, top});
    plane_move_d = sum(channels_times(primitive_q.plane_step_x, left),
                       channels_times(primitive_q.plane_step_y, {1'b0, top}));
  end

  always_comb begin
    column_t column;
    row_t row;
    column = primitive_q.first_column >> ColumnShift;
    row    = primitive_q.first_row >> RowShift;
    for (int unsigned i = 0; i < Edges; i++) begin
      place_d.largest[i] = primitive_q.edge_value[i] + move_x_q[i] + move_y_q[i];
    end
    place_d.depth  = primitive_q.depth - depth_move_q;
    place_d.plane  = difference(primitive_q.plane, plane_move_q);
    place_d.column = column;
    place_d.row    = row[1:0];
    place_d.index  = index_t'(row) * index_t'(Width / TileWidth) + index_t'(column);
  end

  always_comb begin
    constants_o.mode         = primitive_q.mode;
    constants_o.exhaustive   = 1'b0;
    constants_o.colour       = primitive_q.colour;
    constants_o.plane_step_x = primitive_q.plane_step_x;
    constants_o.plane_step_y = primitive_q.plane_step_y;
    constants_o.first_column = primitive_q.first_column >> ColumnShift;
    constants_o.last_column  = primitive_q.last_column >> ColumnShift;
    constants_o.left         = left;
    constants_o.right        = 2'(primitive_q.last_column) & LastX;
    constants_o.top          = top;
    constants_o.bottom       = 1'(primitive_q.last_row) & LastY;
    constants_o.step_x       = primitive_q.step_x;
    constants_o.step_y       = primitive_q.step_y;
    constants_o.reach        = reach_q;
    constants_o.depth_step_x = primitive_q.depth_step_x;
    constants_o.depth_step_y = primitive_q.depth_step_y;
    // Steps are at most 2^16 and the box 320x240, so a value in [-2^30, 2^30) wraps nowhere in
    // the box's tiles nor in a neighbour of them.
    for (int unsigned i = 0; i < Edges; i++) begin
      if (primitive_q.edge_value[i][31] != primitive_q.edge_value[i][30]) constants_o.exhaustive = 1'b1;
    end
  end

  assign place_o = place_q;
  assign rows_o  = (primitive_q.last_row >> RowShift) - (primitive_q.first_row >> RowShift);
  assign ready_o = state_q == Idle || (state_q == Offer && ready_i);
  assign valid_o = state_q == Offer;
  assign idle_o  = state_q == Idle;

  always_comb begin
    state_d = state_q;
    unique case (state_q)
      Idle: if (valid_i) state_d = Multiply;
      Multiply: state_d = Add;
      Add: state_d = Offer;
      Offer: if (ready_i) state_d = valid_i ? Multiply : Idle;
      default: state_d = Idle;
    endcase
    if (clear_i) state_d = Idle;
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      state_q <= Idle;
    end else begin
      state_q <= state_d;
    end
  end

  always_ff @(posedge clk_i) begin
    if (valid_i && ready_o) primitive_q <= primitive_i;
    if (state_q == Multiply) begin
      move_x_q     <= move_x_d;
      move_y_q     <= move_y_d;
      reach_q      <= reach_d;
      depth_move_q <= depth_move_d;
      plane_move_q <= plane_move_d;
    end
    if (state_q == Add) place_q <= place_d;
  end

endmodule

`default_nettype wire
