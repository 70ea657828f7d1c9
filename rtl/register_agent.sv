// The registers on the bus: Avalon-MM, 32 bits, read latency 1, never waits.
//
// The address counts words. Reads change nothing. A write to a read-only register or to an address
// without one is ignored, a read there gives 0. Writes are of whole words: there is no byteenable.
//
// CONTROL.reset makes `clear_o` 1 for the one clock after the write, and reads 1 in it; the other
// bits of the same write hold from that clock on.
`default_nettype none

module register_agent #(
    parameter int unsigned PixelUnits = 8,
    parameter int unsigned FifoDepth = 1024,
    parameter bit InterruptWired = 1'b1
) (
    input  logic                       clk_i,
    input  logic                       rst_ni,

    input  logic [9:0]                 address_i,
    input  logic                       read_i,
    output logic [31:0]                readdata_o,
    input  logic                       write_i,
    input  logic [31:0]                writedata_i,

    output logic                       clear_o,
    output logic                       enable_o,
    output logic [3:0]                 interrupt_enable_o,  // in the order of INTERRUPTS
    output logic [31:0]                low_water_o,
    output logic [3:0]                 clear_interrupts_o,
    output logic [1:0]                 clear_errors_o,

    input  halfspace_pkg::status_t     status_i,
    input  halfspace_pkg::interrupts_t interrupts_i,
    input  halfspace_pkg::errors_t     errors_i,
    input  logic [31:0]                fence_i,
    input  logic [31:0]                triangles_i,
    input  logic [31:0]                pixels_tested_i,
    input  logic [31:0]                pixels_written_i,
    input  logic [31:0]                busy_cycles_i,
    input  logic [31:0]                stalled_cycles_i,
    input  logic [31:0]                frames_shown_i,
    input  logic [31:0]                bad_packets_i
);

  import halfspace_pkg::*;

  control_t control_q, control_d, written;
  logic [31:0] low_water_q, low_water_d, readdata_q, readdata_d;
  logic write_control, write_low_water, write_interrupts, write_errors;

  function automatic logic is(logic [9:0] address, register_e register);
    return {address, 2'b00} == 12'(register);
  endfunction

  assign write_control    = write_i && is(address_i, RegControl);
  assign write_low_water  = write_i && is(address_i, RegLowWater);
  assign write_interrupts = write_i && is(address_i, RegInterrupts);
  assign write_errors     = write_i && is(address_i, RegErrors);

  always_comb begin
    capabilities_t capabilities;
    version_t version;
    screen_t screen;
    capabilities             = '0;
    capabilities.fifo_depth  = 16'(FifoDepth);
    capabilities.pixel_units = 8'(PixelUnits);
    capabilities.interrupt   = InterruptWired;
    version                  = '{major: VersionMajor, minor: VersionMinor};
    screen                   = '{width: 16'(Width), height: 16'(Height)};

    readdata_d = '0;
    if (address_i[9:6] == '0) begin
      case ({address_i[5:0], 2'b00})
        RegId: readdata_d = IdHalf;
        RegVersion: readdata_d = version;
        RegCapabilities: readdata_d = capabilities;
        RegScreen: readdata_d = screen;
        RegControl: readdata_d = control_q;
        RegStatus: readdata_d = status_i;
        RegLowWater: readdata_d = low_water_q;
        RegInterrupts: readdata_d = interrupts_i;
        RegErrors: readdata_d = errors_i;
        RegFence: readdata_d = fence_i;
        RegTriangles: readdata_d = triangles_i;
        RegPixelsTested: readdata_d = pixels_tested_i;
        RegPixelsWritten: readdata_d = pixels_written_i;
        RegBusyCycles: readdata_d = busy_cycles_i;
        RegStalledCycles: readdata_d = stalled_cycles_i;
        RegFramesShown: readdata_d = frames_shown_i;
        RegBadPackets: readdata_d = bad_packets_i;
        default: readdata_d = '0;
      endcase
    end
  end

  always_comb begin
    written             = control_t'(writedata_i);
    control_d           = control_q;
    control_d.reset     = 1'b0;
    low_water_d         = low_water_q;
    if (write_control) begin
      // Bits without a meaning read 0.
      control_d                     = '0;
      control_d.enable              = written.enable;
      control_d.reset               = written.reset;
      control_d.low_water_interrupt = written.low_water_interrupt;
      control_d.swap_interrupt      = written.swap_interrupt;
      control_d.fence_interrupt     = written.fence_interrupt;
      control_d.error_interrupt     = written.error_interrupt;
    end
    if (clear_o) low_water_d = '0;
    if (write_low_water) low_water_d = writedata_i;
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      control_q   <= '0;
      low_water_q <= '0;
      readdata_q  <= '0;
    end else begin
      control_q   <= control_d;
      low_water_q <= low_water_d;
      if (read_i) readdata_q <= readdata_d;
    end
  end

  assign readdata_o         = readdata_q;
  assign clear_o            = control_q.reset;
  assign enable_o           = control_q.enable;
  assign interrupt_enable_o = {
    control_q.error_interrupt,
    control_q.fence_interrupt,
    control_q.swap_interrupt,
    control_q.low_water_interrupt
  };
  assign low_water_o        = low_water_q;
  assign clear_interrupts_o = write_interrupts ? writedata_i[3:0] : '0;
  assign clear_errors_o     = write_errors ? writedata_i[1:0] : '0;

endmodule

`default_nettype wire
