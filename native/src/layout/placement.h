#pragma once

#include "conformal/conformal_energy.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Signed area of the map, weighted by the triangle weights, without the weights of section 4.1 and without virtual
/// triangles.
double signed_area(const ConformalEnergy& energy, const ComplexVector& z);

/// Fixes what the conformal energy leaves free: the mean of the vertices goes to 0, the signed area becomes `area`, and
/// the map stands upright (upright_turn). Orientation-preserving. Returns false when the signed area is not positive; z
/// is then unchanged.
bool place(ComplexVector& z, const ConformalEnergy& energy, const BoundaryLoop& outer_loop,
           const Eigen::Ref<const Positions>& positions, double area);

}  // namespace spectral_conformal
