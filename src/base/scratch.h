// Memory for the time of a step.
#pragma once

#include <cstddef>
#include <memory>

#include "base/parallel.h"
#include "base/work.h"

namespace beltrami {

/// A large array whose items are written before they are read: nothing fills it, which one thread
/// alone would do. `T` is of numbers.
template <class T>
class Scratch {
 public:
  Scratch() = default;
  Scratch(const Work& work, std::size_t count)
      : items_(std::make_unique_for_overwrite<T[]>(count)) {
    touch_memory(work, items_.get(), count * sizeof(T));
  }

  template <class Integer>
  T& operator[](Integer i) {
    return items_[static_cast<std::size_t>(i)];
  }
  template <class Integer>
  const T& operator[](Integer i) const {
    return items_[static_cast<std::size_t>(i)];
  }
  T* data() { return items_.get(); }
  void swap(Scratch& other) { items_.swap(other.items_); }

 private:
  std::unique_ptr<T[]> items_;
};

}  // namespace beltrami
