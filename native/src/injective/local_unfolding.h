#pragma once

#include <vector>

#include "linear_algebra/factorization.h"
#include "relaxation/distortion_energy.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// Unfolds the flipped triangles of a map locally. It frees the vertices around them, in growing rings, until a descent
/// (descent.h) on the symmetric Dirichlet energy, at the scale of their neighborhood, finds room for them; where
/// triangles without flips bar the way, it may flip these on the way. The freed region is then relaxed to the minimum
/// of the conformal distortion. Flipped is meant up to the tolerance `unplaced` of distortion_energy.h.
///
/// elements: from distortion_elements; z: (V,), finite; held: (V,) or empty, vertices that must not move. Returns the
/// number of elements still flipped, never more than before. Throws Cancelled, and as Factorization does.
int unfold_locally(const std::vector<DistortionElement>& elements, const std::vector<char>& held,
                   FactorizationBackend backend, ComplexVector& z, const Progress& progress = {});

}  // namespace spectral_conformal
