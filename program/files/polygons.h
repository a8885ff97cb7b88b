// The faces of a file: polygons of three corners and more.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "process/failure.h"

namespace beltrami::cli {

/// The failure of a file that may have points, lines or curves, but nothing to unwrap.
inline Failure without_faces(const std::string& path) {
  return Failure(path + ": no faces: export the surface as triangles or polygons");
}

/// Corners of all polygons one after another, each the number of a vertex. Where all polygons are
/// triangles, as they mostly are, nothing else is stored.
class Polygons {
 public:
  Polygons() = default;
  /// `corners`: three for each triangle.
  explicit Polygons(std::vector<std::uint32_t> corners)
      : corners_(std::move(corners)), open_(corners_.size()) {}

  void reserve(std::uint64_t triangles) { corners_.reserve(3 * triangles); }
  void add_corner(std::uint32_t vertex) { corners_.push_back(vertex); }
  /// Corners of the polygon that is being added.
  std::uint64_t open_corners() const { return corners_.size() - open_; }
  void drop_open_corners() { corners_.resize(open_); }
  /// The corners added since the last call are a polygon.
  void end_polygon() {
    if (ends_.empty() && open_corners() != 3) {
      for (std::uint64_t end = 3; end <= open_; end += 3) ends_.push_back(end);
      mixed_ = true;
    }
    open_ = corners_.size();
    if (mixed_) ends_.push_back(open_);
  }

  std::uint64_t size() const { return mixed_ ? ends_.size() : open_ / 3; }
  bool empty() const { return open_ == 0; }
  bool all_triangles() const { return !mixed_; }
  /// The corners of polygon i are those in [begin, end).
  std::uint64_t begin(std::uint64_t i) const { return mixed_ ? (i ? ends_[i - 1] : 0) : 3 * i; }
  std::uint64_t end(std::uint64_t i) const { return mixed_ ? ends_[i] : 3 * i + 3; }
  std::span<const std::uint32_t> operator[](std::uint64_t i) const {
    return std::span(corners_).subspan(begin(i), end(i) - begin(i));
  }
  const std::vector<std::uint32_t>& corners() const { return corners_; }

  /// The polygon that this corner belongs to.
  std::uint64_t of_corner(std::uint64_t corner) const {
    if (!mixed_) return corner / 3;
    return static_cast<std::uint64_t>(std::upper_bound(ends_.begin(), ends_.end(), corner) -
                                      ends_.begin());
  }

 private:
  std::vector<std::uint32_t> corners_;
  std::vector<std::uint64_t> ends_;  ///< of each polygon, where not all are triangles
  std::uint64_t open_ = 0;           ///< first corner of the polygon that is being added
  bool mixed_ = false;
};

}  // namespace beltrami::cli
