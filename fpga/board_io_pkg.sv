// Registers of the board's keys, switches, lights and displays: byte offsets and fields.
// Generated from the crate fpga-regs by `cargo xtask generate`: change it there.
`default_nettype none

package board_io_pkg;

  typedef enum logic [7:0] {
    RegKeys = 8'h00,
    RegSwitches = 8'h04,
    RegLeds = 8'h08,
    RegHexLow = 8'h0c,
    RegHexHigh = 8'h10
  } register_e;

  // Push buttons: which are pressed.
  typedef struct packed {
    logic [27:0] unused_4;
    logic [3:0] pressed;  // A bit for each button, KEY0 in bit 0; 1 while it is pressed.
  } keys_t;

  // Slide switches: which are up.
  typedef struct packed {
    logic [21:0] unused_10;
    logic [9:0] up;  // A bit for each switch, SW0 in bit 0; 1 while it is up.
  } switches_t;

  // Red LEDs: which are lit.
  typedef struct packed {
    logic [21:0] unused_10;
    logic [9:0] lit;  // A bit for each LED, LEDR0 in bit 0; 1 lights it.
  } leds_t;

  // Segments of HEX0 to HEX3.
  typedef struct packed {
    logic [0:0] unused_31;
    logic [6:0] hex3;  // HEX3.
    logic [0:0] unused_23;
    logic [6:0] hex2;  // HEX2.
    logic [0:0] unused_15;
    logic [6:0] hex1;  // HEX1.
    logic [0:0] unused_7;
    logic [6:0] hex0;  // HEX0, the rightmost.
  } hex_low_t;

  // Segments of HEX4 and HEX5.
  typedef struct packed {
    logic [16:0] unused_15;
    logic [6:0] hex5;  // HEX5, the leftmost.
    logic [0:0] unused_7;
    logic [6:0] hex4;  // HEX4.
  } hex_high_t;

endpackage

`default_nettype wire
