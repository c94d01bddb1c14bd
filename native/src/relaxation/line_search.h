#pragma once

#include <utility>

#include "geometry/tolerances.h"
#include "relaxation/lbfgs.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Leaves each triangle a tenth of its way to a flip, and the boundary a tenth of its way to a contact.
constexpr double fraction_of_max_step = 0.9;

/// A map with its energy and gradient.
struct DescendingMap {
  ComplexVector z = {};
  double energy = 0;
  ComplexVector gradient = {};
};

/// Moves a map along a direction of descent: by the first of `length`, `length` / 2, ... at which the energy falls as
/// Armijo's condition demands (Nocedal and Wright 2006, Section 3.1), and tells `lbfgs` unless it is null. Returns that
/// length, or 0 if all such steps are too short for a visible effect. slope: that of the energy along the direction.
/// energy_and_gradient(z, gradient): as of DescendingMap.
template <class Function>
double move_down(Function& energy_and_gradient, const ComplexVector& direction, double slope, double length,
                 DescendingMap& map, Lbfgs* lbfgs) {
  constexpr double sufficient = 1e-4;  // share of the fall that the slope promises
  const double least = single_rounding * length;
  DescendingMap moved;
  for (; length > least; length *= 0.5) {
    moved.z = map.z + length * direction;
    moved.energy = energy_and_gradient(moved.z, moved.gradient);
    if (!(moved.energy <= map.energy + sufficient * length * slope)) continue;
    if (lbfgs != nullptr) lbfgs->add(moved.z - map.z, moved.gradient - map.gradient);
    std::swap(map, moved);
    return length;
  }
  return 0;
}

}  // namespace spectral_conformal
