// One verilated build of the device behind a C interface; compiled once for each, with BUILD (its name),
// UNITS, MODEL (the class), HEADER and ROOT_HEADER defined by build.rs.
#include <algorithm>
#include <cstdint>
#include <memory>

#include HEADER
#include ROOT_HEADER
#include "shim/falling_edges.h"
#include "shim/scan.h"
#include "shim/unwatched.h"
#include "shim/wave.h"
#include "verilated.h"

#define JOIN2(a, b, c) a##b##c
#define JOIN(a, b, c) JOIN2(a, b, c)
#define NAME(f) JOIN(halfspace_, BUILD, f)

namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 240;
constexpr int kTileWidth = UNITS >= 8 ? 4 : UNITS >= 2 ? 2 : 1;
constexpr int kTileHeight = UNITS >= 4 ? 2 : 1;
// Bus clocks that a swap waits before VGA is moved on: more words than the FIFO holds may come.
constexpr uint64_t kHurryAfter = 1500;
// VGA clocks that bring VGA from a line's end into the next line.
constexpr uint64_t kNextLine = 16;
// Where things stand in a bus clock of a wave, in picoseconds: 50 MHz, and a VGA clock that comes with it.
constexpr uint64_t kBusClock = 20000;
constexpr uint64_t kBusRises = 2000;
constexpr uint64_t kBusFalls = 10000;
constexpr uint64_t kVgaHalf = 3000;

// Bus clocks in which nothing has to change before some may be left out: longer than any pipeline here.
constexpr uint64_t kSettled = 64;
// Bus clocks that are left out at a time, about a line, and those run after them: they carry VGA's blank over.
constexpr uint64_t kLeftOut = 1560;
constexpr uint64_t kCarry = 6;

struct Sim {
  explicit Sim(uint32_t seed) : context(prepared(seed)) {}

  // No pool of threads that would only wait; all signals are kept where waves are built in. What has no
  // value at power-on gets one by the seed, where the build asks for one.
  static VerilatedContext* prepared(uint32_t seed) {
    auto* context = new VerilatedContext;
    context->threads(1);
    context->traceEverOn(VM_TRACE);
    context->randReset(2);
    // 0 would be taken for any seed.
    context->randSeed(static_cast<int>(seed % 0x7fffffff) + 1);
    return context;
  }

  std::unique_ptr<VerilatedContext> context;
  MODEL model{context.get(), "halfspace"};
  uint64_t clocks = 0;
  uint64_t vga_clocks = 0;
  uint64_t tiles = 0;
  // VGA clocks a bus clock, in 1/65,536.
  uint32_t vga_ratio = 0;
  uint32_t vga_phase = 0;
  // Whether VGA is moved to the vertical blank when a swap waits for it, so that it comes soon.
  bool hurry = true;
  uint64_t swap_waits = 0;
  // Swaps that took place, counted by the front buffer's changes.
  uint64_t swaps = 0;
  uint32_t front = 0;
  uint64_t settled = 0;
  Scan scan;
  Unwatched unwatched;
  // Ends before the model does.
  Wave wave;

  // Power-on, reset, and out of it. A falling edge of the reset is the first thing to happen.
  void start() {
    model.clk_i = model.vga_clk_i = 0;
    model.register_read_i = model.register_write_i = model.register_address_i = model.register_writedata_i = 0;
    model.fifo_read_i = model.fifo_write_i = model.fifo_address_i = model.fifo_writedata_i = 0;
    model.test_pattern_i = 0;
    model.rst_ni = 1;
    model.eval();
    for (const bool out_of_reset : {false, true}) {
      model.rst_ni = out_of_reset;
      model.eval();
      for (int i = 0; i < 4; i++) {
        clock();
        vga_clock();
      }
    }
  }

  void vga_clock() {
    model.vga_clk_i = 1;
    model.eval();
    wave.show_at(wave.time() + kVgaHalf);
    model.vga_clk_i = 0;
    if (VM_TRACE || !vga_clock_falls(model.rootp, 0)) model.eval();
    wave.show_at(wave.time() + kVgaHalf);
    vga_clocks++;
    scan.clock(model, swaps);
  }

  auto& x() { return model.rootp->halfspace_sim__DOT__u_device__DOT__u_scanout__DOT__u_timing__DOT__x_q; }
  auto& y() { return model.rootp->halfspace_sim__DOT__u_device__DOT__u_scanout__DOT__u_timing__DOT__y_q; }

  // VGA's clocks that are due after bus clocks.
  void vga_clocks_due(uint64_t bus_clocks) {
    const uint64_t phase = vga_phase + bus_clocks * vga_ratio;
    vga_phase = phase & 0xffff;
    for (uint64_t due = phase >> 16; due > 0;) {
      const uint64_t left_out = unwatched.leave_out(x(), y(), due);
      if (left_out == 0) vga_clock();
      vga_clocks += left_out;
      due -= std::max<uint64_t>(left_out, 1);
    }
  }

  // Outputs are valid, for the inputs as they stand, before and after.
  void clock() {
    wave.at_clock(clocks);
    const uint64_t begin = std::max(clocks * kBusClock, wave.time() + 1);
    wave.show_at(begin);
    model.clk_i = 1;
    model.eval();
    wave.show_at(begin + kBusRises);
    model.clk_i = 0;
    if (VM_TRACE || !bus_clock_falls(model.rootp, 0)) model.eval();
    wave.show_at(begin + kBusFalls);
    clocks++;
    tiles += model.debug_tile_o;
    swaps += model.debug_front_o != front;
    front = model.debug_front_o;
    vga_clocks_due(1);
    hurry_on();
  }

  // Runs bus clocks. Where nothing changes but time, because nothing is under way or a swap waits
  // for the blank alone, most may be left out; VGA has all of its own. Returns how many were left out.
  uint64_t run(uint64_t count, bool leave_out) {
    uint64_t left_out = 0;
    while (count > 0) {
      if (leave_out && settled >= kSettled && count >= kLeftOut + kCarry) {
        vga_clocks_due(kLeftOut);
        left_out += kLeftOut;
        count -= kLeftOut;
        for (uint64_t i = 0; i < kCarry; i++) settle();
        count -= kCarry;
      } else {
        settle();
        count--;
      }
    }
    return left_out;
  }

  void settle() {
    clock();
    settled = model.debug_swap_waits_o || !model.debug_busy_o ? settled + 1 : 0;
  }

  // Shows a swap that waits for the blank a new one: past the frame's start, then from the last visible line.
  void hurry_on() {
    swap_waits = hurry && model.debug_swap_waits_o ? swap_waits + 1 : 0;
    if (swap_waits < kHurryAfter) return;
    if (swap_waits == kHurryAfter) to_end_of_line(523);
    if (swap_waits == kHurryAfter + kNextLine) to_end_of_line(479);
    vga_clock();
  }

  void to_end_of_line(uint32_t line) {
    x() = 796;
    y() = line;
  }
};

}  // namespace

extern "C" {

// The seed matters to builds with any state at power-on.
Sim* NAME(_new)(uint32_t seed) {
  auto* sim = new Sim(seed);
  sim->start();
  return sim;
}

// As Wave::record; returns whether waves are built in.
uint32_t NAME(_wave)(Sim* sim, const char* file, uint64_t from, uint64_t to) {
  sim->wave.record(sim->model, file, from, to);
  return VM_TRACE;
}

void NAME(_free)(Sim* sim) {
  sim->model.final();
  delete sim;
}

void NAME(_clock)(Sim* sim, uint64_t count) {
  while (count--) sim->clock();
}

void NAME(_vga_ratio)(Sim* sim, uint32_t ratio) { sim->vga_ratio = ratio; }
void NAME(_hurry)(Sim* sim, uint32_t on) { sim->hurry = on; }
void NAME(_test_pattern)(Sim* sim, uint32_t on) { sim->model.test_pattern_i = on; }
uint64_t NAME(_clocks)(const Sim* sim) { return sim->clocks; }
uint64_t NAME(_tiles)(const Sim* sim) { return sim->tiles; }
uint32_t NAME(_irq)(const Sim* sim) { return sim->model.irq_o; }
uint32_t NAME(_busy)(const Sim* sim) { return sim->model.debug_busy_o; }
uint32_t NAME(_free_words)(const Sim* sim) { return sim->model.debug_free_o; }
uint32_t NAME(_swap_pending)(const Sim* sim) { return sim->model.debug_swap_pending_o; }

// Runs bus clocks, and may leave some out where nothing changes; returns how many.
uint64_t NAME(_run)(Sim* sim, uint64_t count, uint32_t leave_out) { return sim->run(count, leave_out); }
uint64_t NAME(_swaps)(const Sim* sim) { return sim->swaps; }

// Says whether anyone looks at VGA's pins; pictures are taken from them only then.
void NAME(_watch)(Sim* sim, uint32_t on) {
  sim->unwatched.set(!on, sim->x(), sim->y());
  sim->scan.watch(on);
}

// As the functions of Scan.
void NAME(_scan)(Sim* sim, uint32_t on) { sim->scan.set(on); }
uint32_t NAME(_scanned)(const Sim* sim, uint8_t* pixels, uint64_t* swaps) { return sim->scan.whole(pixels, swaps); }
uint64_t NAME(_scan_left)(Sim* sim, uint64_t* swaps) {
  *swaps = sim->scan.swaps_before(sim->swaps);
  return Scan::left(sim->unwatched.line(sim->y()));
}

// Writes a word to the aperture; returns for how many clocks it was held.
uint64_t NAME(_push)(Sim* sim, uint32_t word) {
  auto& model = sim->model;
  sim->settled = 0;
  model.fifo_write_i = 1;
  model.fifo_writedata_i = word;
  model.fifo_address_i = (model.fifo_address_i + 1) & 0x3ff;
  model.eval();
  uint64_t held = 0;
  while (model.fifo_waitrequest_o) {
    sim->clock();
    held++;
  }
  sim->clock();
  model.fifo_write_i = 0;
  model.eval();
  return held;
}

// Reads a word of the aperture; returns what the bus has in the same clock, and in bit 32 whether it is held.
uint64_t NAME(_read_aperture)(Sim* sim) {
  auto& model = sim->model;
  model.fifo_read_i = 1;
  model.fifo_address_i = (model.fifo_address_i + 1) & 0x3ff;
  model.eval();
  const uint64_t answer = model.fifo_readdata_o | uint64_t{model.fifo_waitrequest_o} << 32;
  sim->clock();
  model.fifo_read_i = 0;
  model.eval();
  return answer;
}

// Writes words back to back as long as the device takes them.
void NAME(_push_all)(Sim* sim, const uint32_t* words, uint64_t count) {
  while (count--) NAME(_push)(sim, *words++);
}

void NAME(_write)(Sim* sim, uint32_t offset, uint32_t value) {
  auto& model = sim->model;
  sim->settled = 0;
  model.register_address_i = offset / 4;
  model.register_write_i = 1;
  model.register_writedata_i = value;
  sim->clock();
  model.register_write_i = 0;
  model.eval();
}

uint32_t NAME(_read)(Sim* sim, uint32_t offset) {
  auto& model = sim->model;
  model.register_address_i = offset / 4;
  model.register_read_i = 1;
  sim->clock();
  model.register_read_i = 0;
  model.eval();
  return model.register_readdata_o;
}

// Runs until the device is at rest; returns whether it came to rest within `limit` clocks.
uint32_t NAME(_rest)(Sim* sim, uint64_t limit) {
  while (sim->model.debug_busy_o) {
    if (limit-- == 0) return 0;
    sim->clock();
  }
  return 1;
}

// Reads the memories as they are, row 0 first; takes no time.
void NAME(_memory)(Sim* sim, uint8_t* colour0, uint8_t* colour1, uint16_t* depth) {
  auto* root = sim->model.rootp;
  const auto unit = [&](int k, const auto& depths, const auto& colours) {
    constexpr int kTiles = kWidth / kTileWidth * (kHeight / kTileHeight);
    for (int tile = 0; tile < kTiles; tile++) {
      const int row = tile / (kWidth / kTileWidth) * kTileHeight + k / kTileWidth;
      const int at = row * kWidth + tile % (kWidth / kTileWidth) * kTileWidth + k % kTileWidth;
      colour0[at] = colours[2 * tile];
      colour1[at] = colours[2 * tile + 1];
      depth[at] = depths[tile];
    }
  };
#define UNIT(k, memory) \
  root->halfspace_sim__DOT__u_device__DOT__g_unit__BRA__##k##__KET____DOT__u_unit__DOT__##memory##__DOT__mem
#define TAKE(k) unit(k, UNIT(k, u_depth), UNIT(k, u_colour))
  TAKE(0);
#if UNITS >= 2
  TAKE(1);
#endif
#if UNITS >= 4
  TAKE(2);
  TAKE(3);
#endif
#if UNITS >= 8
  TAKE(4);
  TAKE(5);
  TAKE(6);
  TAKE(7);
#endif
#undef TAKE
#undef UNIT
}

// Gives VGA a clock and returns its pins: red, green, blue in bits 23...0, then hsync, vsync, blank.
uint32_t NAME(_vga_clock)(Sim* sim) {
  sim->vga_clock();
  const auto& model = sim->model;
  return model.vga_red_o << 16 | model.vga_green_o << 8 | model.vga_blue_o | model.vga_hsync_no << 24 |
         model.vga_vsync_no << 25 | model.vga_blank_no << 26;
}

}  // extern "C"
