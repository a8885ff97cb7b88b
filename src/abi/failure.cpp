#include "abi/failure.h"

#include <exception>
#include <new>
#include <stdexcept>

#include "abi/status.h"
#include "base/interrupt.h"

namespace beltrami {
namespace {

std::int32_t kind_of(const Element& element) noexcept {
  // No default, here and below: the compiler names what is missing.
  switch (element.kind) {
    case ElementKind::kNothing:
      return BELTRAMI_ELEMENT_NONE;
    case ElementKind::kFace:
      return BELTRAMI_ELEMENT_FACE;
    case ElementKind::kVertex:
      return BELTRAMI_ELEMENT_VERTEX;
    case ElementKind::kCorner:
      return BELTRAMI_ELEMENT_CORNER;
  }
  return BELTRAMI_ELEMENT_NONE;
}

}  // namespace

beltrami_status status_of(Fault fault) noexcept {
  switch (fault) {
    case Fault::kInvalidArgument:
      return BELTRAMI_E_INVALID_ARGUMENT;
    case Fault::kOutOfMemory:
      return BELTRAMI_E_OUT_OF_MEMORY;
    case Fault::kInvalidState:
      return BELTRAMI_E_INVALID_STATE;
    case Fault::kInternal:
      return BELTRAMI_E_INTERNAL;
    case Fault::kEmpty:
      return BELTRAMI_E_EMPTY;
    case Fault::kIndexOutOfRange:
      return BELTRAMI_E_INDEX_OUT_OF_RANGE;
    case Fault::kNonFinite:
      return BELTRAMI_E_NON_FINITE;
    case Fault::kRepeatedVertex:
      return BELTRAMI_E_REPEATED_VERTEX;
    case Fault::kNonManifoldEdge:
      return BELTRAMI_E_NON_MANIFOLD_EDGE;
    case Fault::kNonManifoldVertex:
      return BELTRAMI_E_NON_MANIFOLD_VERTEX;
    case Fault::kOrientation:
      return BELTRAMI_E_ORIENTATION;
    case Fault::kComponents:
      return BELTRAMI_E_COMPONENTS;
    case Fault::kClosed:
      return BELTRAMI_E_CLOSED;
    case Fault::kBoundaries:
      return BELTRAMI_E_BOUNDARIES;
    case Fault::kGenus:
      return BELTRAMI_E_GENUS;
    case Fault::kZeroArea:
      return BELTRAMI_E_ZERO_AREA;
    case Fault::kPins:
      return BELTRAMI_E_PINS;
    case Fault::kNoRoom:
      return BELTRAMI_E_NO_ROOM;
    case Fault::kSolver:
      return BELTRAMI_E_SOLVER;
  }
  return BELTRAMI_E_INTERNAL;
}

void Failure::clear() noexcept {
  set_static("");
}

void Failure::set(beltrami_status status, const char* message, Element element) noexcept {
  element_kind_ = kind_of(element);
  element_ = element_kind_ == BELTRAMI_ELEMENT_NONE ? BELTRAMI_NO_ELEMENT : element.index;
  try {
    text_ = message;
    message_ = text_.c_str();
  } catch (...) {
    message_ = status_advice(status);
  }
}

void Failure::set_static(const char* message) noexcept {
  element_kind_ = BELTRAMI_ELEMENT_NONE;
  element_ = BELTRAMI_NO_ELEMENT;
  message_ = message;
}

beltrami_status describe_exception(Failure& failure) noexcept {
  try {
    throw;
  } catch (const Cancelled&) {
    failure.set_static("The call was cancelled on request.");
    return BELTRAMI_E_CANCELLED;
  } catch (const Error& error) {
    const beltrami_status status = status_of(error.fault());
    failure.set(status, error.what(), error.element());
    return status;
  } catch (const std::bad_alloc&) {
    failure.set_static(status_advice(BELTRAMI_E_OUT_OF_MEMORY));
    return BELTRAMI_E_OUT_OF_MEMORY;
  } catch (const std::length_error&) {
    // A container longer than the address space allows: memory in another word.
    failure.set_static(status_advice(BELTRAMI_E_OUT_OF_MEMORY));
    return BELTRAMI_E_OUT_OF_MEMORY;
  } catch (const std::exception& error) {
    failure.set(BELTRAMI_E_INTERNAL, error.what());
    return BELTRAMI_E_INTERNAL;
  } catch (...) {
    failure.set_static(status_advice(BELTRAMI_E_INTERNAL));
    return BELTRAMI_E_INTERNAL;
  }
}

}  // namespace beltrami
