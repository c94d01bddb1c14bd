#pragma once

namespace spectral_conformal {

/// The price of a seam along an edge to an artist, per length: 2 across a flat region, where every seam is visible and
/// no texture expects one. It decreases with the angle theta between the normals of the edge's faces, in radians:
/// max(1/10, 2 / (1 + (theta / 20 degrees)^2)). At 20 degrees, where shading begins to show an edge, a seam costs its
/// length. A concave edge counts as one of twice its angle: seams are seen least there.
double seam_price(double theta, bool is_concave);

}  // namespace spectral_conformal
