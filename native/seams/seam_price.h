#pragma once

namespace spectral_conformal {

/// What a seam along an edge costs an artist, per length: 2 across a flat region, where every seam is visible and no
/// texture expects one. It decreases with the angle theta between the normals of the edge's faces, in radians:
/// max(1/10, 2 / (1 + (theta / 20 degrees)^2)). At 20 degrees, where shading begins to show an edge, a seam costs its
/// length. A concave edge counts as one with twice its angle: seams are least visible there.
double seam_price(double theta, bool is_concave);

/// The price of a seam along an edge that the modeler has marked (creased, sharp, between two materials) with a
/// strength s from 0 to 1: price^(1 - s) (1/10)^s, from the price without the mark to that of the sharpest edge.
double marked_price(double price, double strength);

}  // namespace spectral_conformal
