#pragma once

#include "conformal/boundary_form.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Where an eigenvalue iteration starts: a circle run through in proportion to the mass passed, blurred by noise so
/// that no symmetry of the patch can make it orthogonal to the eigenvector. `start` 0: a little noise; otherwise noise
/// alone, seeded by it. The same on every platform. Returns y = M^1/2 z on form.vertices.
ComplexVector start_vector(const BoundaryForm& form, unsigned start);

}  // namespace spectral_conformal
