// The energies by name: one row each.
#pragma once

#include <cstdint>

#include "energy/symmetric_arap.h"
#include "energy/symmetric_dirichlet.h"

namespace beltrami {

enum class Energy : std::int32_t { kSymmetricDirichlet, kSymmetricArap };

/// Calls body(density) with the density of an energy: the one place that knows them all.
template <class Body>
auto with_density(Energy energy, Body&& body) {
  switch (energy) {
    case Energy::kSymmetricArap:
      return body(SymmetricArap{});
    case Energy::kSymmetricDirichlet:
      break;
  }
  return body(SymmetricDirichlet{});
}

/// What a decrease of the energy is compared with to tell convergence: the energy, shifted so that
/// an isometry counts 2 as it does for symmetric Dirichlet. All energies then end equally near
/// their minimum.
template <class Density>
constexpr double comparable_energy(double energy) {
  return energy + 2 - Density::kMinimum;
}

inline double comparable_energy(Energy which, double energy) {
  return with_density(which,
                      [&]<class Density>(Density) { return comparable_energy<Density>(energy); });
}

}  // namespace beltrami
