#pragma once

#include <vector>

#include "linear_algebra/factorization.h"
#include "relaxation/distortion_energy.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// Unfolds the flipped triangles of a map and leaves the rest of it where it is: frees the vertices around them, ring
/// by ring further, until a descent (descent.h) of the symmetric Dirichlet energy, at the scale of their neighborhood,
/// finds room for them; what was freed is then relaxed to the minimum of the conformal distortion. Flipped: beyond the
/// tolerance `unplaced` of distortion_energy.h.
///
/// elements as from distortion_elements, z (V,) finite, `held` (V,) or empty: vertices that must stay. Returns the
/// number of elements that stay flipped, never more than before. Throws Cancelled, and what Factorization throws.
int unfold_locally(const std::vector<DistortionElement>& elements, const std::vector<char>& held,
                   FactorizationBackend backend, ComplexVector& z, const Progress& progress = {});

}  // namespace spectral_conformal
