#include "process/leftovers.h"

#include <array>
#include <atomic>
#include <cstdio>
#include <cstring>
#include <utility>

#if !defined(_WIN32)
#include <unistd.h>
#endif

namespace beltrami::cli {
namespace {

constexpr std::size_t kLongestName = 4096;  // with its end
/// Outputs of a run, and what each replaces; more pages than that are rare.
constexpr std::size_t kMostFiles = 64;

/// A handler reaches globals only, and may find them at any moment.
struct Slot {
  std::atomic<bool> taken, filled;
  std::array<char, kLongestName> name;
};
std::array<Slot, kMostFiles> slots;
static_assert(std::atomic<bool>::is_always_lock_free);

}  // namespace

void remove_leftovers() noexcept {
  for (const Slot& slot : slots) {
    if (!slot.filled.load()) continue;
#if defined(_WIN32)
    std::remove(slot.name.data());
#else
    unlink(slot.name.data());
#endif
  }
}

Leftover::Leftover(std::string path) : path_(std::move(path)) {
  if (path_.size() >= kLongestName) return;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (slots[i].taken.exchange(true)) continue;
    std::memcpy(slots[i].name.data(), path_.c_str(), path_.size() + 1);
    slots[i].filled.store(true);
    slot_ = static_cast<int>(i);
    return;
  }
}

Leftover::~Leftover() {
  if (path_.empty()) return;
  std::remove(path_.c_str());
  keep();
}

void Leftover::keep() noexcept {
  path_.clear();
  if (slot_ < 0) return;
  Slot& slot = slots[static_cast<std::size_t>(slot_)];
  slot.filled.store(false);
  slot.taken.store(false);
  slot_ = -1;
}

}  // namespace beltrami::cli
