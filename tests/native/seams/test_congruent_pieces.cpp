#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numeric>

#include "meshes.h"
#include "seams/congruent_pieces.h"
#include "spectral_conformal/seam_suggestion.h"

namespace spectral_conformal::test {
namespace {

Mesh moved(Mesh mesh, const Eigen::Vector3d& axis, double angle, double scale, const Eigen::Vector3d& offset) {
  const Eigen::Matrix3d rotation = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  for (Eigen::Vector3d& p : mesh.points) p = (scale * (rotation * p) + offset).cast<float>().cast<double>();
  return mesh;
}

/// A part without symmetry, an image of it that is turned and half as large, with its vertices in the opposite order,
/// and a bent copy.
struct Parts {
  Mesh mesh = moved(bumpy_grid(5, 4), {0, 0, 1}, 0.3, 1, {0, 0, 0});
  SeamSuggestionOptions options;

  Parts() {
    Mesh image = moved(bumpy_grid(5, 4), {1, 2, -1}, 2.1, 0.5, {30, -20, 5});
    const int last = static_cast<int>(image.points.size()) - 1;
    std::reverse(image.points.begin(), image.points.end());
    for (int& v : image.corners) v = last - v;
    mesh.append(image);
    Mesh bent = moved(bumpy_grid(5, 4), {0, 1, 0}, 1, 0.5, {-20, 0, 5});
    bent.points[7] += Eigen::Vector3d(0.01, 0, 0);
    mesh.append(bent);
  }

  std::vector<PieceCopy> copies(bool any_size = true) const {
    const MirroredPieces parts = MirroredPieces::of(mesh.view());
    std::vector<int> numbers(mesh.points.size());
    std::iota(numbers.begin(), numbers.end(), 0);
    return copies_of_pieces(parts, SeamPreferences(options, parts.symmetry, numbers), any_size);
  }
};

std::vector<int> sources(const std::vector<PieceCopy>& copies) {
  std::vector<int> result;
  for (const PieceCopy& copy : copies) result.push_back(copy.source);
  return result;
}

}  // namespace

TEST_SUITE_BEGIN("congruent_pieces");

TEST_CASE("a part that is turned, moved and smaller is a copy, whatever its numbering; a bent one is not") {
  const std::vector<PieceCopy> copies = Parts().copies();
  CHECK(sources(copies) == std::vector<int>{0, 0, 2});
  const int n = static_cast<int>(copies[1].vertex.size());
  for (int v = 0; v < n; ++v) CHECK(copies[1].vertex[v] == n - 1 - v);
}

TEST_CASE("of parts of other sizes, none is a copy where size matters") {
  CHECK(sources(Parts().copies(false)) == std::vector<int>{0, 1, 2});
}

TEST_CASE("a part is no copy of one whose seams cost differently") {
  Parts parts;
  SUBCASE("by its direction") { parts.options.front[2] = 0.5; }
  std::vector<double> painted(parts.mesh.points.size(), 0);
  SUBCASE("by what is painted") {
    painted[3] = 1;
    parts.options.vertex_preference = painted.data();
  }
  const std::array<int, 2> avoided{0, 1};
  SUBCASE("by edges") {
    parts.options.avoided_edges = &avoided;
    parts.options.n_avoided_edges = 1;
  }
  CHECK(sources(parts.copies()) == std::vector<int>{0, 1, 2});
}

TEST_CASE("turned copies of a part get the same seams, for one search") {
  Mesh balls = sphere(6);
  const std::size_t n = balls.points.size();
  for (const double angle : {0.4, 1.1, 2.9}) {
    balls.append(moved(sphere(6), {1, angle, 0.3}, angle, 0.5, {5 * angle, 3, -angle}));
  }
  const SeamSuggestion seams = suggest_seams(balls.view(), {}, {});
  REQUIRE(!seams.edges.empty());
  for (std::size_t cut = 0; cut + 1 < seams.cut_offsets.size(); ++cut) {
    std::vector<int> n_edges(4, 0);
    for (int e = seams.cut_offsets[cut]; e < seams.cut_offsets[cut + 1]; ++e) {
      ++n_edges[static_cast<std::size_t>(seams.edges[e][0]) / n];
    }
    for (const int other : n_edges) CHECK(other == n_edges[0]);
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
