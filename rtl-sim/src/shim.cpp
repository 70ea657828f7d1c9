// One verilated build of the device behind a C interface; compiled once for each number of pixel
// units, with UNITS, MODEL (the class), HEADER and ROOT_HEADER defined by build.rs.
#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include HEADER
#include ROOT_HEADER
#include "verilated.h"
#if VM_TRACE
#include "verilated_fst_c.h"
#endif

#define JOIN2(a, b, c) a##b##c
#define JOIN(a, b, c) JOIN2(a, b, c)
#define NAME(f) JOIN(halfspace_, UNITS, f)

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

// Pixels on the VGA pins in a line and a frame, and the clocks that these take with their blanks.
constexpr uint32_t kScreenWidth = 640;
constexpr uint32_t kScreen = kScreenWidth * 480;
constexpr uint64_t kLineClocks = 800;
constexpr uint64_t kLines = 525;
// Bus clocks in which nothing has to change before some may be left out: longer than any pipeline here.
constexpr uint64_t kSettled = 64;
// Bus clocks that are left out at a time, about a line, and those run after them: they carry VGA's blank over.
constexpr uint64_t kLeftOut = 1560;
constexpr uint64_t kCarry = 6;

// Nothing in the design looks at a falling edge. So where the name is known under which Verilator keeps a
// clock's last level (5.006's, 5.020's), that is set instead of evaluating all for nothing: half the work.
// Returns whether it was.
template <typename Root>
auto bus_clock_falls(Root* root, int) -> decltype(root->__Vtrigrprev__TOP__clk_i, bool()) {
  root->__Vtrigrprev__TOP__clk_i = 0;
  return true;
}
template <typename Root>
auto bus_clock_falls(Root* root, int) -> decltype(root->__Vtrigprevexpr___TOP__clk_i__0, bool()) {
  root->__Vtrigprevexpr___TOP__clk_i__0 = 0;
  return true;
}
template <typename Root>
bool bus_clock_falls(Root*, long) {
  return false;
}
template <typename Root>
auto vga_clock_falls(Root* root, int) -> decltype(root->__Vtrigrprev__TOP__vga_clk_i, bool()) {
  root->__Vtrigrprev__TOP__vga_clk_i = 0;
  return true;
}
template <typename Root>
auto vga_clock_falls(Root* root, int) -> decltype(root->__Vtrigprevexpr___TOP__vga_clk_i__0, bool()) {
  root->__Vtrigprevexpr___TOP__vga_clk_i__0 = 0;
  return true;
}
template <typename Root>
bool vga_clock_falls(Root*, long) {
  return false;
}

struct Sim {
  VerilatedContext context;
  // No pool of threads that would only wait; all signals are kept where waves are built in.
  bool one_thread = (context.threads(1), context.traceEverOn(VM_TRACE), true);
  MODEL model{&context, "halfspace"};
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
  // The picture on the pins as it is scanned out, and the last whole one, with the swaps before it.
  std::vector<uint8_t> scan, whole;
  uint32_t scan_at = 0;
  uint64_t scan_swaps = 0, whole_swaps = 0, whole_frames = 0;

#if VM_TRACE
  VerilatedFstC wave;
  bool wave_known = false;
  std::string wave_file;
  uint64_t wave_from = 0, wave_to = 0;
  uint64_t wave_time = 0;

  void wave_window() {
    const bool inside = clocks >= wave_from && clocks < wave_to;
    if (inside && !wave.isOpen()) wave.open(wave_file.c_str());
    if (!inside && wave.isOpen()) wave.close();
  }
  void show_at(uint64_t time) {
    wave_time = time;
    if (wave.isOpen()) wave.dump(time);
  }
#else
  static constexpr uint64_t wave_time = 0;
  void wave_window() {}
  void show_at(uint64_t) {}
#endif

  void vga_clock() {
    model.vga_clk_i = 1;
    model.eval();
    show_at(wave_time + kVgaHalf);
    model.vga_clk_i = 0;
    if (VM_TRACE || !vga_clock_falls(model.rootp, 0)) model.eval();
    show_at(wave_time + kVgaHalf);
    vga_clocks++;
    if (scan.empty()) return;
    if (model.vga_blank_no) {
      take_pixel();
    } else if (!model.vga_vsync_no) {
      // What was begun in the middle of a frame is none.
      scan_at = 0;
    }
  }

  void take_pixel() {
    if (scan_at == 0) scan_swaps = swaps;
    uint8_t* pixel = &scan[3 * scan_at];
    pixel[0] = model.vga_red_o;
    pixel[1] = model.vga_green_o;
    pixel[2] = model.vga_blue_o;
    if (++scan_at < kScreen) return;
    scan_at = 0;
    scan.swap(whole);
    whole_swaps = scan_swaps;
    whole_frames++;
  }

  // Outputs are valid, for the inputs as they stand, before and after.
  void clock() {
    wave_window();
    const uint64_t start = std::max(clocks * kBusClock, wave_time + 1);
    show_at(start);
    model.clk_i = 1;
    model.eval();
    show_at(start + kBusRises);
    model.clk_i = 0;
    if (VM_TRACE || !bus_clock_falls(model.rootp, 0)) model.eval();
    show_at(start + kBusFalls);
    clocks++;
    tiles += model.debug_tile_o;
    swaps += model.debug_front_o != front;
    front = model.debug_front_o;
    for (vga_phase += vga_ratio; vga_phase >= 65536; vga_phase -= 65536) vga_clock();
    hurry_on();
  }

  // Runs bus clocks. Where nothing changes but time, because nothing is under way or a swap waits
  // for the blank alone, most may be left out; VGA has all of its own. Returns how many were left out.
  uint64_t run(uint64_t count, bool leave_out) {
    uint64_t left_out = 0;
    while (count > 0) {
      if (leave_out && settled >= kSettled && count >= kLeftOut + kCarry) {
        for (uint64_t i = 0; i < kLeftOut; i++) {
          for (vga_phase += vga_ratio; vga_phase >= 65536; vga_phase -= 65536) vga_clock();
        }
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
    auto* root = model.rootp;
    root->halfspace_sim__DOT__u_device__DOT__u_scanout__DOT__u_timing__DOT__x_q = 796;
    root->halfspace_sim__DOT__u_device__DOT__u_scanout__DOT__u_timing__DOT__y_q = line;
  }
};

}  // namespace

extern "C" {

Sim* NAME(_new)() {
  auto* sim = new Sim;
  sim->model.rst_ni = 0;
  sim->model.eval();
  for (int i = 0; i < 4; i++) { sim->clock(); sim->vga_clock(); }
  sim->model.rst_ni = 1;
  for (int i = 0; i < 4; i++) { sim->clock(); sim->vga_clock(); }
  return sim;
}

// Writes what happens from one bus clock to another to a file, or with none ends what is being
// written; returns whether that is built in.
uint32_t NAME(_wave)(Sim* sim, const char* file, uint64_t from, uint64_t to) {
#if VM_TRACE
  sim->wave.close();
  // The model must know the wave before it is opened, once.
  if (file && !sim->wave_known) sim->model.trace(&sim->wave, 99);
  sim->wave_known |= file != nullptr;
  sim->wave_file = file ? file : "";
  sim->wave_from = from;
  sim->wave_to = to;
#endif
  return VM_TRACE;
}

void NAME(_free)(Sim* sim) {
#if VM_TRACE
  sim->wave.close();
#endif
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

// Takes pictures from the pins from now on, or no longer.
void NAME(_scan)(Sim* sim, uint32_t on) {
  sim->scan.assign(on ? 3 * kScreen : 0, 0);
  sim->whole.assign(on ? 3 * kScreen : 0, 0);
  sim->scan_at = 0;
  sim->whole_frames = 0;
}

// Copies the last whole picture, red, green, blue, and the number of swaps before it; returns whether there is one.
uint32_t NAME(_scanned)(const Sim* sim, uint8_t* pixels, uint64_t* swaps) {
  if (sim->whole_frames == 0) return 0;
  if (pixels) std::copy(sim->whole.begin(), sim->whole.end(), pixels);
  *swaps = sim->whole_swaps;
  return 1;
}

// VGA clocks until the picture that is scanned out now, or in the blank the next one, is whole; and the
// number of swaps before it.
uint64_t NAME(_scan_left)(const Sim* sim, uint64_t* swaps) {
  const auto* root = sim->model.rootp;
  const uint64_t line = root->halfspace_sim__DOT__u_device__DOT__u_scanout__DOT__u_timing__DOT__y_q;
  const uint64_t end = kScreen / kScreenWidth;
  *swaps = sim->scan_at > 0 ? sim->scan_swaps : sim->swaps;
  return (line < end ? end - line : kLines - line + end) * kLineClocks;
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
