#include "mesh/corner_pins.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "geometry/nearest_point.h"
#include "graph/adjacency.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal {
namespace {

Complex uv_of(const CornerPins& pins, int corner) {
  const double* uv = pins.uv + 2 * static_cast<std::size_t>(corner);
  return {uv[0], uv[1]};
}

/// The distinct pins of each vertex with several, in the order of the corners. Non-finite pins are reported later, by
/// chart.
std::map<int, std::vector<Complex>> different_pins(const PolygonMesh& mesh, const CornerPins& pins) {
  struct Pin {
    int vertex;
    Complex uv;
    int corner;
  };
  std::vector<Pin> all;
  for_each_selected_corner(mesh, [&](int c, int /*face*/) {
    if (!pins.pinned[c]) return;
    const Complex uv = uv_of(pins, c);
    if (is_finite(uv)) all.push_back({mesh.corner_vertices[c], uv, c});
  });
  const auto place = [](const Pin& pin) { return std::tuple(pin.vertex, pin.uv.real(), pin.uv.imag()); };
  std::sort(all.begin(), all.end(), [&](const Pin& a, const Pin& b) {
    return std::tuple(place(a), a.corner) < std::tuple(place(b), b.corner);
  });
  const auto is_same = [&](const Pin& a, const Pin& b) { return place(a) == place(b); };
  all.erase(std::unique(all.begin(), all.end(), is_same), all.end());
  std::sort(all.begin(), all.end(),
            [](const Pin& a, const Pin& b) { return std::pair(a.vertex, a.corner) < std::pair(b.vertex, b.corner); });
  std::map<int, std::vector<Complex>> result;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool is_alone =
        (i == 0 || all[i - 1].vertex != all[i].vertex) && (i + 1 == all.size() || all[i + 1].vertex != all[i].vertex);
    if (!is_alone) result[all[i].vertex].push_back(all[i].uv);
  }
  return result;
}

/// Finds the copy for each corner of a vertex: the one whose pin is nearest to the corner's UV.
class NearestCopy {
 public:
  explicit NearestCopy(const std::vector<Complex>& pins) : nearest_(NearestPoint::among(pins)) {}
  int of(Complex uv) {
    if (!is_finite(uv)) return 0;
    // Many corners may share a UV, for example all without a map.
    const auto [known, is_new] = known_.try_emplace({uv.real(), uv.imag()}, 0);
    if (is_new) known->second = nearest_.to(uv);
    return known->second;
  }

 private:
  NearestPoint nearest_;
  std::map<std::pair<double, double>, int> known_;
};

}  // namespace

PinSplitMesh PinSplitMesh::of(const PolygonMesh& mesh, const CornerPins& pins) {
  validate(mesh);
  PinSplitMesh result;
  result.mesh_ = mesh;
  if (pins.pinned == nullptr) return result;
  const std::map<int, std::vector<Complex>> split = different_pins(mesh, pins);
  if (split.empty()) return result;

  std::map<int, int> first_copy;
  std::map<int, NearestCopy> nearest;
  for (const auto& [vertex, positions] : split) {
    if (positions.size() >
        static_cast<std::size_t>(std::numeric_limits<int>::max() - mesh.n_vertices) - result.copied_.size()) {
      throw InvalidMesh(Rejection::too_many_pins);
    }
    first_copy[vertex] = mesh.n_vertices + static_cast<int>(result.copied_.size());
    nearest.emplace(vertex, positions);
    result.copied_.insert(result.copied_.end(), positions.size() - 1, vertex);
  }
  const Eigen::Map<const Positions> given(mesh.positions, mesh.n_vertices, 3);
  result.split_.positions.resize(mesh.n_vertices + static_cast<Eigen::Index>(result.copied_.size()), 3);
  result.split_.positions << given, given(result.copied_, Eigen::all);
  result.split_.corner_vertices.assign(mesh.corner_vertices, mesh.corner_vertices + mesh.n_corners());
  for_each_selected_corner(mesh, [&](int c, int /*face*/) {
    const auto found = nearest.find(mesh.corner_vertices[c]);
    if (found == nearest.end()) return;
    const int copy = found->second.of(uv_of(pins, c));
    if (copy > 0) result.split_.corner_vertices[static_cast<std::size_t>(c)] = first_copy[found->first] + copy - 1;
  });
  result.add_seams(split);
  return result;
}

void PinSplitMesh::add_seams(const std::map<int, std::vector<Complex>>& split) {
  // Connect only those copies that share a side of a face: all pairs would be too many around a pole.
  std::set<std::array<int, 2>> at_copies;
  for (int i = 0; i < mesh_.n_seam_edges; ++i) {
    const auto& [a, b] = mesh_.seam_edges[i];
    split_.seams.push_back({a, b});
    if (split.count(a) + split.count(b) > 0) at_copies.insert(edge_between(a, b));
  }
  std::set<std::array<int, 2>> copies;
  for_each_side(mesh_, [&](int c, int next, int /*face*/) {
    const auto original = edge_between(mesh_.corner_vertices[c], mesh_.corner_vertices[next]);
    const auto copy = edge_between(split_.corner_vertices[c], split_.corner_vertices[next]);
    if (copy != original && at_copies.count(original) > 0) copies.insert(copy);
  });
  split_.seams.insert(split_.seams.end(), copies.begin(), copies.end());
}

Pins chart_pins(const PolygonMesh& mesh, const Chart& chart, const std::vector<int>& chart_vertex_of_corner,
                const CornerPins& pins) {
  Pins means;
  if (pins.pinned == nullptr) return means;
  std::map<int, int> counts;
  for (const int face : chart.faces) {
    for (int c = mesh.face_offsets[face]; c < mesh.face_offsets[face + 1]; ++c) {
      if (!pins.pinned[c]) continue;
      const Complex uv = uv_of(pins, c);
      if (!is_finite(uv)) throw InvalidMesh(Rejection::pinned_uv_not_finite, face);
      // Preserves equal pins, the usual case, bit for bit.
      const int count = ++counts[chart_vertex_of_corner[c]];
      Complex& mean = means[chart_vertex_of_corner[c]];
      mean += (uv - mean) / static_cast<double>(count);
    }
  }
  return means;
}

}  // namespace spectral_conformal
