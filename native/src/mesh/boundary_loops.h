#pragma once

#include <array>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Length of a closed loop, in the units of the positions.
double loop_length(const BoundaryLoop& loop, const Eigen::Ref<const Positions>& positions);

/// The index of the outer loop: the longest in 3D, the first if several are equal. Precondition: at least one loop.
int outer_loop(const std::vector<BoundaryLoop>& loops, const Eigen::Ref<const Positions>& positions);

/// The two boundary vertices farthest apart along the mesh edges: the pins that LSCM and DCP recommend (section 3.1).
/// Found by repeated sweeps (Dijkstra from a vertex to the farthest boundary vertex, then from there, until the
/// distance stops growing): a lower bound of the diameter, nearly always exact. `neighbors` (V x V) has a nonzero for
/// every edge, in its lower triangle.
std::array<int, 2> farthest_boundary_vertices(const BoundaryLoop& loop, const Eigen::Ref<const Positions>& positions,
                                              const HermitianMatrix& neighbors);

}  // namespace spectral_conformal
