// Reads a signal back from an FST file, with the reader that comes with the writer: GTKWave's own.
#include <cstdint>
#include <cstring>

#include "gtkwave/fstapi.h"

namespace {

struct Reader {
  void (*each)(void* user, uint64_t time, const char* value);
  void* user;
};

void on_change(void* reader, uint64_t time, fstHandle, const unsigned char* value) {
  const auto* it = static_cast<const Reader*>(reader);
  it->each(it->user, time, reinterpret_cast<const char*>(value));
}

}  // namespace

extern "C" {

// Hands the changes of the first signal called `name` to `each`: the time in the file's unit, and
// the value in binary. Returns the unit's exponent of ten in seconds, 1 when the file cannot be
// read, or 2 when there is no such signal.
int32_t halfspace_wave_changes(const char* file, const char* name, void (*each)(void*, uint64_t, const char*),
                               void* user) {
  void* wave = fstReaderOpen(file);
  if (!wave) return 1;
  fstHandle handle = 0;
  while (const auto* entry = fstReaderIterateHier(wave)) {
    if (entry->htyp != FST_HT_VAR || handle) continue;
    // A vector's range stands behind its name.
    const size_t length = std::strcspn(entry->u.var.name, " [");
    if (length == std::strlen(name) && !std::strncmp(entry->u.var.name, name, length)) handle = entry->u.var.handle;
  }
  int32_t result = 2;
  if (handle) {
    Reader reader{each, user};
    fstReaderClrFacProcessMaskAll(wave);
    fstReaderSetFacProcessMask(wave, handle);
    fstReaderIterBlocks(wave, on_change, &reader, nullptr);
    result = fstReaderGetTimescale(wave);
  }
  fstReaderClose(wave);
  return result;
}

}  // extern "C"
