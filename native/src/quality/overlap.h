#pragma once

#include <array>

#include "geometry/tolerances.h"
#include "mesh/charts.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Of heights in a map of stored UVs, relative to its coordinates. These have a relative error of up to half of
/// single_epsilon; in both coordinates of two points, it changes a height by up to 1.4 times single_epsilon.
constexpr double stored_resolution = 2 * single_epsilon;

/// For each triangle of a map, whether its interior meets that of another triangle (of another face, if `face` gives
/// the face of each). A pair overlaps if no side of either separates them. Candidates come from a BoxTree or, if the
/// boxes of very many pairs meet, from sweep_triangles: O(k n log n), where k is the largest number of triangles over
/// one point not yet known to overlap, mostly 1 or 2. Contacts shallower than 1e-9 of the smaller triangle's size, or
/// than `resolution` times the pair's largest coordinate, do not count. Among triangles in contact, and among those of
/// one of several faces that meet, all pairs of boxes are visited, unless `resolution` allows corners to be merged.
/// map: (V,), finite; face: (F,), or empty.
std::vector<bool> overlapping_triangles(const std::vector<std::array<int, 3>>& triangles, const ComplexVector& map,
                                        const std::vector<int>& face = {}, double resolution = 0);

/// The triangles of several charts in one map. Each chart has vertices of its own.
struct MapOfCharts {
  std::vector<std::array<int, 3>> triangles;
  std::vector<char> mirrored;       ///< per triangle: its chart is mirrored in the map
  std::vector<int> face;            ///< of each triangle
  std::vector<int> loose;           ///< triangles of no chart, or of one that is not orientable
  std::vector<BoundaryLoop> loops;  ///< of the other charts, each to the left of its loops in the map
  std::vector<Complex> z;

  /// Adds the triangles `which` of a chart; face_of_each: (which.size(),).
  void add(const Chart& chart, const ComplexVector& chart_z, bool is_mirrored, const std::vector<int>& which,
           const std::vector<int>& face_of_each);
  /// Adds a triangle of no chart.
  void add_loose(const std::array<Complex, 3>& corners, int its_face);
};

/// The same for charts. If have_degree_at_most_one permits it, tests only pairs with a triangle that is loose or wound
/// against its chart, so that separate islands cost O(n log n), however many boxes meet.
std::vector<bool> overlapping_in_map(const MapOfCharts& map, double resolution = 0);

/// The faces of a chart, as indices into its `faces`, ascending, whose images under z cover part of another face's.
/// Triangulates by mapped_triangulation. If has_degree_at_most_one permits it, tests only pairs with one of the
/// non_positive_triangles, so that an injective map costs next to nothing. z: (V,), positively oriented.
std::vector<int> overlapping_faces(const Chart& chart, const ComplexVector& z, double resolution = 0);

}  // namespace spectral_conformal
