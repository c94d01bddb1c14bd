#pragma once

#include <vector>

namespace spectral_conformal {

// The caller's choice of energy, form and solver.

enum class Method {
  spectral,  ///< smallest nonzero eigenvalue of L z = lambda B z (Eq. 5): the paper's method
  lscm,      ///< pinned LSCM / DCP (section 2.2)
  fiedler,   ///< B = identity: the Fiedler vector of L (Eq. 4)
  area       ///< B = A (section 3.3)
};

enum class Weights {
  uniform,      ///< every triangle counts with weight 1
  inverse_area  ///< energy and area of a triangle are divided by its area in 3D (section 4.1)
};

enum class BoundaryMeasure {
  length,  ///< half the length of the two adjacent boundary edges: independent of the sampling of the boundary
  vertex   ///< 1 for each boundary vertex, as in the paper (Eq. 5)
};

/// A soft constraint of section 4.2 that pushes two vertices apart (strength > 0) or pulls them together (strength <
/// 0).
struct Extender {
  std::vector<int> from;  ///< one vertex, or its copies along a seam, which act through their barycenter
  std::vector<int> to;
  double strength = 0;  ///< fraction of 1^T M 1: independent of resolution and scale
  double half = 1;      ///< the strength of half the full effect; the unit in a held map, see held_extenders.h
};

enum class FactorizationBackend {
  automatic,  ///< CHOLMOD if built with it and the matrix is not tiny, otherwise Eigen
  cholmod,    ///< SuiteSparse CHOLMOD, supernodal L L^H
  eigen       ///< Eigen's SimplicialLDLT
};

}  // namespace spectral_conformal
