#pragma once

#include "conformal/boundary_form.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// A soft force that pulls pinned vertices toward their positions, as a term of the form B of Eq. 5 like the extenders
/// of section 4.2:
///   B^ - weight Q,   z^H Q z = min over a, b of sum_k |z_k - (a p_k + b)|^2,
/// the deviation of the pinned vertices from the best similar image of their positions p. The eigenproblem stays
/// homogeneous, and its factor unchanged. Q vanishes for fewer than three pins. Where linear constraints exclude turns,
/// a is real, and Q vanishes for a single pin only.
struct PinAttraction {
  std::vector<int> vertices;
  ComplexVector shape;  ///< positions about their mean, of norm 1; 0 where all pins coincide
  double weight = 0;
  bool may_turn = true;

  /// z^H Q z, times the weight.
  double value(const ComplexVector& z) const;
  /// result -= weight Q z.
  void subtract(const ComplexVector& z, ComplexVector& result) const;

 private:
  ComplexVector deviation(const ComplexVector& z) const;
};

/// weight = strength x (1^T M 1) / number of pins, so that the strength does not depend on resolution and scale.
PinAttraction pin_attraction(const Pins& pins, const BoundaryForm& form, double strength, bool may_turn = true);

/// Moves z, (V,), by the similarity z -> a z + b that brings the pinned vertices nearest to their positions. One pin
/// only translates it. Without turns, a is real. Returns false, z unchanged, if no similarity with a != 0 does so.
bool fit_to_pins(ComplexVector& z, const Pins& pins, bool may_turn = true);

}  // namespace spectral_conformal
