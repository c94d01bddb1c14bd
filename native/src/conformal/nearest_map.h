#pragma once

#include "conformal/boundary_form.h"
#include "conformal/conformal_energy.h"
#include "linear_algebra/factorization.h"
#include "spectral_conformal/linear_constraints.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The map x = P w under linear constraints whose difference from a turned map z has the least Dirichlet energy,
///   P^* D P w = P^* D (a z),   |a| = 1,
/// and of all turns a the one with the least difference. On fine meshes the quotient of Eq. 5 may be least for maps
/// that wind around several times: some of the many nearly conformal ones meet the constraints more easily. The nearest
/// map has the shape of z. Empty if P^* D P is not positive definite in double precision. form, relative_shift: of the
/// shift s P^* M P that keeps translations out. Throws Cancelled, and as Factorization does.
ComplexVector nearest_map(const ConformalEnergy& energy, const LinearConstraints& constraints, const BoundaryForm& form,
                          const Positions& positions, double relative_shift, const ComplexVector& z,
                          FactorizationBackend backend, const Progress& progress);

}  // namespace spectral_conformal
