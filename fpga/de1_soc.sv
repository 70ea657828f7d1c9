// The DE1-SoC's FPGA: the Platform Designer system, its clocks' locks and VGA's clock pin.
//
// Everything else is in the system (`system.tcl`): the processor and its two bridges, both PLLs, the
// rasterizer and the board's inputs and outputs. SW9 up shows a test pattern that needs no software.
// Port names are the board's. HPS_DDR3_* are the processor's own pins; they are here because its
// component brings them out, and what they do is the preloader's matter.
`default_nettype none

module de1_soc (
    input  wire         CLOCK_50,

    input  wire  [3:0]  KEY,
    input  wire  [9:0]  SW,
    output logic [9:0]  LEDR,
    output logic [6:0]  HEX0,
    output logic [6:0]  HEX1,
    output logic [6:0]  HEX2,
    output logic [6:0]  HEX3,
    output logic [6:0]  HEX4,
    output logic [6:0]  HEX5,

    output logic        VGA_CLK,
    output logic [7:0]  VGA_R,
    output logic [7:0]  VGA_G,
    output logic [7:0]  VGA_B,
    output logic        VGA_HS,
    output logic        VGA_VS,
    output logic        VGA_BLANK_N,
    output logic        VGA_SYNC_N,

    output logic [14:0] HPS_DDR3_ADDR,
    output logic [2:0]  HPS_DDR3_BA,
    output logic        HPS_DDR3_CAS_N,
    output logic        HPS_DDR3_CKE,
    output logic        HPS_DDR3_CK_N,
    output logic        HPS_DDR3_CK_P,
    output logic        HPS_DDR3_CS_N,
    output logic [3:0]  HPS_DDR3_DM,
    inout  wire  [31:0] HPS_DDR3_DQ,
    inout  wire  [3:0]  HPS_DDR3_DQS_N,
    inout  wire  [3:0]  HPS_DDR3_DQS_P,
    output logic        HPS_DDR3_ODT,
    output logic        HPS_DDR3_RAS_N,
    output logic        HPS_DDR3_RESET_N,
    input  wire         HPS_DDR3_RZQ,
    output logic        HPS_DDR3_WE_N
);

  logic bus_locked, vga_locked;
  logic vga_clk;

  halfspace_system u_system (
      .clk_clk              (CLOCK_50),
      // The PLLs run from configuration on; all else waits until both have locked.
      .reset_reset_n        (1'b1),
      .bus_pll_locked_export(bus_locked),
      .vga_pll_locked_export(vga_locked),
      .lock_reset_n         (bus_locked && vga_locked),

      .vga_clk_clk          (vga_clk),
      .vga_red              (VGA_R),
      .vga_green            (VGA_G),
      .vga_blue             (VGA_B),
      .vga_hsync_n          (VGA_HS),
      .vga_vsync_n          (VGA_VS),
      .vga_blank_n          (VGA_BLANK_N),
      .vga_sync_n           (VGA_SYNC_N),
      .vga_test_pattern     (SW[9]),

      .board_keys_n         (KEY),
      .board_switches       (SW),
      .board_leds           (LEDR),
      .board_hex0_n         (HEX0),
      .board_hex1_n         (HEX1),
      .board_hex2_n         (HEX2),
      .board_hex3_n         (HEX3),
      .board_hex4_n         (HEX4),
      .board_hex5_n         (HEX5),

      .memory_mem_a         (HPS_DDR3_ADDR),
      .memory_mem_ba        (HPS_DDR3_BA),
      .memory_mem_cas_n     (HPS_DDR3_CAS_N),
      .memory_mem_cke       (HPS_DDR3_CKE),
      .memory_mem_ck_n      (HPS_DDR3_CK_N),
      .memory_mem_ck        (HPS_DDR3_CK_P),
      .memory_mem_cs_n      (HPS_DDR3_CS_N),
      .memory_mem_dm        (HPS_DDR3_DM),
      .memory_mem_dq        (HPS_DDR3_DQ),
      .memory_mem_dqs_n     (HPS_DDR3_DQS_N),
      .memory_mem_dqs       (HPS_DDR3_DQS_P),
      .memory_mem_odt       (HPS_DDR3_ODT),
      .memory_mem_ras_n     (HPS_DDR3_RAS_N),
      .memory_mem_reset_n   (HPS_DDR3_RESET_N),
      .memory_oct_rzqin     (HPS_DDR3_RZQ),
      .memory_mem_we_n      (HPS_DDR3_WE_N)
  );

  // The converter takes a pixel at its clock's rising edge; pixels change at vga_clk's. So the pin
  // gets vga_clk inverted, from an output register like the pixels' own.
  altddio_out #(
      .extend_oe_disable     ("OFF"),
      .intended_device_family("Cyclone V"),
      .invert_output         ("OFF"),
      .lpm_hint              ("UNUSED"),
      .lpm_type              ("altddio_out"),
      .oe_reg                ("UNREGISTERED"),
      .power_up_high         ("OFF"),
      .width                 (1)
  ) u_vga_clock_pin (
      .outclock  (vga_clk),
      .datain_h  (1'b0),
      .datain_l  (1'b1),
      .dataout   (VGA_CLK),
      .aclr      (1'b0),
      .aset      (1'b0),
      .oe        (1'b1),
      .oe_out    (),
      .outclocken(1'b1),
      .sclr      (1'b0),
      .sset      (1'b0)
  );

endmodule

`default_nettype wire
