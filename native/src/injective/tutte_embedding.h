#pragma once

#include <array>
#include <vector>

#include "linear_algebra/factorization.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// A Tutte embedding of a disk, holes allowed, into the unit circle. The outer loop lies on the circle, spaced by its
/// edge lengths in 3D, or evenly if these are 0. Every other vertex is a weighted mean of its neighbors with positive
/// weights; each hole is closed by a vertex in its middle. By Tutte's theorem (How to Draw a Graph, 1963), for weighted
/// means by Floater (Parametrization and Smooth Approximation of Surface Triangulations, 1997; One-to-One Piecewise
/// Linear Mappings over Triangulations, 2003), it is one-to-one: no triangle is flipped, up to the precision of doubles
/// for parts that shrink toward the middle. The weights start equal. A few rounds lower them along edges that are short
/// for their length in 3D, which the theorem allows and which spreads the vertices. If flips remain because long limbs
/// shrink below double precision, it starts over with weights near zero between vertices at the same edge distance from
/// the circle.
///
/// triangles (F, 3): one triangulation of the chart, counterclockwise; loops: as in Chart, with `outer` the index of
/// the outer one; positions: (V, 3), finite. Returns (V,), or an empty vector if not even the first Tutte system can be
/// solved in double precision. Throws Cancelled, and as Factorization does.
ComplexVector tutte_embedding(const std::vector<std::array<int, 3>>& triangles, const std::vector<BoundaryLoop>& loops,
                              int outer, const Eigen::Ref<const Positions>& positions, FactorizationBackend backend,
                              const Progress& progress = {});

}  // namespace spectral_conformal
