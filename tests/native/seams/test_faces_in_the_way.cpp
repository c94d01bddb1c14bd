#include <doctest/doctest.h>

#include <algorithm>
#include <complex>
#include <iterator>

#include "meshes.h"
#include "quality/overlap.h"
#include "seams/faces_in_the_way.h"

namespace spectral_conformal::test {
namespace {

/// A flat mesh of one chart with a given map.
struct GivenMap {
  Mesh mesh;
  SeamGraph graph;
  TrialMap mapped;

  explicit GivenMap(Mesh given) : mesh(std::move(given)), graph(SeamGraph::of(mesh.view())) {
    mapped.chart = build_charts(mesh.view()).charts.front();
    mapped.solved = true;
    mapped.z.resize(static_cast<Eigen::Index>(mesh.points.size()));
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
      mapped.z[static_cast<Eigen::Index>(v)] = {mesh.points[v].x(), mesh.points[v].y()};
    }
  }
  SeparableFaces faces() const {
    const std::size_t n = mapped.chart.faces.size();
    return {graph, mapped.chart.faces, std::vector<double>(n, 1),
            std::vector<Eigen::Vector3d>(n, Eigen::Vector3d::Zero())};
  }
  /// Whether none of the defective faces but those in the way lie on each other.
  bool is_free_without(const std::vector<int>& in_the_way, const std::vector<int>& defective) const {
    std::vector<int> rest;
    std::set_difference(defective.begin(), defective.end(), in_the_way.begin(), in_the_way.end(),
                        std::back_inserter(rest));
    std::vector<std::array<int, 3>> triangles;
    std::vector<int> face;
    for (std::size_t t = 0; t < mapped.chart.triangles.size(); ++t) {
      if (!std::binary_search(rest.begin(), rest.end(), mapped.chart.triangle_face[t])) continue;
      triangles.push_back(mapped.chart.triangles[t]);
      face.push_back(mapped.chart.triangle_face[t]);
    }
    const std::vector<bool> overlapping = overlapping_triangles(triangles, mapped.z, face);
    return std::find(overlapping.begin(), overlapping.end(), true) == overlapping.end();
  }
};

}  // namespace

TEST_SUITE_BEGIN("faces_in_the_way");

TEST_CASE("of two ends that lie on each other one is in the way") {
  // A strip bent around by somewhat more than a whole turn.
  GivenMap strip(flat_grid(24, 1));
  double length = 0;
  for (const auto& point : strip.mesh.points) length = std::max(length, point.x());
  for (std::size_t v = 0; v < strip.mesh.points.size(); ++v) {
    const auto& point = strip.mesh.points[v];
    strip.mapped.z[static_cast<Eigen::Index>(v)] =
        std::polar(2.0 - (point.y() > 0.5 ? 1.0 : 0.0), 6.9 * point.x() / length);
  }
  const std::vector<int> defective = defective_faces(strip.mapped);
  REQUIRE(defective.size() > 4);
  const std::vector<int> found = faces_in_the_way(strip.faces(), strip.mapped, defective);
  CHECK_FALSE(found.empty());
  CHECK(2 * found.size() <= defective.size() + 1);
  CHECK(std::is_sorted(found.begin(), found.end()));
  CHECK(strip.is_free_without(found, defective));
  // All at one end.
  CHECK(found.back() - found.front() == static_cast<int>(found.size()) - 1);
}

TEST_CASE("flipped faces are in the way of what they lie on") {
  GivenMap grid(flat_grid(8, 8));
  grid.mapped.z[40] = grid.mapped.z[40] + Complex(1.4, 0.2);
  for (std::size_t t = 0; t < grid.mapped.chart.triangles.size(); ++t) {
    const auto& [a, b, c] = grid.mapped.chart.triangles[t];
    const auto& z = grid.mapped.z;
    if ((std::conj(z[b] - z[a]) * (z[c] - z[a])).imag() < 0) {
      grid.mapped.flipped.push_back(grid.mapped.chart.triangle_face[t]);
    }
  }
  REQUIRE_FALSE(grid.mapped.flipped.empty());
  const std::vector<int> defective = defective_faces(grid.mapped);
  const std::vector<int> found = faces_in_the_way(grid.faces(), grid.mapped, defective);
  CHECK(std::includes(found.begin(), found.end(), grid.mapped.flipped.begin(), grid.mapped.flipped.end()));
  CHECK(found.size() < defective.size());
  CHECK(grid.is_free_without(found, defective));
}

TEST_CASE("nothing is in the way where nothing is defective") {
  const GivenMap grid(flat_grid(4, 4));
  CHECK(faces_in_the_way(grid.faces(), grid.mapped, {}).empty());
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
