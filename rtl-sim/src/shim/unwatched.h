// VGA's clocks that are left out while nobody looks at its pins: those of whole lines on which nothing else depends.
//
// Run are the frame's first line and its last ones, and those around the beginning of the blank and the end of the swap
// window: what crosses to the bus clock comes from there, and the front buffer is looked at.
#include <algorithm>
#include <cstdint>

class Unwatched {
 public:
  // Leaves clocks out from now on, or none any more; x and y are the raster's counters.
  template <typename Counter>
  void set(bool on, Counter& x, Counter& y) {
    on_ = on;
    if (!on) end(x, y);
  }

  // Leaves out as many of VGA's next clocks as it may, at most `due`, and returns how many.
  template <typename Counter>
  uint64_t leave_out(Counter& x, Counter& y, uint64_t due) {
    if (left_ == 0) {
      if (!on_ || x != 0) return 0;
      left_ = y == kVisible ? kVisibleLines * kLine : y == kBlank ? kBlankLines * kLine : 0;
    }
    const uint64_t count = std::min(due, left_);
    done_ += count;
    left_ -= count;
    if (left_ == 0) end(x, y);
    return count;
  }

  // The line that the raster is in, where its counter says y.
  uint64_t line(uint64_t y) const { return y + done_ / kLine; }

 private:
  // First lines of the two stretches, and how many: up to two lines before the blank and the swap window's end.
  static constexpr uint64_t kVisible = 1, kVisibleLines = 477;
  static constexpr uint64_t kBlank = 481, kBlankLines = 40;
  static constexpr uint64_t kLine = 800;

  template <typename Counter>
  void end(Counter& x, Counter& y) {
    if (done_ > 0) x = done_ % kLine;
    y += done_ / kLine;
    done_ = left_ = 0;
  }

  bool on_ = false;
  // Clocks of the present stretch.
  uint64_t done_ = 0, left_ = 0;
};
