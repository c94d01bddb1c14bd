#pragma once

#include "seams/seam_graph.h"

namespace spectral_conformal {

/// The price of a seam along an edge to an artist, per length: 2 across a flat region, where every seam is visible and
/// no texture expects one. It decreases with the angle theta between the normals of the edge's faces, to 1/10 from
/// theta = 87 degrees on: max(1/10, 2 / (1 + (theta / 20 degrees)^2)). At 20 degrees, where shading begins to show an
/// edge, a seam costs its length.
double seam_price(const SeamGraph::Edge& edge);

/// The angle between the normals of the edge's two faces, in radians, 0 to pi; pi for a cut edge.
double dihedral_angle(const SeamGraph::Edge& edge);

}  // namespace spectral_conformal
