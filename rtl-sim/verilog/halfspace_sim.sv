// The device and, in simulation only, some of its state as outputs.
`default_nettype none

module halfspace_sim
  import halfspace_pkg::*;
#(
    parameter int unsigned PixelUnits = 8,
    parameter int unsigned FifoDepth = 1024,
    parameter int unsigned FifoPatience = 1 << 22,
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
    input  logic        test_pattern_i,
    output logic [7:0]  vga_red_o,
    output logic [7:0]  vga_green_o,
    output logic [7:0]  vga_blue_o,
    output logic        vga_hsync_no,
    output logic        vga_vsync_no,
    output logic        vga_blank_no,
    output logic        vga_sync_no,

    output logic                             debug_busy_o,
    output logic [15:0]                      debug_free_o,
    output logic                             debug_swap_pending_o,
    output logic                             debug_swap_waits_o,  // for the vertical blank alone
    output logic                             debug_front_o,
    output logic                             debug_tile_o
);

  halfspace #(
      .PixelUnits    (PixelUnits),
      .FifoDepth     (FifoDepth),
      .FifoPatience  (FifoPatience),
      .InterruptWired(InterruptWired)
  ) u_device (.*);

  assign debug_busy_o         = u_device.status.busy;
  assign debug_free_o         = u_device.status.fifo_free;
  assign debug_swap_pending_o = u_device.status.swap_pending;
  assign debug_swap_waits_o   = u_device.swap_valid && u_device.drained;
  assign debug_front_o        = u_device.status.front_buffer;
  assign debug_tile_o         = u_device.tile_valid;

endmodule

`default_nettype wire
