// The device: two agents on the bus, an interrupt, and VGA.
//
// Clocks: `clk_i` drives bus and rasterizer, `vga_clk_i` (25.175 MHz) the scan-out; they may have
// any phase and ratio. Crossings, each through a `synchronizer`: front buffer and test pattern to
// VGA, vertical blank and swap window back. Pixels cross in the colour memories' two ports.
// Resets are asynchronous and released here with their clocks.
`default_nettype none

module halfspace #(
    parameter int unsigned PixelUnits = 8,  // 1, 2, 4 or 8
    parameter int unsigned FifoDepth = 1024,  // words; a power of two, 64 to 32,768
    parameter int unsigned FifoPatience = 1 << 22,  // clocks that a word waits at most
    parameter bit InterruptWired = 1'b1
) (
    input  logic        clk_i,
    input  logic        rst_ni,

    input  logic [9:0]  register_address_i,
    input  logic        register_read_i,
    output logic [31:0] register_readdata_o,
    input  logic        register_write_i,
    input  logic [31:0] register_writedata_i,

    input  logic [9:0]  fifo_address_i,
    input  logic        fifo_read_i,
    output logic [31:0] fifo_readdata_o,
    input  logic        fifo_write_i,
    input  logic [31:0] fifo_writedata_i,
    output logic        fifo_waitrequest_o,

    output logic        irq_o,

    input  logic        vga_clk_i,
    input  logic        test_pattern_i,  // from a switch, any time
    output logic [7:0]  vga_red_o,
    output logic [7:0]  vga_green_o,
    output logic [7:0]  vga_blue_o,
    output logic        vga_hsync_no,
    output logic        vga_vsync_no,
    output logic        vga_blank_no,
    output logic        vga_sync_no
);

  import halfspace_pkg::*;
  import raster_pkg::*;

  localparam int unsigned LevelWidth = $clog2(FifoDepth) + 1;
  localparam int unsigned IndexWidth = $clog2(Width * Height / PixelUnits);

  logic rst_n, vga_rst_n;

  logic clear, enable;
  logic [3:0] interrupt_enable, clear_interrupts;
  logic [1:0] clear_errors;
  logic [31:0] low_water;
  status_t status;
  interrupts_t interrupts;
  errors_t errors;
  logic [31:0] triangles, pixels_tested, pixels_written, busy_cycles, stalled_cycles, frames_shown;
  logic [31:0] bad_packets;

  logic push_valid, push_ready, overflow;
  logic [31:0] push_word;
  logic [LevelWidth-1:0] level;
  logic word_valid, word_ready;
  logic [31:0] word;

  logic primitive_valid, primitive_ready, swap_valid, swap_ready, fence_valid, fence_ready;
  primitive_t new_primitive;
  logic [31:0] fence_tag, fence;
  logic mid_packet, bad_packet;

  logic tile_valid;
  tile_t tile;
  constants_t constants;
  logic traversal_idle, evaluator_idle, counters_idle, drained, busy;

  logic [PixelUnits-1:0] covered, tested, written, unit_idle;
  value_t [PixelUnits-1:0] pixel_depth;
  index_t index;
  wholes_t [PixelUnits-1:0] pixel_plane;
  logic [PixelUnits-1:0][3:0] threshold;
  logic [7:0] colour;
  pixel_mode_t mode;

  logic front, swapped, fenced;
  logic vertical_blank, swap_window;

  logic vga_front, vga_test_pattern, vga_vertical_blank, vga_swap_window;
  logic [IndexWidth-1:0] vga_index;
  logic vga_buffer;
  logic [PixelUnits-1:0][7:0] vga_colour;

  reset_synchronizer u_reset (
      .clk_i,
      .rst_ni,
      .rst_no(rst_n)
  );

  reset_synchronizer u_vga_reset (
      .clk_i (vga_clk_i),
      .rst_ni,
      .rst_no(vga_rst_n)
  );

  // Every address of the aperture pushes. A read gets 0 at once, and takes nothing.
  logic unused_aperture;
  assign unused_aperture = ^{fifo_address_i, fifo_read_i};
  assign fifo_readdata_o = '0;

  register_agent #(
      .PixelUnits    (PixelUnits),
      .FifoDepth     (FifoDepth),
      .InterruptWired(InterruptWired)
  ) u_register_agent (
      .clk_i,
      .rst_ni            (rst_n),
      .address_i         (register_address_i),
      .read_i            (register_read_i),
      .readdata_o        (register_readdata_o),
      .write_i           (register_write_i),
      .writedata_i       (register_writedata_i),
      .clear_o           (clear),
      .enable_o          (enable),
      .interrupt_enable_o(interrupt_enable),
      .low_water_o       (low_water),
      .clear_interrupts_o(clear_interrupts),
      .clear_errors_o    (clear_errors),
      .status_i          (status),
      .interrupts_i      (interrupts),
      .errors_i          (errors),
      .fence_i           (fence),
      .triangles_i       (triangles),
      .pixels_tested_i   (pixels_tested),
      .pixels_written_i  (pixels_written),
      .busy_cycles_i     (busy_cycles),
      .stalled_cycles_i  (stalled_cycles),
      .frames_shown_i    (frames_shown),
      .bad_packets_i     (bad_packets)
  );

  fifo_agent #(
      .Patience(FifoPatience)
  ) u_fifo_agent (
      .clk_i,
      .rst_ni       (rst_n),
      .clear_i      (clear),
      .enable_i     (enable),
      .write_i      (fifo_write_i),
      .writedata_i  (fifo_writedata_i),
      .waitrequest_o(fifo_waitrequest_o),
      .valid_o      (push_valid),
      .ready_i      (push_ready),
      .word_o       (push_word),
      .overflow_o   (overflow)
  );

  command_fifo #(
      .Depth(FifoDepth)
  ) u_fifo (
      .clk_i,
      .rst_ni (rst_n),
      .clear_i(clear),
      .valid_i(push_valid),
      .ready_o(push_ready),
      .word_i (push_word),
      .valid_o(word_valid),
      .ready_i(word_ready),
      .word_o (word),
      .level_o(level)
  );

  packet_decoder u_decoder (
      .clk_i,
      .rst_ni           (rst_n),
      .clear_i          (clear),
      .enable_i         (enable),
      .word_valid_i     (word_valid),
      .word_ready_o     (word_ready),
      .word_i           (word),
      .primitive_valid_o(primitive_valid),
      .primitive_ready_i(primitive_ready),
      .primitive_o      (new_primitive),
      .swap_valid_o     (swap_valid),
      .swap_ready_i     (swap_ready),
      .fence_valid_o    (fence_valid),
      .fence_ready_i    (fence_ready),
      .fence_tag_o      (fence_tag),
      .mid_packet_o     (mid_packet),
      .bad_packet_o     (bad_packet)
  );

  traversal #(
      .PixelUnits(PixelUnits)
  ) u_traversal (
      .clk_i,
      .rst_ni     (rst_n),
      .clear_i    (clear),
      .valid_i    (primitive_valid),
      .ready_o    (primitive_ready),
      .primitive_i(new_primitive),
      .valid_o    (tile_valid),
      .tile_o     (tile),
      .constants_o(constants),
      .idle_o     (traversal_idle)
  );

  tile_evaluator #(
      .PixelUnits(PixelUnits)
  ) u_evaluator (
      .clk_i,
      .rst_ni      (rst_n),
      .clear_i     (clear),
      .valid_i     (tile_valid),
      .tile_i      (tile),
      .constants_i (constants),
      .covered_o   (covered),
      .depth_o     (pixel_depth),
      .index_o     (index),
      .plane_o     (pixel_plane),
      .threshold_o (threshold),
      .colour_o    (colour),
      .mode_o      (mode),
      .idle_o      (evaluator_idle)
  );

  genvar k;
  generate
  for (k = 0; k < PixelUnits; k++) begin : g_unit
    pixel_unit #(
        .PixelUnits(PixelUnits)
    ) u_unit (
        .clk_i,
        .rst_ni       (rst_n),
        .clear_i      (clear),
        .covered_i    (covered[k]),
        .mode_i       (mode),
        .index_i      (index[IndexWidth-1:0]),
        .depth_i      (pixel_depth[k]),
        .plane_i      (pixel_plane[k]),
        .threshold_i  (threshold[k]),
        .colour_i     (colour),
        .back_buffer_i(!front),
        .tested_o     (tested[k]),
        .written_o    (written[k]),
        .idle_o       (unit_idle[k]),
        .vga_clk_i,
        .vga_index_i  (vga_index),
        .vga_buffer_i (vga_buffer),
        .vga_colour_o (vga_colour[k])
    );
  end
  endgenerate

  assign drained = traversal_idle && evaluator_idle && (&unit_idle) && counters_idle;
  assign busy    = !drained || primitive_valid || swap_valid || fence_valid || mid_packet;

  buffer_control u_buffer_control (
      .clk_i,
      .rst_ni       (rst_n),
      .clear_i      (clear),
      .drained_i    (drained),
      .swap_window_i(swap_window),
      .swap_valid_i (swap_valid),
      .swap_ready_o (swap_ready),
      .fence_valid_i(fence_valid),
      .fence_ready_o(fence_ready),
      .fence_tag_i  (fence_tag),
      .front_o      (front),
      .swapped_o    (swapped),
      .fenced_o     (fenced),
      .fence_o      (fence)
  );

  counters #(
      .PixelUnits(PixelUnits)
  ) u_counters (
      .clk_i,
      .rst_ni          (rst_n),
      .clear_i         (clear),
      .triangle_i      (primitive_valid && primitive_ready && new_primitive.mode.counted),
      .tested_i        (tested),
      .written_i       (written),
      .busy_i          (busy),
      .stalled_i       (swap_valid && drained && !swap_ready),
      .swapped_i       (swapped),
      .bad_packet_i    (bad_packet),
      .triangles_o     (triangles),
      .pixels_tested_o (pixels_tested),
      .pixels_written_o(pixels_written),
      .busy_cycles_o   (busy_cycles),
      .stalled_cycles_o(stalled_cycles),
      .frames_shown_o  (frames_shown),
      .bad_packets_o   (bad_packets),
      .idle_o          (counters_idle)
  );

  interrupts #(
      .LevelWidth(LevelWidth)
  ) u_interrupts (
      .clk_i,
      .rst_ni            (rst_n),
      .clear_i           (clear),
      .level_i           (level),
      .low_water_i       (low_water),
      .swapped_i         (swapped),
      .fenced_i          (fenced),
      .bad_packet_i      (bad_packet),
      .overflow_i        (overflow),
      .clear_interrupts_i(clear_interrupts),
      .clear_errors_i    (clear_errors),
      .enable_i          (interrupt_enable),
      .interrupts_o      (interrupts),
      .errors_o          (errors),
      .irq_o
  );

  always_comb begin
    status                = '0;
    status.fifo_free      = 16'(FifoDepth) - 16'(level);
    status.busy           = busy || level != '0;
    status.front_buffer   = front;
    status.vertical_blank = vertical_blank;
    status.swap_pending   = swap_valid;
    status.error          = errors != '0;
    status.mid_packet     = mid_packet;
  end

  synchronizer #(
      .Width(2)
  ) u_to_vga (
      .clk_i  (vga_clk_i),
      .rst_ni (vga_rst_n),
      .level_i({front, test_pattern_i}),
      .level_o({vga_front, vga_test_pattern})
  );

  synchronizer #(
      .Width(2)
  ) u_from_vga (
      .clk_i,
      .rst_ni (rst_n),
      .level_i({vga_vertical_blank, vga_swap_window}),
      .level_o({vertical_blank, swap_window})
  );

  vga_scanout #(
      .PixelUnits(PixelUnits)
  ) u_scanout (
      .clk_i           (vga_clk_i),
      .rst_ni          (vga_rst_n),
      .front_i         (vga_front),
      .test_pattern_i  (vga_test_pattern),
      .index_o         (vga_index),
      .buffer_o        (vga_buffer),
      .colour_i        (vga_colour),
      .vertical_blank_o(vga_vertical_blank),
      .swap_window_o   (vga_swap_window),
      .red_o           (vga_red_o),
      .green_o         (vga_green_o),
      .blue_o          (vga_blue_o),
      .hsync_no        (vga_hsync_no),
      .vsync_no        (vga_vsync_no),
      .blank_no        (vga_blank_no)
  );

  // No sync on green.
  assign vga_sync_no = 1'b0;

endmodule

`default_nettype wire
