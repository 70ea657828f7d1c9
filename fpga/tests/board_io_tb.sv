// Drives the board's inputs and outputs as the bus and a hand would; the first difference ends it.
module board_io_tb;
  import board_io_pkg::*;

  logic clk = 1'b0;
  logic rst_n = 1'b0;
  logic [2:0] address = '0;
  logic read = 1'b0;
  logic write = 1'b0;
  logic [31:0] writedata = '0;
  logic [31:0] readdata;
  logic [3:0] keys_n = 4'b1111;
  logic [9:0] switches = '0;
  logic [9:0] leds;
  logic [6:0] hex0_n, hex1_n, hex2_n, hex3_n, hex4_n, hex5_n;

  board_io dut (
      .clk_i       (clk),
      .rst_ni      (rst_n),
      .address_i   (address),
      .read_i      (read),
      .readdata_o  (readdata),
      .write_i     (write),
      .writedata_i (writedata),
      .keys_ni     (keys_n),
      .switches_i  (switches),
      .leds_o      (leds),
      .hex0_no     (hex0_n),
      .hex1_no     (hex1_n),
      .hex2_no     (hex2_n),
      .hex3_no     (hex3_n),
      .hex4_no     (hex4_n),
      .hex5_no     (hex5_n)
  );

  always #5 clk = !clk;

  task automatic put(input logic [7:0] offset, input logic [31:0] value);
    @(negedge clk);
    address   = offset[4:2];
    writedata = value;
    write     = 1'b1;
    @(negedge clk);
    write = 1'b0;
  endtask

  // Latency 1: the word is there in the clock after the read.
  task automatic expect_word(input logic [7:0] offset, input logic [31:0] value);
    @(negedge clk);
    address = offset[4:2];
    read    = 1'b1;
    @(negedge clk);
    read = 1'b0;
    if (readdata !== value) $fatal(1, "offset %h reads %h instead of %h", offset, readdata, value);
  endtask

  task automatic expect_pins(input logic [9:0] lit, input logic [41:0] segments);
    if (leds !== lit) $fatal(1, "LEDs are %b instead of %b", leds, lit);
    if (~{hex5_n, hex4_n, hex3_n, hex2_n, hex1_n, hex0_n} !== segments) begin
      $fatal(1, "lit segments are %h instead of %h", ~{hex5_n, hex4_n, hex3_n, hex2_n, hex1_n, hex0_n}, segments);
    end
  endtask

  initial begin
    repeat (3) @(negedge clk);
    rst_n = 1'b1;
    // Nothing pressed, nothing lit, and nothing at addresses without a register.
    repeat (3) @(negedge clk);
    for (int unsigned offset = 0; offset < 32; offset += 4) expect_word(8'(offset), 32'h0);
    expect_pins('0, '0);

    // One key and one switch at a time.
    for (int unsigned k = 0; k < 4; k++) begin
      keys_n = ~(4'b0001 << k);
      repeat (3) @(negedge clk);
      expect_word(8'h00, 32'd1 << k);
    end
    keys_n = 4'b1111;
    for (int unsigned k = 0; k < 10; k++) begin
      switches = 10'b1 << k;
      repeat (3) @(negedge clk);
      expect_word(8'h04, 32'd1 << k);
    end

    // What is written is lit and read back; bits without a meaning read 0.
    put(8'h08, 32'hffff_f2a5);
    put(8'h0c, 32'hcfdb_86bf);
    put(8'h10, 32'hffff_edf6);
    expect_word(8'h08, 32'h0000_02a5);
    expect_word(8'h0c, 32'h4f5b_063f);
    expect_word(8'h10, 32'h0000_6d76);
    expect_pins(10'h2a5, {7'h6d, 7'h76, 7'h4f, 7'h5b, 7'h06, 7'h3f});

    // Inputs and empty addresses take no writes.
    put(8'h00, 32'hffff_ffff);
    put(8'h04, 32'hffff_ffff);
    put(8'h14, 32'hffff_ffff);
    expect_word(8'h00, 32'h0);
    expect_word(8'h04, 32'h0000_0200);
    expect_word(8'h14, 32'h0);
    expect_pins(10'h2a5, {7'h6d, 7'h76, 7'h4f, 7'h5b, 7'h06, 7'h3f});

    // Reset turns everything off.
    rst_n = 1'b0;
    @(negedge clk);
    expect_pins('0, '0);
    $display("board_io: all checks passed");
    $finish;
  end
endmodule
