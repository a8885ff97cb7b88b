// The one exception type of the pipeline; the ABI turns it into a status, a message and an element.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace beltrami {

/// Why a run cannot go on. abi/failure.h has the public number of each; where a function throws
/// one, its header names it as that number is: Error NON_FINITE.
enum class Fault {
  kInvalidArgument,
  kOutOfMemory,
  kInvalidState,
  kInternal,  ///< a defect of the library

  // The mesh is not one that can be flattened. The element says where.
  kEmpty,              ///< no vertices or no faces
  kIndexOutOfRange,    ///< face: an index >= the vertex count
  kNonFinite,          ///< vertex: a NaN or infinite coordinate
  kRepeatedVertex,     ///< face: names one vertex twice
  kNonManifoldEdge,    ///< face: one of its edges has more than two faces
  kNonManifoldVertex,  ///< vertex: its faces form more than one fan
  kOrientation,        ///< face: runs against its neighbour, or is a duplicate
  kComponents,         ///< face: in a second component
  kClosed,             ///< no boundary
  kBoundaries,         ///< vertex: on a second boundary loop
  kGenus,              ///< has handles
  kZeroArea,           ///< the whole surface has no area, or overflows

  kPins,    ///< corner: the first that cannot be met, with those before it
  kNoRoom,  ///< charts do not fit onto the pages
  kSolver   ///< a linear system could not be solved
};

/// What an element's index counts. Corners: of a surface's faces, one after another.
enum class ElementKind { kNothing, kFace, kVertex, kCorner };

/// What a failure is about, so that a host can select it.
struct Element {
  ElementKind kind = ElementKind::kNothing;
  std::uint64_t index = 0;  ///< of that kind; says nothing without one

  static Element face(std::uint64_t index) { return {ElementKind::kFace, index}; }
  static Element vertex(std::uint64_t index) { return {ElementKind::kVertex, index}; }
  static Element corner(std::uint64_t index) { return {ElementKind::kCorner, index}; }
};

/// A run that cannot go on: why, a sentence that says what to do, and the element.
class Error : public std::runtime_error {
 public:
  Error(Fault fault, const std::string& message, Element element = {})
      : std::runtime_error(message), fault_(fault), element_(element) {}

  Fault fault() const { return fault_; }
  Element element() const { return element_; }

 private:
  Fault fault_;
  Element element_;
};

}  // namespace beltrami
