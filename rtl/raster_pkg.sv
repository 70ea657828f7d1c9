// Types that the rasterizer's stages hand to each other, and how the screen is cut into tiles.
//
// A tile is what the pixel units draw in one clock: 1x1, 2x1, 2x2 or 4x2 pixels for 1, 2, 4 or 8
// units, aligned to the screen's upper left corner. Unit k owns the pixels with
// x mod tile_width = k mod tile_width and y mod tile_height = k / tile_width.
`default_nettype none

package raster_pkg;

  import halfspace_pkg::*;

  localparam int unsigned Edges = 3;

  function automatic int unsigned tile_width(int unsigned pixel_units);
    return (pixel_units >= 8) ? 4 : (pixel_units >= 2) ? 2 : 1;
  endfunction

  function automatic int unsigned tile_height(int unsigned pixel_units);
    return (pixel_units >= 4) ? 2 : 1;
  endfunction

  // An edge value or a depth, modulo 2^32.
  typedef logic signed [31:0] value_t;
  // A colour's three channels, or their steps: Q9.12, each modulo 2^21.
  typedef logic [ChannelBits-1:0] channel_t;
  typedef struct packed {
    channel_t blue;
    channel_t green;
    channel_t red;
  } channels_t;
  // The integer parts, modulo 512.
  typedef logic [ChannelBits-ColourFractionBits-1:0] whole_t;
  typedef struct packed {
    whole_t blue;
    whole_t green;
    whole_t red;
  } wholes_t;

  // An edge's step from pixel to pixel. The third edge's is minus the sum of two 16-bit ones.
  typedef logic signed [17:0] step_t;
  // The number of a tile column, of a tile row, and of a tile (row-major), for up to 320x240 tiles.
  typedef logic [8:0] column_t;
  typedef logic [7:0] row_t;
  typedef logic [16:0] index_t;

  // What a primitive's covered pixels do.
  typedef struct packed {
    logic counted;      // a triangle; 0: a clear
    logic depth_test;   // 0: every pixel passes
    logic depth_write;  // passing pixels replace depth
    logic colour_write; // passing pixels replace colour
    logic depth_grey;   // the colour is 255 minus the depth's upper byte, dithered; else
    logic shaded;       // it is the planes', dithered; else it is `colour`
  } pixel_mode_t;

  // A triangle as its packet gives it, or a clear: the whole screen, edges and steps 0.
  typedef struct packed {
    pixel_mode_t          mode;
    logic [7:0]           colour;
    channels_t            plane;         // at the centre of the box's upper left pixel
    channels_t            plane_step_x;
    channels_t            plane_step_y;
    column_t              first_column;  // the box, in pixels, both ends inclusive
    column_t              last_column;
    row_t                 first_row;
    row_t                 last_row;
    value_t [Edges-1:0]   edge_value;    // at the centre of the box's upper left pixel
    step_t [Edges-1:0]    step_x;
    step_t [Edges-1:0]    step_y;
    value_t               depth;
    value_t               depth_step_x;
    value_t               depth_step_y;
  } primitive_t;

  // What stays the same over a primitive.
  typedef struct packed {
    pixel_mode_t        mode;
    logic               exhaustive;    // visit every tile of the box: edge values might wrap
    logic [7:0]         colour;
    channels_t          plane_step_x;
    channels_t          plane_step_y;
    column_t            first_column;  // the box, in tiles
    column_t            last_column;
    logic [1:0]         left;          // pixels of the first tile column left of the box
    logic [1:0]         right;         // last pixel of the last tile column inside the box
    logic               top;           // whether the first tile row's upper pixel row is above the box
    logic               bottom;        // last pixel row of the last tile row inside the box
    step_t [Edges-1:0]  step_x;
    step_t [Edges-1:0]  step_y;
    value_t [Edges-1:0] reach;         // an edge's largest value in a tile minus that at its origin
    value_t             depth_step_x;
    value_t             depth_step_y;
  } constants_t;

  // A place on the screen: a tile, with each edge's largest value in it, and depth and colour at
  // its upper left pixel.
  typedef struct packed {
    value_t [Edges-1:0] largest;
    value_t             depth;
    channels_t          plane;
    column_t            column;
    logic [1:0]         row;      // of the tile, modulo 4
    index_t             index;
  } place_t;

  // A tile row of a primitive, standing at its first tile that may be covered.
  typedef struct packed {
    logic   first;  // first row of a primitive: its constants come with it
    logic   top;    // first tile row of the box
    logic   bottom; // last tile row of the box
    place_t place;
  } span_start_t;

  // A tile to draw.
  typedef struct packed {
    logic   at_left;   // in the box's first tile column, and so on
    logic   at_right;
    logic   at_top;
    logic   at_bottom;
    place_t place;
  } tile_t;

  // Channel by channel.
  function automatic channels_t sum(channels_t a, channels_t b);
    return '{red: a.red + b.red, green: a.green + b.green, blue: a.blue + b.blue};
  endfunction

  function automatic channels_t difference(channels_t a, channels_t b);
    return '{red: a.red - b.red, green: a.green - b.green, blue: a.blue - b.blue};
  endfunction

  // 0, 1, 2 or 3 times each channel.
  function automatic channels_t channels_times(channels_t value, logic [1:0] factor);
    channels_t doubled;
    doubled = '{red: value.red << 1, green: value.green << 1, blue: value.blue << 1};
    return sum(factor[0] ? value : '0, factor[1] ? doubled : '0);
  endfunction

  // A tile's width or height times each channel's step.
  function automatic channels_t channels_across(channels_t step, int unsigned pixels);
    int unsigned shift;
    shift = $clog2(pixels);
    return '{red: step.red << shift, green: step.green << shift, blue: step.blue << shift};
  endfunction

endpackage

`default_nettype wire
