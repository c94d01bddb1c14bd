#pragma once

#include "conformal/boundary_form.h"
#include "conformal/conformal_energy.h"
#include "conformal/correction.h"
#include "conformal/reduced_factor.h"
#include "linear_algebra/factorization.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

struct EigenproblemOptions {
  double tolerance = 1e-8;   ///< bound of |T y - mu y| / (mu |y|) for the operator T described below
  int max_restarts = 200;    ///< bounds the time without convergence
  int krylov_dimension = 6;  ///< best by measurement: most patches need no restart
  unsigned start = 0;        ///< 0: a circle along the boundary; otherwise the seed of a pseudo-random start
};

struct Eigenpair {
  ComplexVector vector;  ///< (V,)
  double mu = 0;         ///< largest eigenvalue of the switched problem
  /// solve_eigenproblem: |T y - mu y| / (mu |y|); the others: the last relative change of z.
  double residual = 0;
  int solves = 0;  ///< solves with the factor
  bool converged = false;
};

/// The eigenvector of the smallest nonzero eigenvalue of L z = lambda B z (Eq. 5), from the largest mu of
///   B^ z = mu (L + s M) z,   mu = 1 / (lambda + s),
/// which is Eq. 7 shifted by the form itself instead of epsilon I, since this keeps the eigenvectors. With Q = I - q
/// q^T, q = M^1/2 1 / |M^1/2 1|, it is reduced to the vertices that carry mass,
///   T y = Q M^1/2 S^T (L + s M)^-1 S M^1/2 Q y = mu y,    z = (L + s M)^-1 S M^1/2 y,
/// where S embeds those vertices. Implicitly restarted Lanczos (Spectra) solves it on the real view of the complex
/// vectors: a real Krylov space meets span{z, iz} in one direction, so each eigenvalue appears once. Problems of at
/// most 24 vertices are solved densely. `factorization` holds L + s M.
Eigenpair solve_eigenproblem(Factorization& factorization, const BoundaryForm& form, const EigenproblemOptions& options,
                             const Progress& progress);

/// The same for B = A, the area form of section 3.3, which is indefinite:
///   A z = nu (L + s M) z, largest nu,
/// by Lanczos in the inner product of L + s M on whole vectors, then inverse iterations that remove the shift.
Eigenpair solve_area_eigenproblem(ReducedFactor& factor, const ConformalEnergy& energy, const BoundaryForm& form,
                                  const EigenproblemOptions& options, const Progress& progress);

/// A as a form. It owns a matrix and refers to the energy.
QuotientForm area_quotient(const ConformalEnergy& energy);

}  // namespace spectral_conformal
