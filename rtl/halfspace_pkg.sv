// Registers, packets and number formats of the contract between software and FPGA.
// Generated from the crate fpga-regs by `cargo xtask generate`: change it there.
`default_nettype none

package halfspace_pkg;

  // Sizes and formats.
  localparam int unsigned Width = 320;  // pixels
  localparam int unsigned Height = 240;  // pixels
  localparam int unsigned SubpixelBits = 4;  // fraction bits of a screen coordinate
  localparam int unsigned DepthFractionBits = 12;  // fraction bits of depth in a packet
  localparam int unsigned ColourFractionBits = 12;  // fraction bits of a colour channel in a packet
  localparam int unsigned ChannelBits = 21;  // bits of a colour channel in a packet
  localparam int unsigned DepthFar = 65535;  // far plane, and what a clear leaves
  localparam int unsigned GuardBand = 8191;  // largest magnitude of a vertex's coordinate, sub-pixels
  localparam int unsigned FifoApertureWords = 1024;  // address space of the FIFO agent
  localparam logic [15:0][3:0] Dither = 64'h5d7f91b36e4ca280;  // thresholds of ordered dithering, by 4 y + x

  // Registers: byte offsets from the agent's start.
  localparam logic [31:0] IdHalf = 32'h48414c46;  // what ID reads: "HALF"
  localparam logic [15:0] VersionMajor = 16'd1;  // changes with incompatible changes
  localparam logic [15:0] VersionMinor = 16'd0;  // grows with compatible additions
  typedef enum logic [7:0] {
    RegId = 8'h00,
    RegVersion = 8'h04,
    RegCapabilities = 8'h08,
    RegScreen = 8'h0c,
    RegControl = 8'h10,
    RegStatus = 8'h14,
    RegLowWater = 8'h18,
    RegInterrupts = 8'h1c,
    RegErrors = 8'h20,
    RegFence = 8'h24,
    RegTriangles = 8'h28,
    RegPixelsTested = 8'h2c,
    RegPixelsWritten = 8'h30,
    RegBusyCycles = 8'h34,
    RegStalledCycles = 8'h38,
    RegFramesShown = 8'h3c,
    RegBadPackets = 8'h40
  } register_e;

  // Version of the contract.
  typedef struct packed {
    logic [15:0] major;  // Major version; software refuses any but its own.
    logic [15:0] minor;  // Minor version; grows with compatible additions.
  } version_t;

  // What this build has.
  typedef struct packed {
    logic [6:0] unused_25;
    logic [0:0] interrupt;  // Whether the low-water interrupt is wired to the processor.
    logic [7:0] pixel_units;  // Pixel units: pixels drawn a clock at most.
    logic [15:0] fifo_depth;  // FIFO depth in words, at least twice the longest packet's.
  } capabilities_t;

  // Framebuffer size.
  typedef struct packed {
    logic [15:0] height;  // Height in pixels.
    logic [15:0] width;  // Width in pixels.
  } screen_t;

  // Enable, reset and interrupt enables.
  typedef struct packed {
    logic [19:0] unused_12;
    logic [0:0] error_interrupt;  // Interrupt on any bit of ERRORS.
    logic [0:0] fence_interrupt;  // Interrupt when a fence was passed.
    logic [0:0] swap_interrupt;  // Interrupt when a swap took place.
    logic [0:0] low_water_interrupt;  // Interrupt when the FIFO's level falls to LOW_WATER.
    logic [5:0] unused_2;
    logic [0:0] reset;  // Empties the FIFO, forgets the packet under way, clears LOW_WATER, INTERRUPTS, ERRORS, FENCE and all counters; reads 1 until done. The buffers keep their pixels and the front one stays in front; a triangle or clear under way may stay half drawn. The other bits of the same write take effect after it.
    logic [0:0] enable;  // Takes words from the FIFO. While 0 the FIFO fills and nothing is drawn; a packet of which some words have come waits for the others.
  } control_t;

  // FIFO space and state.
  typedef struct packed {
    logic [9:0] unused_22;
    logic [0:0] mid_packet;  // The stream stands inside a packet: its header has come, not yet all of its words.
    logic [0:0] error;  // Some bit of ERRORS is set.
    logic [0:0] swap_pending;  // A swap waits for the vertical blank.
    logic [0:0] vertical_blank;  // VGA is in its vertical blank.
    logic [0:0] front_buffer;  // The buffer that VGA shows: 0 or 1.
    logic [0:0] busy;  // A packet is under way, one that still lacks words included, or the FIFO holds words.
    logic [15:0] fifo_free;  // Words the FIFO takes before it is full.
  } status_t;

  // Interrupt status. A bit is set whether or not CONTROL enables its interrupt.
  typedef struct packed {
    logic [27:0] unused_4;
    logic [0:0] error;  // Something that ERRORS flags happened, whether or not its flag was set already.
    logic [0:0] fence;  // A fence was passed.
    logic [0:0] swap;  // A swap took place.
    logic [0:0] low_water;  // The FIFO's level fell to LOW_WATER.
  } interrupts_t;

  // Error flags.
  typedef struct packed {
    logic [29:0] unused_2;
    logic [0:0] fifo_overflow;  // A word came while the FIFO was full and the device disabled, or had waited at the full FIFO for 2^22 clocks of the bus, or came after such a one before the FIFO had space again; it was dropped.
    logic [0:0] bad_packet;  // A packet of unknown kind, wrong length, with a reserved bit set or a box outside the screen. It was skipped by its length.
  } errors_t;

  // Packets: a header and as many words as its length says.
  typedef enum logic [7:0] {
    KindClear = 8'h01,
    KindFlatTriangle = 8'h02,
    KindGouraudTriangle = 8'h03,
    KindSwap = 8'h10,
    KindFence = 8'h11
  } kind_e;

  localparam int unsigned ClearWords = 1;  // words behind the header
  localparam int unsigned FlatTriangleWords = 10;  // words behind the header
  localparam int unsigned GouraudTriangleWords = 16;  // words behind the header
  localparam int unsigned SwapWords = 0;  // words behind the header
  localparam int unsigned FenceWords = 1;  // words behind the header
  localparam int unsigned PayloadWordsMax = 16;  // words behind the longest packet's header
  localparam int unsigned ShapeWords = 10;  // words of a shape, a triangle packet's last ones

  // The word that every packet starts with.
  typedef struct packed {
    logic [7:0] kind;  // What the packet asks for.
    logic [7:0] length;  // How many words follow.
    logic [4:0] reserved;  // Zero; room for later modes.
    logic [0:0] depth_grey;  // Triangles only: the colour is the depth as grey, the farther the darker.
    logic [0:0] keep_colour;  // Triangles only: leaves colour as it is.
    logic [0:0] keep_depth;  // Triangles only: tests no depth and leaves depth as it is.
    logic [7:0] colour;  // RGB332 colour of a clear or a flat triangle; zero in other kinds.
  } header_t;

  localparam int unsigned ClearDepthWord = 0;  // The depth that a clear fills with.
  // The depth that a clear fills with.
  typedef struct packed {
    logic [15:0] reserved;  // Zero.
    logic [15:0] depth;  // Depth, 0 (near) to 65,535 (far).
  } clear_depth_t;

  localparam int unsigned FlatTriangleColumnsWord = 0;  // Columns of the box.
  // Columns of the box.
  typedef struct packed {
    logic [15:0] last;  // Last pixel.
    logic [15:0] first;  // First pixel.
  } span_t;

  localparam int unsigned FlatTriangleRowsWord = 1;  // Rows of the box.
  localparam int unsigned FlatTriangleEdge0Word = 2;  // Edge 0 at the box's upper left pixel centre, signed.
  localparam int unsigned FlatTriangleEdge1Word = 3;  // Edge 1 there.
  localparam int unsigned FlatTriangleEdge2Word = 4;  // Edge 2 there.
  localparam int unsigned FlatTriangleSteps0Word = 5;  // Steps of edge 0.
  // Steps of edge 0.
  typedef struct packed {
    logic signed [15:0] step_y;  // B: what one row down adds.
    logic signed [15:0] step_x;  // A: what one pixel to the right adds.
  } edge_steps_t;

  localparam int unsigned FlatTriangleSteps1Word = 6;  // Steps of edge 1; edge 2's are minus the sum of both.
  localparam int unsigned FlatTriangleDepthWord = 7;  // Depth at the box's upper left pixel centre, signed Q20.12 modulo 2^32.
  localparam int unsigned FlatTriangleDepthStepXWord = 8;  // Depth step of one pixel to the right.
  localparam int unsigned FlatTriangleDepthStepYWord = 9;  // Depth step of one row down.
  localparam int unsigned GouraudTriangleColourLowWord = 0;  // Colour at the box's upper left pixel centre: red, lower part of green.
  // Colour at the box's upper left pixel centre: red, lower part of green.
  typedef struct packed {
    logic [10:0] green_low;  // Bits 10…0 of green, Q9.12 modulo 2^21.
    logic [20:0] red;  // Red, Q9.12 modulo 2^21.
  } channels_low_t;

  localparam int unsigned GouraudTriangleColourHighWord = 1;  // Upper part of green, blue.
  // Upper part of green, blue.
  typedef struct packed {
    logic [0:0] reserved;  // Zero.
    logic [20:0] blue;  // Blue, Q9.12 modulo 2^21.
    logic [9:0] green_high;  // Bits 20…11 of green.
  } channels_high_t;

  localparam int unsigned GouraudTriangleColourStepXLowWord = 2;  // Colour step of one pixel to the right.
  localparam int unsigned GouraudTriangleColourStepXHighWord = 3;  // Its upper part.
  localparam int unsigned GouraudTriangleColourStepYLowWord = 4;  // Colour step of one row down.
  localparam int unsigned GouraudTriangleColourStepYHighWord = 5;  // Its upper part.
  localparam int unsigned GouraudTriangleColumnsWord = 6;  // Columns of the box.
  localparam int unsigned GouraudTriangleRowsWord = 7;  // Rows of the box.
  localparam int unsigned GouraudTriangleEdge0Word = 8;  // Edge 0 at the box's upper left pixel centre, signed.
  localparam int unsigned GouraudTriangleEdge1Word = 9;  // Edge 1 there.
  localparam int unsigned GouraudTriangleEdge2Word = 10;  // Edge 2 there.
  localparam int unsigned GouraudTriangleSteps0Word = 11;  // Steps of edge 0.
  localparam int unsigned GouraudTriangleSteps1Word = 12;  // Steps of edge 1; edge 2's are minus the sum of both.
  localparam int unsigned GouraudTriangleDepthWord = 13;  // Depth at the box's upper left pixel centre, signed Q20.12 modulo 2^32.
  localparam int unsigned GouraudTriangleDepthStepXWord = 14;  // Depth step of one pixel to the right.
  localparam int unsigned GouraudTriangleDepthStepYWord = 15;  // Depth step of one row down.
  localparam int unsigned FenceTagWord = 0;  // Any 32-bit number.
endpackage

`default_nettype wire
