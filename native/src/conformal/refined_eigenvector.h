#pragma once

#include "conformal/boundary_form.h"
#include "conformal/conformal_energy.h"
#include "conformal/eigenproblem.h"
#include "conformal/extended_eigenproblem.h"
#include "conformal/reduced_factor.h"
#include "geometry/tolerances.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The parameters of one attempt at an eigenproblem.
struct Attempt {
  double relative_shift;  ///< see factor_shifted
  unsigned start;         ///< see EigenproblemOptions, as for the next member
  int krylov_dimension;
  double tolerance_factor;  ///< relative to the requested tolerance
  bool exact_steps;         ///< use corrections of exact length if whole ones do not converge
};

/// The form B of an eigenproblem L z = lambda B z.
struct EigenproblemForm {
  const BoundaryForm& boundary;            ///< M of L + s M, and B^ if the others are not given
  const ExtendedForm* extended = nullptr;  ///< with the soft constraints of section 4.2
  bool is_area = false;                    ///< B = A (section 3.3)
};

/// Starts for solves with soft constraints: solutions of earlier solves with the same factors, or empty.
struct EarlierMaps {
  EarlierBasis free;         ///< of the last one with soft constraints
  EarlierBasis constrained;  ///< of the last one with linear constraints
  ComplexVector z;           ///< the last accepted map without these
};

/// An eigenvector of Eq. 5, up to position and scale.
struct Eigenvector {
  ComplexVector z;      ///< (V,)
  double lambda = 0;    ///< z^H L z / z^H B z
  double residual = 0;  ///< see SolveRecord
  double change = 0;    ///< the last correction, relative to z
  double change_limit = single_epsilon;
  int solves = 0;  ///< with the factor
  bool converged = false;
};

/// The options of the eigenproblem in an attempt at this tolerance.
EigenproblemOptions eigenproblem_options(const Attempt& attempt, double tolerance);

/// Refines what the solver of this form found with the factor of P^* L P + s M (eigenproblem.h,
/// extended_eigenproblem.h): removes the shift and the rounding of the factor by corrections (correction.h), or, if
/// eigenvalues are too close for these, by davidson.h, and measures lambda.
Eigenvector refined_eigenvector(Eigenpair pair, const ConformalEnergy& energy, const EigenproblemForm& form,
                                ReducedFactor& factor, const Attempt& attempt, double tolerance,
                                const Progress& progress);

}  // namespace spectral_conformal
