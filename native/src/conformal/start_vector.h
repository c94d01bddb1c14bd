#pragma once

#include "conformal/boundary_form.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The start of an eigenvalue iteration: a circle traversed in proportion to the boundary mass, with noise, so that no
/// symmetry of the patch makes it orthogonal to the eigenvector. `start` 0: a little noise; otherwise noise alone, with
/// this seed. The same on every platform. Returns z on form.vertices.
ComplexVector start_vector(const BoundaryForm& form, unsigned start);

}  // namespace spectral_conformal
