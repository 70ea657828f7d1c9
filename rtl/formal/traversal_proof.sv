// Proves that `traversal` visits every covered pixel's tile exactly once and comes to an end, whatever the stream.
//
// Of any primitive, and any pixel of its box that all three edge functions cover: while the primitive
// passes, its tiles are shown in rising order (so none twice), none of them outside the box, each with
// its constants, its number and the planes' values there, and the pixel's tile is among them. If
// the edge values may wrap, the same holds for every pixel of the box. Any primitives may come before
// and behind, at any time, and a clear at any time. No size is reduced.
//
// What a step is multiplied with is a number of tiles, and a solver does not get through products of
// that size. So of the planes this is assumed, which is all that the proof needs to know of
// them: in the target's row, n tiles from the target, a plane that gains `a` a tile to the right
// is greater than at the target by 0 if n or a is 0, by |a| at least and |a| * Width at
// most if their signs are the same, and smaller by as much if they are not. By a * n, that is.
// And a plane on the screen is not further from 0 than its first value and all steps to there are.
`default_nettype none

module traversal_proof
  import halfspace_pkg::*;
  import raster_pkg::*;
  import traversal_proof_pkg::*;
#(
    parameter int unsigned PixelUnits = 8
) (
    input logic       clk_i,
    input logic       clear_i,
    input logic       valid_i,
    input primitive_t primitive_i,

    // The primitive to follow, and a pixel of it.
    input logic    pick_i,
    input column_t pixel_column_i,
    input row_t    pixel_row_i,
    input mark_t   target_i
);

  localparam index_t TilesPerRow = index_t'(Width / tile_width(PixelUnits));
  localparam index_t Rows = index_t'(Height / tile_height(PixelUnits));
  localparam value_t StepLimit = 1 <<< 16;
  localparam value_t GainLimit = StepLimit * value_t'(Width);
  localparam value_t ValueLimit = (1 <<< 30) + StepLimit * value_t'(Width + Height + 16);

  // `triangle_setup`'s state Add; Offer is the next.
  localparam logic [1:0] SetupAdds = 2'd2;

  logic started_q;
  initial started_q = 1'b0;
  always_ff @(posedge clk_i) started_q <= 1'b1;

  logic ready, valid, idle;
  tile_t tile;
  constants_t constants;

  traversal #(
      .PixelUnits(PixelUnits)
  ) u_dut (
      .clk_i,
      .rst_ni     (started_q),
      .clear_i,
      .valid_i,
      .ready_o    (ready),
      .primitive_i,
      .valid_o    (valid),
      .tile_o     (tile),
      .constants_o(constants),
      .idle_o     (idle)
  );

  presence_t is_in;
  primitive_t followed;
  box_t box;
  logic exhaustive, take, pop, target_shown;
  value_t [Planes-1:0] step_x, step_y, across, reach_x, reach_y, at_pixel;
  mark_t first, target, walker, scanner;
  mark_t [1:0] queue;
  row_t shown_row;
  column_t shown_column;

  assign take = valid_i && ready && pick_i && !is_in.followed && !clear_i;
  assign pop  = u_dut.queue_valid && u_dut.queue_ready;

  followed_primitive #(
      .PixelUnits(PixelUnits)
  ) u_followed (
      .clk_i,
      .clear_i        (!started_q || clear_i),
      .take_i         (take),
      .primitive_i,
      .pixel_column_i,
      .pixel_row_i,
      .target_i,
      .load_i         (u_dut.setup_valid && u_dut.setup_ready),
      .step_left_i    (u_dut.u_walker.step_left),
      .step_right_i   (u_dut.u_walker.step_right),
      .step_down_i    (u_dut.u_walker.step_down),
      .push_i         (u_dut.walk_valid && u_dut.walk_ready),
      .push_low_i     (!u_dut.u_queue.valid_q[0] || pop),
      .pop_i          (pop),
      .pop_first_i    (u_dut.queue_start.first),
      .scanner_steps_i(valid && !u_dut.u_scanner.row_done),
      .tile_valid_i   (valid),
      .in_o           (is_in),
      .primitive_o    (followed),
      .box_o          (box),
      .exhaustive_o   (exhaustive),
      .step_x_o       (step_x),
      .step_y_o       (step_y),
      .across_o       (across),
      .reach_x_o      (reach_x),
      .reach_y_o      (reach_y),
      .at_pixel_o     (at_pixel),
      .first_o        (first),
      .target_o       (target),
      .walker_o       (walker),
      .queue_o        (queue),
      .scanner_o      (scanner),
      .shown_row_o    (shown_row),
      .shown_column_o (shown_column),
      .target_shown_o (target_shown)
  );

  function automatic logic is_within(value_t value, value_t limit);
    return value <= limit && value >= -limit;
  endfunction

  // Assumed of a place, as the head says.
  function automatic logic is_on_planes(mark_t mark);
    logic possible;
    value_t distance, gain;
    possible = 1'b1;
    distance = value_t'({1'b0, mark.column}) - value_t'({1'b0, target.column});
    for (int unsigned i = 0; i < Edges; i++) begin
      if (!exhaustive && !is_within(mark.value[i], ValueLimit)) possible = 1'b0;
    end
    if (mark.row == target.row && distance == 0) begin
      if (mark.value != target.value || mark.colour != target.colour) possible = 1'b0;
    end else if (mark.row == target.row && !exhaustive) begin
      for (int unsigned i = 0; i < Edges; i++) begin
        gain = (distance > 0) ? mark.value[i] - target.value[i] : target.value[i] - mark.value[i];
        if (step_x[i] == 0 && gain != 0) possible = 1'b0;
        if (step_x[i] > 0 && gain < across[i]) possible = 1'b0;
        if (step_x[i] < 0 && gain > across[i]) possible = 1'b0;
        if (!is_within(gain, GainLimit)) possible = 1'b0;
      end
    end
    return possible;
  endfunction

  always_comb begin
    if (take) begin
      // What the decoder lets through.
      assume (primitive_i.first_column <= primitive_i.last_column && 32'(primitive_i.last_column) < Width);
      assume (primitive_i.first_row <= primitive_i.last_row && 32'(primitive_i.last_row) < Height);
      assume (pixel_column_i >= primitive_i.first_column && pixel_column_i <= primitive_i.last_column);
      assume (pixel_row_i >= primitive_i.first_row && pixel_row_i <= primitive_i.last_row);
    end
    if (is_in.followed && !exhaustive) begin
      for (int unsigned i = 0; i < Edges; i++) begin
        assume (is_within(step_x[i], StepLimit) && is_within(step_y[i], StepLimit));
        assume (is_within(target.value[i], ValueLimit));
        // The pixel is covered.
        assume (at_pixel[i] >= 0);
      end
    end
    if (is_in.walker) assume (is_on_planes(walker));
    if (is_in.scanner) assume (is_on_planes(scanner));
  end

  logic walking;
  logic [1:0] in_queue_first;
  assign walking = is_in.walker && u_dut.u_walker.busy_q;
  assign in_queue_first = is_in.queue & {u_dut.u_queue.starts_q[1].first, u_dut.u_queue.starts_q[0].first};

  // Where the target is to come from.
  logic [4:0] pending;
  assign pending = {
    is_in.setup,
    walking && walker.row <= target.row,
    is_in.queue[1] && queue[1].row == target.row,
    is_in.queue[0] && queue[0].row == target.row,
    is_in.scanner && scanner.row == target.row && scanner.column <= target.column
  };

  function automatic logic constants_agree(constants_t it);
    logic agree;
    agree = it.mode == followed.mode && it.exhaustive == exhaustive && it.colour == followed.colour &&
            it.first_column == box.first_column && it.last_column == box.last_column && it.left == box.left &&
            it.right == box.right && it.top == box.top && it.bottom == box.bottom &&
            it.step_x == followed.step_x && it.step_y == followed.step_y &&
            it.depth_step_x == followed.depth_step_x && it.depth_step_y == followed.depth_step_y &&
            it.plane_step_x == followed.plane_step_x && it.plane_step_y == followed.plane_step_y;
    for (int unsigned i = 0; i < Edges; i++) begin
      if (it.reach[i] != reach_x[i] + reach_y[i]) agree = 1'b0;
    end
    return agree;
  endfunction

  function automatic logic place_agrees(place_t it, mark_t mark);
    return it.column == mark.column && mark.column >= box.first_column && mark.column <= box.last_column &&
           mark.row >= box.first_row && mark.row <= box.last_row && it.row == mark.row[1:0] &&
           it.index == index_t'(mark.row) * TilesPerRow + index_t'(mark.column) &&
           it.largest == mark.value[Edges-1:0] && it.depth == mark.value[Edges] && it.plane == mark.colour;
  endfunction

  // Invariants, each stage's. They hold at reset, and each step keeps them.

  always_comb begin
    if (started_q && is_in.followed) begin
      assert (box.first_column <= target.column && target.column <= box.last_column);
      assert (box.first_row <= target.row && target.row <= box.last_row);
      assert (index_t'(box.last_column) < TilesPerRow && index_t'(box.last_row) < Rows);
      assert ((u_followed.pixel_x_q & ~u_followed.LastX) == '0 && (u_followed.pixel_y_q & ~u_followed.LastY) == '0);
      assert (!is_in.seen || is_in.shown);
    end else if (started_q) begin
      assert (is_in == '0);
    end
  end

  always_comb begin
    if (started_q && is_in.setup) begin
      assert (!u_dut.setup_idle && u_dut.u_setup.primitive_q == followed);
      assert (is_in == presence_t'{followed: 1'b1, setup: 1'b1, default: '0});
      if (u_dut.u_setup.state_q >= SetupAdds) begin
        for (int unsigned i = 0; i < Edges; i++) begin
          assert (u_dut.u_setup.reach_q[i] == reach_x[i] + reach_y[i]);
          assert (u_dut.u_setup.move_x_q[i] == reach_x[i] - times(step_x[i], box.left));
          assert (u_dut.u_setup.move_y_q[i] == reach_y[i] - times(step_y[i], {1'b0, box.top}));
        end
        assert (followed.depth - u_dut.u_setup.depth_move_q == first.value[Edges]);
        assert (difference(followed.plane, u_dut.u_setup.plane_move_q) == first.colour);
      end
      if (u_dut.setup_valid) begin
        for (int unsigned i = 0; i < Edges; i++) assert (u_dut.u_setup.place_q.largest[i] == first.value[i]);
        assert (u_dut.u_setup.place_q.depth == first.value[Edges]);
        assert (place_agrees(u_dut.u_setup.place_q, first));
      end
    end
  end

  always_comb begin
    if (started_q && is_in.walker) assert (constants_agree(u_dut.u_walker.constants_q));
    if (started_q && walking) begin
      assert (place_agrees(u_dut.u_walker.place_q, walker));
      assert (u_dut.u_walker.rows_q == box.last_row - walker.row);
      assert (u_dut.u_walker.top_q == (walker.row == box.first_row));
      assert (u_dut.u_walker.first_q == !(is_in.scanner_constants || in_queue_first != '0));
      assert (!exhaustive || walker.column == box.first_column);
      assert (!is_in.shown || shown_row < walker.row && is_in.scanner_constants);
      assert (!is_in.scanner || scanner.row < walker.row);
      // Behind its first start, nothing but its starts.
      if (is_in.scanner_constants || is_in.queue[0]) assert (is_in.queue == u_dut.u_queue.valid_q);
    end
  end

  always_comb begin
    if (started_q) begin
      assert (u_dut.u_queue.valid_q != 2'b10);
      for (int unsigned k = 0; k < 2; k++) begin
        if (is_in.queue[k]) begin
          assert (u_dut.u_queue.valid_q[k]);
          assert (place_agrees(u_dut.u_queue.starts_q[k].place, queue[k]));
          assert (u_dut.u_queue.starts_q[k].top == (queue[k].row == box.first_row));
          assert (u_dut.u_queue.starts_q[k].bottom == (queue[k].row == box.last_row));
          assert (queue[k].row != target.row || queue[k].column <= target.column);
          assert (!is_in.shown || shown_row < queue[k].row);
          assert (!is_in.scanner || scanner.row < queue[k].row);
          assert (!walking || queue[k].row < walker.row);
        end
      end
      // Its first start brings its constants, and the walker keeps them until then.
      if (is_in.queue == 2'b11) assert (queue[0].row < queue[1].row && !in_queue_first[1]);
      if (is_in.queue == 2'b10) assert (in_queue_first[1]);
      if (is_in.queue != '0) assert (in_queue_first != '0 ? is_in.walker && !is_in.scanner_constants : is_in.scanner_constants);
      if (is_in.shown) assert (in_queue_first == '0);
    end
  end

  always_comb begin
    if (started_q && is_in.scanner_constants) assert (constants_agree(u_dut.u_scanner.constants_q));
    if (started_q && is_in.scanner) begin
      assert (valid && is_in.scanner_constants);
      assert (place_agrees(u_dut.u_scanner.place_q, scanner));
      assert (u_dut.u_scanner.top_q == (scanner.row == box.first_row));
      assert (u_dut.u_scanner.bottom_q == (scanner.row == box.last_row));
    end
  end

  // The theorem.

  always_comb begin
    if (started_q && is_in.followed) begin
      // Once and only once.
      assert ($onehot({is_in.seen, pending}));
      if (target_shown) assert (!is_in.seen);
      if (!is_in.setup && !walking && is_in.queue == '0 && !is_in.scanner) assert (is_in.seen);
      if (idle) assert (is_in.seen);
    end
    if (started_q && is_in.scanner) begin
      // Inside the box, in rising order, and as the planes say.
      assert (constants_agree(constants));
      assert (place_agrees(tile.place, scanner));
      assert (tile.at_left == (scanner.column == box.first_column) && tile.at_right == (scanner.column == box.last_column));
      assert (tile.at_top == (scanner.row == box.first_row) && tile.at_bottom == (scanner.row == box.last_row));
      assert (!is_in.shown || scanner.row > shown_row || scanner.row == shown_row && scanner.column > shown_column);
      if (target_shown) assert (tile.place.largest == target.value[Edges-1:0] && tile.place.depth == target.value[Edges]);
    end
  end

  // It comes to an end: no stage stands still but for the one behind it, and each has only so much to do.
  //
  // Setup counts to its offer. The walker steps or offers in every clock; in a row it never turns, so a row
  // takes no more clocks than the box has columns, and rows only fall. The scanner goes right in every clock
  // and not beyond the box, then takes what the queue offers. All this holds for each primitive, so
  // what is in front of the followed one ends as well.
  logic [1:0] setup_age_q;
  logic left_in_row_q, right_in_row_q;
  always_ff @(posedge clk_i) begin
    if (take) setup_age_q <= 2'd0;
    else if (setup_age_q != 2'd2) setup_age_q <= setup_age_q + 1'b1;
    if (u_dut.u_walker.step_down || u_dut.setup_valid && u_dut.setup_ready) {left_in_row_q, right_in_row_q} <= '0;
    else {left_in_row_q, right_in_row_q} <= {left_in_row_q || u_dut.u_walker.step_left, right_in_row_q || u_dut.u_walker.step_right};
  end
  always_comb begin
    if (started_q && is_in.setup) begin
      assert (u_dut.u_setup.state_q == SetupAdds - 2'd1 + setup_age_q && setup_age_q != 2'd3);
      assert (u_dut.setup_valid == (setup_age_q == 2'd2));
      // Nothing keeps it but the primitive in front: in the walker, or its first start in the queue.
      if (u_dut.setup_valid) assert (u_dut.setup_ready || u_dut.u_walker.busy_q || u_dut.queue_valid);
    end
    if (started_q && u_dut.u_walker.busy_q) begin
      assert ($onehot({u_dut.u_walker.step_left, u_dut.u_walker.step_right, u_dut.u_walker.step_down,
                       u_dut.walk_valid && !u_dut.walk_ready}));
    end
    if (started_q && walking) begin
      assert (!left_in_row_q || !u_dut.u_walker.left_out && !right_in_row_q);
      assert (!right_in_row_q || u_dut.u_walker.neighbour_left_out);
      assert (!(left_in_row_q && u_dut.u_walker.step_right) && !(right_in_row_q && u_dut.u_walker.step_left));
      if (!u_dut.walk_ready) assert (u_dut.queue_valid);
    end
    if (started_q && u_dut.queue_valid) assert (pop == (!valid || u_dut.u_scanner.row_done));
  end

  // What the assumptions must leave possible.
  logic went_left_q, went_right_q;
  always_ff @(posedge clk_i) begin
    if (take) {went_left_q, went_right_q} <= '0;
    else if (walking) {went_left_q, went_right_q} <= {went_left_q || u_dut.u_walker.step_left, went_right_q || u_dut.u_walker.step_right};
  end
  always_comb begin
    if (started_q && target_shown && !exhaustive && went_left_q && scanner.column != box.last_column) cover (1'b1);
    if (started_q && target_shown && !exhaustive && went_right_q && scanner.row != box.first_row) cover (1'b1);
    if (started_q && target_shown && exhaustive && scanner.row != box.first_row) cover (1'b1);
  end

endmodule

`default_nettype wire
