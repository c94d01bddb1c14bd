#pragma once

#include <array>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Length of a closed loop, in the units of the positions.
double loop_length(const BoundaryLoop& loop, const Eigen::Ref<const Positions>& positions);

/// The outer loop: the longest in 3D, the first of equal ones. Precondition: at least one loop.
int outer_loop(const std::vector<BoundaryLoop>& loops, const Eigen::Ref<const Positions>& positions);

/// The two boundary vertices that are farthest from each other along the mesh's edges, found by repeated sweeps
/// (Dijkstra from a vertex to the farthest boundary vertex, from there again, until the distance stops growing): a
/// lower bound of the true diameter that is nearly always attained. The pins that LSCM and DCP recommend
/// (section 3.1). `neighbors` (V x V) holds a nonzero for every edge, in its lower triangle.
std::array<int, 2> farthest_boundary_vertices(const BoundaryLoop& loop, const Eigen::Ref<const Positions>& positions,
                                              const HermitianMatrix& neighbours);

}  // namespace spectral_conformal
