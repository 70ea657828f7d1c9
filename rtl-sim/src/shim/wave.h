// A window of clocks written to an FST file; nothing at all where waves are not built in.
#include <cstdint>
#include <string>

#if VM_TRACE
#include "verilated_fst_c.h"

class Wave {
 public:
  ~Wave() { wave_.close(); }

  // Writes what happens from one bus clock to another to a file, or with none ends what is being written.
  template <typename Model>
  void record(Model& model, const char* file, uint64_t from, uint64_t to) {
    wave_.close();
    // The model must know the wave before it is opened, once.
    if (file && !known_) model.trace(&wave_, 99);
    known_ |= file != nullptr;
    file_ = file ? file : "";
    from_ = from;
    to_ = to;
  }

  // Opens and closes the file where the window begins and ends.
  void at_clock(uint64_t clock) {
    const bool inside = clock >= from_ && clock < to_;
    if (inside && !wave_.isOpen()) wave_.open(file_.c_str());
    if (!inside && wave_.isOpen()) wave_.close();
  }

  // Writes all signals as they stand, at a time in picoseconds.
  void show_at(uint64_t time) {
    time_ = time;
    if (wave_.isOpen()) wave_.dump(time);
  }

  // When something was shown last.
  uint64_t time() const { return time_; }

 private:
  VerilatedFstC wave_;
  bool known_ = false;
  std::string file_;
  uint64_t from_ = 0, to_ = 0, time_ = 0;
};
#else
class Wave {
 public:
  template <typename Model>
  void record(Model&, const char*, uint64_t, uint64_t) {}
  void at_clock(uint64_t) {}
  void show_at(uint64_t) {}
  static constexpr uint64_t time() { return 0; }
};
#endif
