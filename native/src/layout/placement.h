#pragma once

#include "conformal/conformal_energy.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Signed area of the map, weighted by the triangle weights, excluding the weights of section 4.1 and virtual
/// triangles.
double signed_area(const ConformalEnergy& energy, const ComplexVector& z);

/// Fixes the freedom that the conformal energy leaves: moves the mean of the vertices to 0, scales the signed area to
/// `area` and turns the map upright (upright_turn). Preserves orientation. Returns false, z unchanged, if the signed
/// area is not positive.
bool place(ComplexVector& z, const ConformalEnergy& energy, const BoundaryLoop& outer_loop,
           const Eigen::Ref<const Positions>& positions, double area);

}  // namespace spectral_conformal
