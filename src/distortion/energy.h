// The energies by name: one row each.
#pragma once

#include <beltrami/beltrami.h>

#include "distortion/symmetric_arap.h"
#include "distortion/symmetric_dirichlet.h"

namespace beltrami {

/// A BELTRAMI_ENERGY_ number.
using Energy = std::int32_t;

/// Calls body(density) with the density of an energy: the one place that knows them all.
template <class Body>
auto with_density(Energy energy, Body&& body) {
  switch (energy) {
    case BELTRAMI_ENERGY_SYMMETRIC_ARAP:
      return body(SymmetricArap{});
    default:
      return body(SymmetricDirichlet{});
  }
}

}  // namespace beltrami
