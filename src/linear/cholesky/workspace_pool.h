// Workspaces that threads take and give back.
#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace beltrami {

/// Workspaces that threads take and give back, so that there are no more of them than threads.
template <class T>
class WorkspacePool {
 public:
  template <class Make>
  std::unique_ptr<T> take(Make&& make) {
    {
      const std::lock_guard<std::mutex> lock(guard_);
      if (!items_.empty()) {
        std::unique_ptr<T> item = std::move(items_.back());
        items_.pop_back();
        return item;
      }
    }
    return make();
  }
  void give_back(std::unique_ptr<T> item) {
    const std::lock_guard<std::mutex> lock(guard_);
    items_.push_back(std::move(item));
  }

 private:
  std::mutex guard_;
  std::vector<std::unique_ptr<T>> items_;
};

}  // namespace beltrami
