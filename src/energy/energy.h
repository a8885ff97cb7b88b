// The energies by name: one row each.
#pragma once

#include <cstdint>

#include "energy/exponential_dirichlet.h"
#include "energy/symmetric_arap.h"
#include "energy/symmetric_dirichlet.h"

namespace beltrami {

enum class Energy : std::int32_t { kSymmetricDirichlet, kSymmetricArap, kExponentialDirichlet };

/// Calls body(density) with the density of an energy: the one place that knows them all.
template <class Body>
auto with_density(Energy energy, Body&& body) {
  switch (energy) {
    case Energy::kSymmetricArap:
      return body(SymmetricArap{});
    case Energy::kExponentialDirichlet:
      return body(ExponentialDirichlet{});
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

/// How distorted a map of a mean energy is, counted as symmetric Dirichlet energy: for what depends
/// on that and not on how fast an energy grows.
template <class Density>
double to_dirichlet(double energy) {
  if constexpr (requires { Density::to_dirichlet(energy); }) return Density::to_dirichlet(energy);
  return comparable_energy<Density>(energy);
}

inline double to_dirichlet(Energy which, double energy) {
  return with_density(which, [&]<class Density>(Density) { return to_dirichlet<Density>(energy); });
}

/// About the energy of a face that is as bad as one of this symmetric Dirichlet energy, well above
/// 2: for thresholds.
template <class Density>
double from_dirichlet(double dirichlet) {
  if constexpr (requires { Density::from_dirichlet(dirichlet); }) {
    return Density::from_dirichlet(dirichlet);
  }
  return dirichlet;
}

}  // namespace beltrami
