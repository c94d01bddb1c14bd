#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "meshes.h"
#include "spectral_conformal/errors.h"
#include "spectral_conformal/unwrap.h"

namespace spectral_conformal::test {
namespace {

Unwrap unwrapped(const Mesh& mesh, UnwrapOptions options = {}, const Pins& pins = {}) {
  options.vertex_pins = pins;
  Unwrap result = unwrap(mesh.view(), options, {});
  REQUIRE(result.uv.rows() == static_cast<Eigen::Index>(mesh.corners.size()));
  CHECK(result.uv.allFinite());
  for (int face = 0; face < mesh.n_faces(); ++face) {
    for (int c = mesh.offsets[face]; c < mesh.offsets[face + 1]; ++c) {
      const int chart = result.chart_of_face[face];
      CHECK(result.solved_corners[c] == (chart >= 0 && result.charts[chart].solved));
      if (!result.solved_corners[c]) CHECK(result.uv.row(c).isZero(0));
    }
  }
  return result;
}

bool is_rejected(const UnwrappedChart& chart, Rejection reason) {
  return chart.steps.size() == 1 && chart.steps[0].kind == StepKind::rejected && chart.steps[0].reason == reason;
}

/// How far two results lie apart, relative to their size.
double difference_of(const Unwrap& a, const Unwrap& b) { return (a.uv - b.uv).norm() / b.uv.norm(); }

/// A flat patch, a closed one, one with a coordinate that is not finite, a Moebius strip, and a bumpy one.
Mesh mixed_components() {
  Mesh mesh = flat_grid(4, 3);
  mesh.append(tetrahedron());
  Mesh broken = flat_grid(2, 2);
  broken.points[4].x() = std::numeric_limits<double>::quiet_NaN();
  mesh.append(broken);
  mesh.append(ring(9, 1));
  mesh.append(perforated_grid(7, 7));
  return mesh;
}

}  // namespace

TEST_SUITE_BEGIN("unwrap");

TEST_CASE("what can be solved is solved, the rest is reported with its reason") {
  const Unwrap result = unwrapped(mixed_components());
  REQUIRE(result.charts.size() == 5);
  CHECK((result.charts[0].solved && result.charts[4].solved));
  CHECK((is_rejected(result.charts[1], Rejection::closed) && !result.charts[1].solved));
  CHECK((is_rejected(result.charts[2], Rejection::vertex_not_finite) && !result.charts[2].solved));
  CHECK((is_rejected(result.charts[3], Rejection::not_orientable) && !result.charts[3].solved));
  for (const int chart : {0, 4}) {
    CHECK(result.charts[chart].steps.empty());
    CHECK(result.charts[chart].turning_number == 1);
    CHECK(result.charts[chart].flipped == 0);
    CHECK(result.charts[chart].residual < 1e-10);
  }
  CHECK(result.charts[0].max_qc - 1 < 1e-9);
  CHECK(result.charts[4].mean_qc > 1.001);
  CHECK(result.charts[4].n_vertices == 64);
}

TEST_CASE("along a seam corners of one mesh vertex differ, elsewhere they agree") {
  Mesh mesh = ring(12, 0);
  mesh.seams = {{1, 0}};
  const Unwrap result = unwrapped(mesh);
  REQUIRE(result.charts.size() == 1);
  CHECK(result.charts[0].n_vertices == 26);
  CHECK((result.uv.row(0) - result.uv.row(45)).norm() > 1);
  CHECK((result.uv.row(1) - result.uv.row(4)).norm() == 0);
}

TEST_CASE("a ramp that climbs around an axis more than once overlaps in its map, without a flip") {
  for (const double turns : {0.9, 1.25}) {
    constexpr int n = 40;
    Mesh ramp;
    for (int i = 0; i <= n; ++i) {
      const double angle = 2 * 3.14159265358979323846 * turns * i / n;
      for (const double radius : {2.0, 2.5, 3.0}) {
        ramp.points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0.05 * angle);
      }
    }
    for (int i = 0; i < n; ++i) {
      for (const int a : {3 * i, 3 * i + 1}) ramp.add({a, a + 1, a + 4, a + 3});
    }
    const Unwrap result = unwrapped(ramp);
    REQUIRE(result.charts[0].solved);
    CHECK(result.charts[0].flipped == 0);
    CHECK(result.charts[0].turning_number == 1);
    CHECK((result.charts[0].overlapping > n / 2) == (turns > 1));
    CHECK((result.charts[0].overlapping == 0) == (turns < 1));
  }
}

TEST_CASE("every method and option reaches the solver") {
  const Mesh mesh = perforated_grid(7, 7);
  std::vector<double> eigenvalues;
  for (const auto method : {Method::spectral, Method::lscm, Method::fiedler, Method::area}) {
    UnwrapOptions options;
    options.solve.method = method;
    eigenvalues.push_back(unwrapped(mesh, options).charts[0].eigenvalue);
  }
  UnwrapOptions inverse, vertex;
  inverse.patch.weights = Weights::inverse_area;
  vertex.patch.boundary = BoundaryMeasure::vertex;
  eigenvalues.push_back(unwrapped(mesh, inverse).charts[0].eigenvalue);
  eigenvalues.push_back(unwrapped(mesh, vertex).charts[0].eigenvalue);
  std::sort(eigenvalues.begin(), eigenvalues.end());
  CHECK(eigenvalues.front() > 0);
  CHECK(std::adjacent_find(eigenvalues.begin(), eigenvalues.end()) == eigenvalues.end());
}

TEST_CASE("pins go to the charts that have their vertices") {
  Mesh mesh = flat_grid(4, 3);
  Mesh second = bumpy_grid(3, 3);
  mesh.append(second);
  UnwrapOptions options;
  options.solve.method = Method::lscm;
  const Unwrap result = unwrapped(mesh, options, {{0, {5, 6}}, {4, {9, 6}}});
  for (std::size_t c = 0; c < mesh.corners.size(); ++c) {
    if (mesh.corners[c] == 0) CHECK(result.uv.row(c) == Eigen::RowVector2d(5, 6));
    if (mesh.corners[c] == 4) CHECK(result.uv.row(c) == Eigen::RowVector2d(9, 6));
  }
  CHECK((result.charts[0].solved && result.charts[1].solved));
}

TEST_CASE("an extender acts where a chart has both vertices, on the barycenter of their copies") {
  Mesh mesh = bumpy_grid(6, 5);
  const int second = static_cast<int>(mesh.points.size());
  mesh.append(bumpy_grid(4, 4));
  UnwrapOptions options;
  options.extenders = {{0, 41, 0.5}, {2, second + 3, 0.5}, {second, second + 24, 0.0}};
  const Unwrap result = unwrapped(mesh, options);
  CHECK(result.unused_extenders == std::vector<bool>{false, true, false});
  const Unwrap plain = unwrapped(mesh);
  for (std::size_t c = 0; c < mesh.corners.size(); ++c) {
    const bool in_second = mesh.corners[c] >= second;
    const double change =
        (result.uv.row(static_cast<Eigen::Index>(c)) - plain.uv.row(static_cast<Eigen::Index>(c))).norm();
    if (in_second) CHECK(change == 0);
  }
  CHECK(difference_of(result, plain) > 1e-4);

  // A ring cut open: both ends have a copy of vertex 0.
  Mesh cut = ring(12, 0);
  for (auto& point : cut.points) point.z() += 0.3 * point.x();
  cut.seams = {{0, 1}};
  UnwrapOptions pulled;
  pulled.extenders = {{0, 12, 1.0}};
  const Unwrap ring_map = unwrapped(cut, pulled);
  REQUIRE(ring_map.charts.size() == 1);
  CHECK(ring_map.charts[0].solved);
  CHECK_FALSE(ring_map.unused_extenders[0]);
}

TEST_CASE("hard pins leave extenders without effect, soft ones do not") {
  const Mesh mesh = bumpy_grid(6, 5);
  UnwrapOptions options;
  options.extenders = {{0, 41, 0.5}};
  const Pins pins{{0, {0, 0}}, {6, {6, 0}}, {41, {6, 5}}};
  CHECK(unwrapped(mesh, options, pins).unused_extenders[0]);
  options.solve.soft_pins = 1;
  CHECK_FALSE(unwrapped(mesh, options, pins).unused_extenders[0]);
}

TEST_CASE("a metric of faces is that of their triangles, whichever way they are wound") {
  Mesh mesh = quad_grid(4, 3);
  mesh.reverse(5);
  std::vector<SpaceMetric> metric(static_cast<std::size_t>(mesh.n_faces()), SpaceMetric::Identity());
  for (SpaceMetric& g : metric) g(0, 0) = 4;
  UnwrapOptions options;
  options.metric = metric.data();
  const Unwrap result = unwrapped(mesh, options);
  REQUIRE(result.charts[0].solved);
  // Twice as long along x, so a map of 8 x 3, with the area of 4 x 3.
  const Eigen::RowVector2d extent = result.uv.colwise().maxCoeff() - result.uv.colwise().minCoeff();
  CHECK(extent.maxCoeff() == doctest::Approx(8 / std::sqrt(2.0)).epsilon(1e-9));
  CHECK(extent.minCoeff() == doctest::Approx(3 / std::sqrt(2.0)).epsilon(1e-9));
  CHECK(result.charts[0].mean_qc == doctest::Approx(2).epsilon(1e-9));
  metric[3](0, 0) = -1;
  const Unwrap refused = unwrapped(mesh, options);
  CHECK_FALSE(refused.charts[0].solved);
  REQUIRE(refused.charts[0].steps.size() == 1);
  CHECK((refused.charts[0].steps[0].reason == Rejection::metric_not_positive && refused.charts[0].steps[0].count == 3));
}

TEST_CASE("repairs are counted, duplicates follow their twins") {
  Mesh mesh = flat_grid(4, 3);
  mesh.reverse(5);
  mesh.points[7] = mesh.points[6];
  mesh.add({mesh.corners[0], mesh.corners[1], mesh.corners[2]});
  const Unwrap result = unwrapped(mesh);
  REQUIRE(result.charts.size() == 1);
  REQUIRE(result.charts[0].solved);
  const std::vector<Step>& steps = result.charts[0].steps;
  REQUIRE(steps.size() == 3);
  CHECK((steps[0].kind == StepKind::reoriented_faces && steps[0].count == 1));
  CHECK((steps[1].kind == StepKind::duplicate_faces && steps[1].count == 1));
  CHECK((steps[2].kind == StepKind::degenerate_triangles && steps[2].count == 2));
  const int last = static_cast<int>(mesh.corners.size()) - 3;
  for (int k = 0; k < 3; ++k) CHECK(result.uv.row(last + k) == result.uv.row(k));
  CHECK(result.charts[0].faces.back() == mesh.n_faces() - 1);
}

TEST_CASE("degenerate faces together make one failed chart, the last") {
  Mesh mesh = quad_grid(2, 2);
  mesh.add({0, 1, 1});
  mesh.append(flat_grid(2, 2));
  mesh.add({3, 3});
  const Unwrap result = unwrapped(mesh);
  REQUIRE(result.charts.size() == 3);
  CHECK(result.charts[2].faces == std::vector<int>{4, 13});
  CHECK_FALSE(result.charts[2].solved);
  REQUIRE(result.charts[2].steps.size() == 1);
  CHECK(result.charts[2].steps[0].kind == StepKind::degenerate_faces);
  CHECK(result.chart_of_face[4] == 2);
}

TEST_CASE("faces that are not selected stay out") {
  const Mesh mesh = quad_grid(3, 1);
  PolygonMesh view = mesh.view();
  const bool selected[] = {true, false, true};
  view.selected_faces = selected;
  const Unwrap result = unwrap(view, {}, {});
  CHECK(result.chart_of_face == std::vector<int>{0, -1, 1});
  CHECK(std::count(result.solved_corners.begin(), result.solved_corners.end(), true) == 8);
}

TEST_CASE("an empty mesh has nothing to unwrap; arrays that do not describe a mesh are refused") {
  CHECK(unwrapped({}).charts.empty());
  Mesh broken = quad_grid(1, 1);
  broken.corners[0] = 7;
  CHECK_THROWS_AS(unwrap(broken.view(), {}, {}), InvalidMesh);
}

TEST_CASE("the cost of a fold-free map of quads is measured by one rule before and after") {
  // mean_qc_before averaged both splits of each quad, mean_qc took one: the cost looked smaller than it is.
  const Mesh floater({{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, 0, 0}, {0.75, 0.5, 0}, {0.25, 0.5, 0}, {0.5, -2, 1}},
                     {{6, 3, 1, 4}, {6, 4, 2, 5}, {6, 5, 0, 3}});
  for (const Mesh& mesh : {floater, spiky_grid(2, 16)}) {
    UnwrapOptions options;
    const UnwrappedChart folded = unwrapped(mesh, options).charts.front();
    REQUIRE(folded.flipped > 0);
    options.solve.fold_free = true;
    const UnwrappedChart fold_free = unwrapped(mesh, options).charts.front();
    REQUIRE(fold_free.unfolded > 0);
    CHECK(fold_free.flipped == 0);
    CHECK(fold_free.mean_qc_before == doctest::Approx(folded.mean_qc).epsilon(1e-9));
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
