#pragma once

#include "conformal/boundary_form.h"
#include "conformal/conformal_energy.h"
#include "conformal/correction.h"
#include "linear_algebra/factorization.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

struct DavidsonResult {
  ComplexVector z;    ///< (V,), mean-free
  double change = 0;  ///< what is left of other eigenvectors, relative to z; infinite where there is no z
  int solves = 0;     ///< solves with the factor
};

/// The eigenvector of the smallest positive eigenvalue of L z = lambda B z where many eigenvalues are smaller than the
/// shift s: on a long strip every smooth function along it is nearly conformal, lambda_2 shrinks with the cube of the
/// length over the width, and neither a Krylov space of (L + s M)^-1 nor `correct` tells these eigenvectors apart.
/// Generalised Davidson method (Morgan and Scott 1986): a Rayleigh-Ritz space, orthonormal in L + s M, begins with the
/// images of Fourier modes along the boundary and grows by (L + s M)^-1 (L z - lambda B z) of its best vector z. All of
/// L is applied triangle by triangle, which resolves lambda_2 where the factor does not.
/// `factorization` holds L + s M, M being the mass of `form`; B may be another form (`quotient`), definite or not.
/// Ends where the change is below `negligible`, or where it is not halved any more. Throws Cancelled.
DavidsonResult solve_by_davidson(Factorization& factorization, const ConformalEnergy& energy, const BoundaryForm& form,
                                 double shift, const QuotientForm& quotient, double negligible,
                                 const Progress& progress);

}  // namespace spectral_conformal
