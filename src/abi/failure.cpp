#include "abi/failure.h"

#include <exception>
#include <new>
#include <stdexcept>

#include "abi/status.h"
#include "base/interrupt.h"

namespace beltrami {

void Failure::clear() noexcept {
  message_ = "";
  element_ = {};
}

void Failure::set(beltrami_status status, const char* message, Element element) noexcept {
  element_ = element;
  try {
    text_ = message;
    message_ = text_.c_str();
  } catch (...) {
    message_ = status_advice(status);
  }
}

void Failure::set_static(const char* message) noexcept {
  element_ = {};
  message_ = message;
}

beltrami_status describe_exception(Failure& failure) noexcept {
  try {
    throw;
  } catch (const Cancelled&) {
    failure.set_static("The call was cancelled on request.");
    return BELTRAMI_E_CANCELLED;
  } catch (const Error& error) {
    failure.set(error.status(), error.what(), error.element());
    return error.status();
  } catch (const std::bad_alloc&) {
    failure.set_static(status_advice(BELTRAMI_E_OUT_OF_MEMORY));
    return BELTRAMI_E_OUT_OF_MEMORY;
  } catch (const std::length_error&) {
    // A container longer than the address space allows: memory in another word.
    failure.set_static(status_advice(BELTRAMI_E_OUT_OF_MEMORY));
    return BELTRAMI_E_OUT_OF_MEMORY;
  } catch (const std::exception& error) {
    failure.set(BELTRAMI_E_INTERNAL, error.what(), {});
    return BELTRAMI_E_INTERNAL;
  } catch (...) {
    failure.set_static(status_advice(BELTRAMI_E_INTERNAL));
    return BELTRAMI_E_INTERNAL;
  }
}

}  // namespace beltrami
