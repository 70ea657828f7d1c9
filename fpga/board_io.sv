// The board's keys, switches, lights and displays on the bus: Avalon-MM, 32 bits, read latency 1, never waits.
//
// The address counts words. Inputs cross through a `synchronizer` and are read as they are: nothing
// debounces here. A write to a read-only register or to an address without one is ignored, a read
// there gives 0. Reset turns all lights and displays off.
// Pins of keys and displays are active low, registers active high.
`default_nettype none

module board_io (
    input  logic        clk_i,
    input  logic        rst_ni,

    input  logic [2:0]  address_i,
    input  logic        read_i,
    output logic [31:0] readdata_o,
    input  logic        write_i,
    input  logic [31:0] writedata_i,

    input  logic [3:0]  keys_ni,
    input  logic [9:0]  switches_i,
    output logic [9:0]  leds_o,
    output logic [6:0]  hex0_no,
    output logic [6:0]  hex1_no,
    output logic [6:0]  hex2_no,
    output logic [6:0]  hex3_no,
    output logic [6:0]  hex4_no,
    output logic [6:0]  hex5_no
);

  import board_io_pkg::*;

  logic [3:0] keys_n;
  logic [9:0] switches;

  keys_t keys;
  switches_t switch_positions;
  leds_t leds_q, leds_d, leds_written;
  hex_low_t hex_low_q, hex_low_d, hex_low_written;
  hex_high_t hex_high_q, hex_high_d, hex_high_written;
  logic [31:0] readdata_q, readdata_d;
  logic [7:0] offset;

  synchronizer #(
      .Width(14)
  ) u_inputs (
      .clk_i,
      .rst_ni,
      .level_i({keys_ni, switches_i}),
      .level_o({keys_n, switches})
  );

  assign offset = {3'b000, address_i, 2'b00};

  always_comb begin
    keys                = '0;
    keys.pressed        = ~keys_n;
    switch_positions    = '0;
    switch_positions.up = switches;
    case (offset)
      RegKeys: readdata_d = keys;
      RegSwitches: readdata_d = switch_positions;
      RegLeds: readdata_d = leds_q;
      RegHexLow: readdata_d = hex_low_q;
      RegHexHigh: readdata_d = hex_high_q;
      default: readdata_d = '0;
    endcase
  end

  // Bits without a meaning read 0.
  always_comb begin
    leds_written     = leds_t'(writedata_i);
    hex_low_written  = hex_low_t'(writedata_i);
    hex_high_written = hex_high_t'(writedata_i);
    leds_d           = leds_q;
    hex_low_d        = hex_low_q;
    hex_high_d       = hex_high_q;
    if (write_i && offset == RegLeds) begin
      leds_d.lit = leds_written.lit;
    end
    if (write_i && offset == RegHexLow) begin
      hex_low_d.hex0 = hex_low_written.hex0;
      hex_low_d.hex1 = hex_low_written.hex1;
      hex_low_d.hex2 = hex_low_written.hex2;
      hex_low_d.hex3 = hex_low_written.hex3;
    end
    if (write_i && offset == RegHexHigh) begin
      hex_high_d.hex4 = hex_high_written.hex4;
      hex_high_d.hex5 = hex_high_written.hex5;
    end
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      leds_q     <= '0;
      hex_low_q  <= '0;
      hex_high_q <= '0;
      readdata_q <= '0;
    end else begin
      leds_q     <= leds_d;
      hex_low_q  <= hex_low_d;
      hex_high_q <= hex_high_d;
      if (read_i) readdata_q <= readdata_d;
    end
  end

  assign readdata_o = readdata_q;
  assign leds_o     = leds_q.lit;
  assign hex0_no    = ~hex_low_q.hex0;
  assign hex1_no    = ~hex_low_q.hex1;
  assign hex2_no    = ~hex_low_q.hex2;
  assign hex3_no    = ~hex_low_q.hex3;
  assign hex4_no    = ~hex_high_q.hex4;
  assign hex5_no    = ~hex_high_q.hex5;

endmodule

`default_nettype wire
