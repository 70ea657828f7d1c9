// What the proof of the traversal works out for itself about one primitive, beside the design.
`default_nettype none

package traversal_proof_pkg;

  import raster_pkg::*;

  localparam int unsigned Planes = Edges + 1;  // the edges and depth

  // A tile, and what the planes are there: an edge's largest value, depth and colour at its upper left pixel.
  typedef struct packed {
    value_t [Planes-1:0] value;
    channels_t           colour;
    column_t             column;
    row_t                row;
  } mark_t;

  // The box in tiles, and the pixels of its first and last ones that lie in it.
  typedef struct packed {
    column_t    first_column;
    column_t    last_column;
    row_t       first_row;
    row_t       last_row;
    logic [1:0] left;
    logic [1:0] right;
    logic       top;
    logic       bottom;
  } box_t;

  // Which parts of the design hold something of the primitive.
  typedef struct packed {
    logic       followed;           // there is such a primitive
    logic       setup;
    logic       walker;             // the walker's constants are its
    logic [1:0] queue;
    logic       scanner;            // the tile that is shown is its
    logic       scanner_constants;  // the scanner's constants are its
    logic       shown;              // one of its tiles has been shown
    logic       seen;               // the target has
  } presence_t;

  function automatic value_t times(value_t value, logic [1:0] factor);
    return (factor[0] ? value : '0) + (factor[1] ? value <<< 1 : '0);
  endfunction

endpackage

`default_nettype wire
