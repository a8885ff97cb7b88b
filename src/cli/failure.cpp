#include "failure.h"

namespace beltrami::cli {

int exit_code_of(beltrami_status status) {
  switch (status) {
    case BELTRAMI_OK:
    case BELTRAMI_NOT_CONVERGED:
      return kExitInjective;
    case BELTRAMI_NOT_INJECTIVE:
    case BELTRAMI_NOT_INJECTIVE_FLOAT32:
      return kExitNotInjective;
    case BELTRAMI_E_CANCELLED:
      return kExitCancelled;
    case BELTRAMI_E_OUT_OF_MEMORY:
    case BELTRAMI_E_ABI_MISMATCH:
    case BELTRAMI_E_INVALID_STATE:
    case BELTRAMI_E_INTERNAL:
    case BELTRAMI_E_SOLVER:
      return kExitInternal;
    default:  // the arguments or the mesh
      return kExitUnusable;
  }
}

std::string one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  return text;
}

}  // namespace beltrami::cli
