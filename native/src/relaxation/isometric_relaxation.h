#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "geometry/triangle_shape.h"
#include "linear_algebra/factorization.h"
#include "relaxation/descent.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/relaxation_status.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Energies are means of s1^2 + s2^2 + 1 / s1^2 + 1 / s2^2 over the triangles, with the singular values s1, s2 of their
/// Jacobians, weighted by triangle weight times area, at the uniform scale that minimizes the mean: 4 for an isometry.
/// Virtual triangles, clamped shapes and triangles with next to no image area are omitted.
struct IsometricMap {
  ComplexVector z;           ///< (V,) u + i v, at the scale of minimum energy; the input if nothing could be done
  double energy_before = 0;  ///< of the input; 0 if no triangle of it could be measured
  double energy = 0;         ///< of z
  RelaxationStatus status = RelaxationStatus::no_image_area;  ///< why the descent ended
  int iterations = 0;                                         ///< steps taken
  int factorizations = 0;                                     ///< including repetitions because of rounding
  /// Triangles of z, neither virtual nor clamped, without positive image area; never more than before.
  int flipped = 0;
};

/// Moves a map toward an isometry: minimizes the symmetric Dirichlet energy (Smith and Schaefer, Bijective
/// Parameterization with Free Boundaries, 2015). The descent direction comes from a Dirichlet form reweighted as by
/// Rabinovich, Poranne, Panozzo and Sorkine-Hornung (Scalable Locally Injective Mappings, 2017), but with one weight
/// per triangle, so that one complex unknown per vertex suffices; L-BFGS steps (Liu and Nocedal 1989) reuse its factor.
/// No step flips a triangle with image area; the determinants of those without are regularized.
///
/// z: (V,), finite, mostly counterclockwise; triangles: connected; shapes and triangle_weights (1, or 1/2 if both
/// splits of a quad are present): per triangle. The last `n_virtual` triangles are virtual (see hole_filling.h): at a
/// hundredth of their weight they keep the holes from turning inside out without affecting the shape of the map. Throws
/// Cancelled, and as Factorization does.
IsometricMap relax_to_isometry(const std::vector<std::array<int, 3>>& triangles,
                               const std::vector<TriangleShape>& shapes,
                               const std::vector<TriangleWeight>& triangle_weights, std::size_t n_virtual,
                               ComplexVector z, FactorizationBackend backend, const DescentOptions& options = {},
                               const Progress& progress = {});

}  // namespace spectral_conformal
