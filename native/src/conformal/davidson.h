#pragma once

#include "conformal/boundary_form.h"
#include "conformal/conformal_energy.h"
#include "conformal/correction.h"
#include "conformal/reduced_factor.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

struct DavidsonResult {
  ComplexVector z;    ///< (V,), mean-free
  double change = 0;  ///< remaining part of other eigenvectors, relative to z; infinite if there is no z
  int solves = 0;     ///< solves with the factor
};

/// The eigenvector of the smallest positive eigenvalue of L z = lambda B z where many eigenvalues are smaller than the
/// shift s. On a long strip every smooth function along it is nearly conformal, and lambda_2 shrinks with the cube of
/// length over width; neither a Krylov space of (L + s M)^-1 nor `correct` separates these eigenvectors. Generalized
/// Davidson method (Morgan and Scott 1986): a Rayleigh-Ritz space, orthonormal in L + s M, starts with the images of
/// Fourier modes along the boundary and grows by (L + s M)^-1 (L z - lambda B z) of its best vector z. L is applied
/// triangle by triangle, which resolves lambda_2 where the factor does not. `factor` holds L + s M, with the
/// mass M of `form`; B may be another form (`quotient`), definite or not. Stops when the change is below `negligible`,
/// or is no longer halved. Throws Cancelled.
DavidsonResult solve_by_davidson(ReducedFactor& factor, const ConformalEnergy& energy, const BoundaryForm& form,
                                 const QuotientForm& quotient, double negligible, const Progress& progress);

}  // namespace spectral_conformal
