// One pixel of every tile: its depth memory, its part of both colour buffers, and the depth test.
//
// Takes a pixel a clock and is never held back. Stages, counted on from the evaluator's two:
//   3  entered with depth and colour saturated and the old depth read; compares, dithers
//   4  writes depth and colour
// A pixel that enters one or two clocks behind another of the same place has read the memory
// before that one's write; it compares with the write itself instead (forwarding).
// Latency from input to memory 3 clocks. `tested_o` and `written_o` come with stage 4.
//
// The colour memory is read on VGA's clock: latency 1 from index and buffer to colour.
`default_nettype none

module pixel_unit #(
    parameter int unsigned PixelUnits = 8,
    // Follows from the others; never given.
    parameter int unsigned IndexWidth = $clog2(halfspace_pkg::Width * halfspace_pkg::Height / PixelUnits)
) (
    input  logic                  clk_i,
    input  logic                  rst_ni,
    input  logic                  clear_i,

    input  logic                  covered_i,
    input  raster_pkg::pixel_mode_t mode_i,
    input  logic [IndexWidth-1:0] index_i,
    input  raster_pkg::value_t    depth_i,
    input  raster_pkg::wholes_t   plane_i,        // the colour of a shaded pixel
    input  logic [3:0]            threshold_i,    // its dither
    input  logic [7:0]            colour_i,       // the colour of another
    input  logic                  back_buffer_i,  // may change only while idle_o is 1

    output logic                  tested_o,
    output logic                  written_o,
    output logic                  idle_o,

    input  logic                  vga_clk_i,
    input  logic [IndexWidth-1:0] vga_index_i,
    input  logic                  vga_buffer_i,
    output logic [7:0]            vga_colour_o
);

  import halfspace_pkg::*;
  import raster_pkg::*;

  localparam int unsigned Pixels = Width * Height / PixelUnits;

  logic covered3_q;
  pixel_mode_t mode3_q;
  logic [IndexWidth-1:0] index3_q;
  logic [15:0] depth3_q, depth3_d;
  logic [7:0] red3_q, green3_q, blue3_q;  // scaled: 224, 224 and 192 are full
  logic [3:0] threshold3_q;
  logic [7:0] colour3_q;
  logic [15:0] depth_read;
  logic [2:0][7:0] channels3_d;

  logic passed_d, tested_d;
  logic [15:0] nearest;

  logic depth_write4_q, colour_write4_q, tested4_q, passed4_q;
  logic [IndexWidth-1:0] index4_q;
  logic [15:0] depth4_q;
  logic [7:0] colour4_q, colour4_d;

  logic depth_write5_q;
  logic [IndexWidth-1:0] index5_q;
  logic [15:0] depth5_q;

  // Bits 31...12 as a signed integer, saturated to 0...65,535.
  always_comb begin
    if (depth_i[31]) depth3_d = '0;
    else if (depth_i[30:28] != '0) depth3_d = '1;
    else depth3_d = depth_i[27:12];
  end

  // 0...255 as they are, 256...383 as 255, 384...511 as 0.
  function automatic logic [7:0] saturated(whole_t whole);
    if (!whole[8]) return whole[7:0];
    return whole[7] ? 8'd0 : 8'd255;
  endfunction

  // The sums are at most 255.
  function automatic logic [7:0] dithered(logic [7:0] red, logic [7:0] green, logic [7:0] blue,
                                          logic [3:0] threshold);
    return {3'((red + {3'b0, threshold, 1'b1}) >> 5), 3'((green + {3'b0, threshold, 1'b1}) >> 5),
            2'((blue + {2'b0, threshold, 2'b10}) >> 6)};
  endfunction

  assign channels3_d = mode_i.depth_grey ? {3{~depth3_d[15:8]}} :
      {saturated(plane_i.blue), saturated(plane_i.green), saturated(plane_i.red)};
  assign colour4_d = (mode3_q.shaded || mode3_q.depth_grey) ? dithered(red3_q, green3_q, blue3_q, threshold3_q) : colour3_q;

  always_comb begin
    if (depth_write4_q && index4_q == index3_q) nearest = depth4_q;
    else if (depth_write5_q && index5_q == index3_q) nearest = depth5_q;
    else nearest = depth_read;
  end

  assign tested_d = covered3_q && mode3_q.counted && !clear_i;
  assign passed_d = covered3_q && !clear_i && (!mode3_q.depth_test || depth3_q < nearest);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      covered3_q <= 1'b0;
      depth_write4_q  <= 1'b0;
      colour_write4_q <= 1'b0;
      tested4_q       <= 1'b0;
      passed4_q       <= 1'b0;
      depth_write5_q  <= 1'b0;
    end else begin
      covered3_q <= covered_i && !clear_i;
      depth_write4_q  <= passed_d && mode3_q.depth_write;
      colour_write4_q <= passed_d && mode3_q.colour_write;
      tested4_q       <= tested_d;
      passed4_q       <= passed_d && mode3_q.counted;
      depth_write5_q  <= depth_write4_q;
    end
  end

  always_ff @(posedge clk_i) begin
    mode3_q   <= mode_i;
    index3_q  <= index_i;
    depth3_q  <= depth3_d;
    red3_q    <= channels3_d[0] - (channels3_d[0] >> 3);
    green3_q  <= channels3_d[1] - (channels3_d[1] >> 3);
    blue3_q   <= channels3_d[2] - (channels3_d[2] >> 2);
    threshold3_q <= threshold_i;
    colour3_q <= colour_i;

    index4_q  <= index3_q;
    depth4_q  <= depth3_q;
    colour4_q <= colour4_d;

    index5_q <= index4_q;
    depth5_q <= depth4_q;
  end

  assign tested_o  = tested4_q;
  assign written_o = passed4_q;
  assign idle_o    = !covered3_q && !depth_write4_q && !colour_write4_q && !tested4_q;

  ram_1w1r #(
      .Width(16),
      .Depth(Pixels)
  ) u_depth (
      .write_clk_i    (clk_i),
      .write_i        (depth_write4_q),
      .write_address_i(index4_q),
      .write_data_i   (depth4_q),
      .read_clk_i     (clk_i),
      .read_address_i (index_i),
      .read_data_o    (depth_read)
  );

  // Both buffers in one memory, pixel by pixel in turn: no adder, and no block half empty.
  ram_1w1r #(
      .Width(8),
      .Depth(2 * Pixels)
  ) u_colour (
      .write_clk_i    (clk_i),
      .write_i        (colour_write4_q),
      .write_address_i({index4_q, back_buffer_i}),
      .write_data_i   (colour4_q),
      .read_clk_i     (vga_clk_i),
      .read_address_i ({vga_index_i, vga_buffer_i}),
      .read_data_o    (vga_colour_o)
  );

`ifndef SYNTHESIS
  always_ff @(posedge clk_i) begin
    if (rst_ni && (depth_write4_q || colour_write4_q)) assert (32'(index4_q) < Pixels) else $error("a write outside the memory");
  end
`endif

endmodule

`default_nettype wire
