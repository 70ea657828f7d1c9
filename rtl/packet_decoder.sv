// Words in, packets out; bad packets are skipped by their header's length.
//
// Takes a word a clock while `enable_i` is 1. A good packet is offered from the clock after its
// last word; it stays, and holds back the next packet's words, until it is taken. It may be taken
// in the clock in which it is first offered, and then the stream does not pause at all: eleven
// words make a triangle every eleven clocks.
//
// A packet is offered on one of three channels, which share the packet's one buffer: `primitive`
// (triangle or clear), `swap`, `fence`.
//
// `bad_packet_o` is 1 for a clock for each bad packet: with a bad header when it is taken, with a
// bad word behind it when the packet's last word is.
`default_nettype none

module packet_decoder (
    input  logic                   clk_i,
    input  logic                   rst_ni,
    input  logic                   clear_i,
    input  logic                   enable_i,

    input  logic                   word_valid_i,
    output logic                   word_ready_o,
    input  logic [31:0]            word_i,

    output logic                   primitive_valid_o,
    input  logic                   primitive_ready_i,
    output raster_pkg::primitive_t primitive_o,

    output logic                   swap_valid_o,
    input  logic                   swap_ready_i,

    output logic                   fence_valid_o,
    input  logic                   fence_ready_i,
    output logic [31:0]            fence_tag_o,

    output logic                   mid_packet_o,
    output logic                   bad_packet_o
);

  import halfspace_pkg::*;
  import raster_pkg::*;

  // The words behind the header, youngest at 0, so that a packet's place does not depend on its kind.
  logic [PayloadWordsMax-1:0][31:0] payload_q;
  logic [7:0] missing_q, missing_d;
  logic skipping_q, skipping_d;
  kind_e kind_q, kind_d;
  logic [7:0] colour_q, colour_d;
  logic keep_depth_q, keep_colour_q, depth_grey_q;
  logic valid_q, valid_d;
  logic is_triangle;

  logic take, packet_taken, shift;
  header_t header;
  logic header_good;
  span_t columns, rows;
  logic box_good, channels_good;
  clear_depth_t clear_word;
  logic last_word_good;

  assign packet_taken = (primitive_valid_o && primitive_ready_i) || (swap_valid_o && swap_ready_i) ||
                        (fence_valid_o && fence_ready_i);
  assign word_ready_o = enable_i && (!valid_q || packet_taken);
  assign take         = word_valid_i && word_ready_o;
  assign mid_packet_o = missing_q != '0;

  assign header = header_t'(word_i);
  always_comb begin
    logic [7:0] length;
    logic known, has_colour, has_mode;
    known      = 1'b1;
    has_colour = 1'b0;
    has_mode   = 1'b0;
    length     = '0;
    unique case (header.kind)
      KindClear: begin
        length     = 8'(ClearWords);
        has_colour = 1'b1;
      end
      KindFlatTriangle: begin
        length     = 8'(FlatTriangleWords);
        has_colour = 1'b1;
        has_mode   = 1'b1;
      end
      KindGouraudTriangle: begin
        length   = 8'(GouraudTriangleWords);
        has_mode = 1'b1;
      end
      KindSwap: length = 8'(SwapWords);
      KindFence: length = 8'(FenceWords);
      default: known = 1'b0;
    endcase
    header_good = known && header.length == length && header.reserved == '0 &&
                  (has_colour || header.colour == '0) &&
                  (has_mode || {header.keep_depth, header.keep_colour, header.depth_grey} == '0);
  end

  // A packet's last word is on its way in: the others stand one place lower than at the end.
  // All triangles end with their shape, so it stands at one place whatever their kind.
  assign columns = span_t'(payload_q[ShapeWords-2-FlatTriangleColumnsWord]);
  assign rows    = span_t'(payload_q[ShapeWords-2-FlatTriangleRowsWord]);
  assign box_good = columns.first <= columns.last && columns.last < 16'(Width) &&
                    rows.first <= rows.last && rows.last < 16'(Height);
  assign clear_word = clear_depth_t'(word_i);
  assign channels_good =
      !payload_q[GouraudTriangleWords-2-GouraudTriangleColourHighWord][31] &&
      !payload_q[GouraudTriangleWords-2-GouraudTriangleColourStepXHighWord][31] &&
      !payload_q[GouraudTriangleWords-2-GouraudTriangleColourStepYHighWord][31];
  always_comb begin
    unique case (kind_q)
      KindClear: last_word_good = clear_word.reserved == '0;
      KindFlatTriangle: last_word_good = box_good;
      KindGouraudTriangle: last_word_good = box_good && channels_good;
      default: last_word_good = 1'b1;
    endcase
  end

  always_comb begin
    missing_d    = missing_q;
    skipping_d   = skipping_q;
    kind_d       = kind_q;
    colour_d     = colour_q;
    valid_d      = valid_q && !packet_taken;
    shift        = 1'b0;
    bad_packet_o = 1'b0;
    if (take && missing_q == '0) begin
      missing_d    = header.length;
      skipping_d   = !header_good;
      bad_packet_o = !header_good;
      if (header_good) begin
        kind_d   = kind_e'(header.kind);
        colour_d = header.colour;
        valid_d  = header.length == '0;
      end
    end else if (take) begin
      missing_d = missing_q - 8'd1;
      shift     = !skipping_q;
      if (!skipping_q && missing_q == 8'd1) begin
        valid_d      = last_word_good;
        bad_packet_o = !last_word_good;
      end
    end
    if (clear_i) begin
      missing_d    = '0;
      valid_d      = 1'b0;
      bad_packet_o = 1'b0;
    end
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      missing_q  <= '0;
      skipping_q <= 1'b0;
      kind_q     <= KindClear;
      colour_q   <= '0;
      keep_depth_q  <= 1'b0;
      keep_colour_q <= 1'b0;
      depth_grey_q  <= 1'b0;
      valid_q    <= 1'b0;
      payload_q  <= '0;
    end else begin
      missing_q  <= missing_d;
      skipping_q <= skipping_d;
      kind_q     <= kind_d;
      colour_q   <= colour_d;
      if (take && missing_q == '0) begin
        keep_depth_q  <= header.keep_depth;
        keep_colour_q <= header.keep_colour;
        depth_grey_q  <= header.depth_grey;
      end
      valid_q    <= valid_d;
      if (shift) payload_q <= {payload_q[PayloadWordsMax-2:0], word_i};
    end
  end

  function automatic value_t shape_word(int unsigned number);
    return value_t'(payload_q[ShapeWords-1-number]);
  endfunction

  // Three channels from the word of that number behind the header, and the next.
  function automatic channels_t channels(int unsigned low_word);
    // Red lowest, then green, then blue, and a spare bit on top.
    return {payload_q[GouraudTriangleWords-2-low_word][30:0], payload_q[GouraudTriangleWords-1-low_word]};
  endfunction

  assign is_triangle = kind_q == KindFlatTriangle || kind_q == KindGouraudTriangle;

  always_comb begin
    edge_steps_t steps0, steps1;
    span_t box_columns, box_rows;
    clear_depth_t clear_depth;
    steps0      = edge_steps_t'(shape_word(FlatTriangleSteps0Word));
    steps1      = edge_steps_t'(shape_word(FlatTriangleSteps1Word));
    box_columns = span_t'(shape_word(FlatTriangleColumnsWord));
    box_rows    = span_t'(shape_word(FlatTriangleRowsWord));
    clear_depth = clear_depth_t'(payload_q[ClearWords-1-ClearDepthWord]);

    primitive_o            = '0;
    primitive_o.mode = '{
        counted: is_triangle,
        depth_test: is_triangle && !keep_depth_q,
        depth_write: !keep_depth_q,
        colour_write: !keep_colour_q,
        depth_grey: depth_grey_q,
        shaded: kind_q == KindGouraudTriangle
    };
    primitive_o.colour     = colour_q;
    // In a flat triangle these are words of packets before it; nobody looks.
    primitive_o.plane        = channels(GouraudTriangleColourLowWord);
    primitive_o.plane_step_x = channels(GouraudTriangleColourStepXLowWord);
    primitive_o.plane_step_y = channels(GouraudTriangleColourStepYLowWord);
    if (is_triangle) begin
      primitive_o.first_column  = column_t'(box_columns.first);
      primitive_o.last_column   = column_t'(box_columns.last);
      primitive_o.first_row     = row_t'(box_rows.first);
      primitive_o.last_row      = row_t'(box_rows.last);
      primitive_o.edge_value[0] = shape_word(FlatTriangleEdge0Word);
      primitive_o.edge_value[1] = shape_word(FlatTriangleEdge1Word);
      primitive_o.edge_value[2] = shape_word(FlatTriangleEdge2Word);
      primitive_o.step_x[0]     = step_t'(steps0.step_x);
      primitive_o.step_y[0]     = step_t'(steps0.step_y);
      primitive_o.step_x[1]     = step_t'(steps1.step_x);
      primitive_o.step_y[1]     = step_t'(steps1.step_y);
      primitive_o.step_x[2]     = -step_t'(steps0.step_x) - step_t'(steps1.step_x);
      primitive_o.step_y[2]     = -step_t'(steps0.step_y) - step_t'(steps1.step_y);
      primitive_o.depth         = shape_word(FlatTriangleDepthWord);
      primitive_o.depth_step_x  = shape_word(FlatTriangleDepthStepXWord);
      primitive_o.depth_step_y  = shape_word(FlatTriangleDepthStepYWord);
    end else begin
      primitive_o.last_column = column_t'(Width - 1);
      primitive_o.last_row    = row_t'(Height - 1);
      primitive_o.depth       = value_t'({4'b0, clear_depth.depth, {DepthFractionBits{1'b0}}});
    end
  end

  assign primitive_valid_o = valid_q && (is_triangle || kind_q == KindClear);
  assign swap_valid_o      = valid_q && kind_q == KindSwap;
  assign fence_valid_o     = valid_q && kind_q == KindFence;
  assign fence_tag_o       = payload_q[FenceWords-1-FenceTagWord];

`ifndef SYNTHESIS
  always_ff @(posedge clk_i) begin
    if (rst_ni && primitive_valid_o) begin
      assert (primitive_o.first_column <= primitive_o.last_column && 32'(primitive_o.last_column) < Width)
      else $error("a box off the screen was offered");
      assert (primitive_o.first_row <= primitive_o.last_row && 32'(primitive_o.last_row) < Height)
      else $error("a box off the screen was offered");
    end
    if (rst_ni) assert (!(valid_q && mid_packet_o)) else $error("a packet offered while the next comes in");
  end
`endif

endmodule

`default_nettype wire
