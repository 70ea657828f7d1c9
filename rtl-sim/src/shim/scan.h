// The picture on the VGA pins as it is scanned out, and the last whole one, with the swaps before it.
#include <algorithm>
#include <cstdint>
#include <vector>

// Pixels on the pins in a line and a frame, and the clocks and lines that these take with their blanks.
constexpr uint32_t kScreenWidth = 640;
constexpr uint32_t kScreen = kScreenWidth * 480;
constexpr uint64_t kLineClocks = 800;
constexpr uint64_t kLines = 525;

class Scan {
 public:
  // Takes pictures from now on, or no longer.
  void set(bool on) {
    scan_.assign(on ? 3 * kScreen : 0, 0);
    whole_.assign(on ? 3 * kScreen : 0, 0);
    at_ = 0;
    whole_frames_ = 0;
  }

  // Looks at the pins from now on, or no longer; keeps the last whole picture.
  void watch(bool on) {
    watched_ = on;
    at_ = 0;
  }

  // Looks at the pins after one of VGA's clocks; so many swaps took place until now.
  template <typename Model>
  void clock(const Model& model, uint64_t swaps) {
    if (scan_.empty() || !watched_) return;
    if (model.vga_blank_no) {
      take_pixel(model, swaps);
    } else if (!model.vga_vsync_no) {
      // What was begun in the middle of a frame is none.
      at_ = 0;
    }
  }

  // Copies the last whole picture, red, green, blue, and the number of swaps before it; returns whether there is one.
  bool whole(uint8_t* pixels, uint64_t* swaps) const {
    if (whole_frames_ == 0) return false;
    if (pixels) std::copy(whole_.begin(), whole_.end(), pixels);
    *swaps = whole_swaps_;
    return true;
  }

  // Swaps before the picture that is scanned out now or, with so many by now, comes next.
  uint64_t swaps_before(uint64_t swaps) const { return at_ > 0 ? swaps_ : swaps; }

  // VGA clocks at the beginning of a line until the picture in it, or in the blank the next one, is whole.
  static uint64_t left(uint64_t line) {
    constexpr uint64_t end = kScreen / kScreenWidth;
    return (line < end ? end - line : kLines - line + end) * kLineClocks;
  }

 private:
  template <typename Model>
  void take_pixel(const Model& model, uint64_t swaps) {
    if (at_ == 0) swaps_ = swaps;
    uint8_t* pixel = &scan_[3 * at_];
    pixel[0] = model.vga_red_o;
    pixel[1] = model.vga_green_o;
    pixel[2] = model.vga_blue_o;
    if (++at_ < kScreen) return;
    at_ = 0;
    scan_.swap(whole_);
    whole_swaps_ = swaps_;
    whole_frames_++;
  }

  std::vector<uint8_t> scan_, whole_;
  bool watched_ = true;
  uint32_t at_ = 0;
  uint64_t swaps_ = 0, whole_swaps_ = 0, whole_frames_ = 0;
};
