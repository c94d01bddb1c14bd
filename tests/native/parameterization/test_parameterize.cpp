#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "conformal/boundary_form.h"
#include "layout/placement.h"
#include "meshes.h"
#include "refusal.h"
#include "spectral_conformal/distortion.h"
#include "spectral_conformal/errors.h"
#include "spectral_conformal/parameterize.h"

namespace spectral_conformal::test {
namespace {

Solver solver(const Patch& patch, Weights weights = Weights::uniform,
              BoundaryMeasure boundary = BoundaryMeasure::length,
              FactorizationBackend backend = FactorizationBackend::automatic) {
  return Solver::of(patch.chart, patch.positions, PatchOptions{weights, boundary, backend});
}

Parameterization solve(const Patch& patch, Method method, Weights weights = Weights::uniform) {
  return solver(patch, weights).solve({method}, {});
}

}  // namespace

TEST_SUITE_BEGIN("parameterize");

TEST_CASE("flat patches come back as themselves, by every method, at any scale and place") {
  const Mesh meshes[] = {flat_grid(12, 9), quad_grid(12, 9)};
  for (const Mesh& flat : meshes) {
    for (const double scale : {1e-15, 1.0, 1e15}) {
      Mesh mesh = flat;
      for (auto& p : mesh.points) p = scale * (p + Eigen::Vector3d(100, -70, 30));
      const Patch patch(mesh);
      for (const auto method : {Method::spectral, Method::lscm, Method::fiedler, Method::area}) {
        for (const auto weights : {Weights::uniform, Weights::inverse_area}) {
          const Parameterization map = solve(patch, method, weights);
          CHECK(map.turning_number == 1);
          CHECK(map.steps.empty());
          const Distortion distortion =
              measure_distortion(patch.positions, patch.chart.triangles, patch.chart.triangle_weights, map.z);
          CHECK(distortion.max_qc - 1 < 1e-9);
          CHECK(distortion.log2_scale.cwiseAbs().maxCoeff() < 1e-6);
        }
      }
    }
  }
}

TEST_CASE("the eigenvalue is that of L z = lambda B z in the units of the input") {
  Mesh mesh = perforated_grid(7, 7);
  for (auto& p : mesh.points) p *= 3;
  const Patch patch(mesh);
  for (const auto weights : {Weights::uniform, Weights::inverse_area}) {
    const ConformalEnergy energy = patch.energy(weights);
    // Weights 1 / |T| instead of mean / |T|.
    const Eigen::MatrixXcd matrix = dense(energy.matrix()) / energy.weight_unit();
    const auto n = static_cast<int>(matrix.cols());
    for (const auto boundary : {BoundaryMeasure::length, BoundaryMeasure::vertex}) {
      const BoundaryForm form = boundary_form(patch.outer(), patch.positions, boundary);
      // The largest mu of B^ z = mu (L + B + 1 1^T) z among those orthogonal to the constants: mu = 1 / (lambda + 1).
      Eigen::VectorXcd mass = Eigen::VectorXcd::Zero(n);
      for (std::size_t i = 0; i < form.vertices.size(); ++i) mass[form.vertices[i]] = form.mass[i];
      const Eigen::MatrixXcd projected = Eigen::MatrixXcd(mass.asDiagonal()) - mass * mass.transpose() / form.total();
      const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXcd> reference(
          projected, matrix + projected + Eigen::MatrixXcd::Ones(n, n));
      const double expected = 1 / reference.eigenvalues()[n - 1] - 1;
      for (const auto backend : backends()) {
        const Parameterization map = solver(patch, weights, boundary, backend).solve({Method::spectral}, {});
        CHECK(map.eigenvalue == doctest::Approx(expected).epsilon(1e-8));
        CHECK(map.residual < 1e-10);
        CHECK(map.iterations > 0);
        CHECK(difference_up_to_similarity(map.z, reference.eigenvectors().col(n - 1)) < 1e-6);
        CHECK(energy.value(map.z) / energy.weight_unit() / form.value(map.z) ==
              doctest::Approx(map.eigenvalue).epsilon(1e-9));
      }
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXcd> fiedler(matrix);
    CHECK(solve(patch, Method::fiedler, weights).eigenvalue == doctest::Approx(fiedler.eigenvalues()[1]).epsilon(1e-8));
    const Parameterization area = solve(patch, Method::area, weights);
    CHECK(area.eigenvalue == doctest::Approx(energy.value(area.z) / energy.area_form(area.z)).epsilon(1e-9));
  }
}

TEST_CASE("maps are centered, positively oriented and as large as the surface") {
  const Patch patch(perforated_grid(10, 7));
  const ConformalEnergy energy = patch.energy(Weights::uniform);
  for (const auto method : {Method::spectral, Method::lscm, Method::fiedler, Method::area}) {
    const Parameterization map = solve(patch, method);
    CHECK(std::abs(map.z.mean()) < 1e-12);
    CHECK(signed_area(energy, map.z) == doctest::Approx(energy.area()).epsilon(1e-12));
    CHECK(map.turning_number == 1);
    CHECK_FALSE(map.timings.empty());
    for (const auto& [phase, seconds] : map.timings) CHECK((seconds >= 0 && !phase.empty()));
  }
}

TEST_CASE("a solver of a mesh takes and returns mesh vertices") {
  Mesh mesh = bumpy_grid(5, 4);
  mesh.points.insert(mesh.points.begin(), {9, 9, 9});
  for (int& corner : mesh.corners) ++corner;
  const Patch patch(mesh);
  const PolygonMesh view = mesh.view();
  Solver of_mesh = Solver::of(view, PatchOptions{});
  Solver of_chart = solver(patch);
  const Pins in_mesh{{1, {1, 2}}, {6, {6, 2}}, {30, {6, 7}}};
  const Pins in_chart{{0, {1, 2}}, {5, {6, 2}}, {29, {6, 7}}};
  const Parameterization map = of_mesh.solve({}, in_mesh);
  CHECK(map.z[0] == 0.0);
  CHECK(map.z.tail(30) == of_chart.solve({}, in_chart).z);
  CHECK(map.timings.front().first == "charts");
  SolveOptions forced;
  forced.extenders = {{{1}, {30}, 0.5}};
  SolveOptions forced_chart;
  forced_chart.extenders = {{{0}, {29}, 0.5}};
  CHECK(difference(of_mesh.solve(forced, {}).z.tail(30), of_chart.solve(forced_chart, {}).z) < 1e-6);
  CHECK(refusal([&] { of_mesh.solve({}, {{0, {1, 2}}}); }).reason == Rejection::unused_pinned_vertex);
  forced.extenders = {{{0}, {30}, 0.5}};
  CHECK_THROWS_AS(of_mesh.solve(forced, {}), InvalidMesh);
  const Mesh closed = tetrahedron();
  CHECK_THROWS_AS(Solver::of(closed.view(), PatchOptions{}), InvalidMesh);
}

TEST_CASE("a mirror-symmetric quad mesh has a mirror-symmetric map") {
  Mesh mesh = quad_grid(10, 6);
  for (auto& p : mesh.points) p = {p.x() - 5, p.y(), std::cos(0.5 * (p.x() - 5)) * (1 + 0.3 * p.y())};
  const Patch patch(mesh);
  for (const auto weights : {Weights::uniform, Weights::inverse_area}) {
    const ComplexVector z = solve(patch, Method::spectral, weights).z;
    ComplexVector mirrored(z.size());
    for (int j = 0; j <= 6; ++j) {
      for (int i = 0; i <= 10; ++i) mirrored[11 * j + i] = z[11 * j + 10 - i];
    }
    CHECK(difference_up_to_similarity(mirrored.conjugate(), z) < 1e-7);
  }
}

TEST_CASE("hard pins are held by pinned LSCM for 'spectral', and refused by the methods that hold none") {
  const Patch patch(bumpy_grid(5, 4));
  const Pins pins{{0, {1, 2}}, {5, {6, 2}}, {29, {6, 7}}};
  const Parameterization held = solver(patch).solve({Method::spectral}, pins);
  CHECK(held.method == Method::lscm);
  CHECK(held.eigenvalue_of == EigenvalueOf::map);
  CHECK(held.z == solver(patch).solve({Method::lscm}, pins).z);
  for (const auto method : {Method::fiedler, Method::area}) {
    CHECK(refusal([&] { solver(patch).solve({method}, pins); }).reason == Rejection::method_without_pins);
    CHECK(solver(patch).solve({method}, {{0, {1, 2}}}).method == method);
  }
  SolveOptions soft;
  soft.soft_pins = 1;
  CHECK(solver(patch).solve(soft, pins).method == Method::spectral);
  SolveOptions forced;
  forced.hole_rigidity = 1;
  CHECK_THROWS_AS(solver(patch).solve(forced, pins), InvalidMesh);
}

TEST_CASE("the fields tell what was solved, and fallbacks can be forbidden") {
  struct Case {
    Mesh mesh;
    Fallback fallback;
  };
  const Case cases[] = {{rounded_grid(40, 0.5), Fallback::tutte_embedding},
                        {rounded_grid(20, 0.5), Fallback::tutte_embedding},
                        {bumpy_grid(6, 5), Fallback::none}};
  for (const Case& c : cases) {
    const Patch patch(c.mesh);
    for (const auto weights : {Weights::uniform, Weights::inverse_area}) {
      const Parameterization map = solver(patch, weights).solve({}, {});
      if (weights == Weights::uniform) CHECK(map.fallback == c.fallback);
      const bool other_weights = map.weights != weights;
      CHECK(other_weights == (map.fallback == Fallback::other_weights));
      CHECK((map.boundary == BoundaryMeasure::vertex) == (map.fallback == Fallback::other_boundary));
      CHECK((map.clamped_triangles > 0) == (map.fallback == Fallback::clamped_triangles));
      CHECK(map.is_embedding == (map.fallback == Fallback::tutte_embedding));
      const bool unfolded = map.fallback == Fallback::unfolded || map.is_embedding;
      CHECK(map.eigenvalue_of == (unfolded ? EigenvalueOf::map : EigenvalueOf::eigenvector));
      CHECK(map.method == Method::spectral);
      CHECK((map.attempts > 2) == (map.fallback != Fallback::none));
      CHECK(map.steps.empty() == (map.fallback == Fallback::none));
      if (map.fallback != Fallback::none) CHECK(count_flipped(patch, map.z) == 0);
    }
    SolveOptions strict;
    strict.fallbacks = false;
    if (c.fallback == Fallback::none) {
      CHECK(solver(patch).solve(strict, {}).z == solver(patch).solve({}, {}).z);
      continue;
    }
    CHECK_THROWS_AS(solver(patch).solve(strict, {}), SolveFailure);
    // The map without flips was asked for, and its eigenvalue is that of the patch's own form.
    strict.fold_free = true;
    const Parameterization asked = Solver::of(patch.chart, patch.positions, PatchOptions()).solve(strict, {});
    CHECK(count_flipped(patch, asked.z) == 0);
    CHECK(asked.eigenvalue_of == EigenvalueOf::map);
    CHECK(asked.boundary == BoundaryMeasure::length);
    CHECK(asked.attempts == 2);
    SolveOptions once = strict;
    once.second_attempt = false;
    const Parameterization asked_once = Solver::of(patch.chart, patch.positions, PatchOptions()).solve(once, {});
    CHECK(asked_once.attempts == 1);
    CHECK(count_flipped(patch, asked_once.z) == 0);
  }
}

TEST_CASE("a map that winds twice under forces is a failure that names them") {
  const Patch patch(bumpy_grid(8, 8));
  SolveOptions options;
  options.extenders = {{{20}, {60}, -1000}};
  try {
    solver(patch).solve(options, {});
    FAIL("solved");
  } catch (const SolveFailure& failure) {
    CHECK((failure.step().reason == Rejection::winding && failure.step().count == 2));
    CHECK((failure.step().attempts == 1 && failure.step().constraint == Constraint::extenders));
  }
}

TEST_CASE("vertices that no face uses, and holes, are no obstacle") {
  Mesh mesh = perforated_grid(7, 7);
  mesh.points.insert(mesh.points.begin(), {9, 9, std::numeric_limits<double>::quiet_NaN()});
  for (int& corner : mesh.corners) ++corner;
  const Patch patch(mesh);
  CHECK(patch.chart.n_vertices() == 64);
  CHECK(solve(patch, Method::spectral).z.allFinite());
}

TEST_CASE("a chart without triangles is refused") {
  Patch patch(bumpy_grid(4, 4));
  patch.chart.triangles = {};
  patch.chart.triangle_weights = {};
  CHECK_THROWS_AS(solver(patch), InvalidMesh);
}

TEST_CASE("the area blend: at 1 the map is the relaxed one, between it lies between") {
  const Patch patch(bumpy_grid(12, 10));
  double last = std::numeric_limits<double>::infinity();
  for (const double amount : {0.0, 0.5, 1.0}) {
    PatchOptions options;
    options.area_blend = amount;
    Solver blended = Solver::of(patch.chart, patch.positions, options);
    const Parameterization map = blended.solve({}, {});
    const Distortion measured =
        measure_distortion(patch.positions, patch.chart.triangles, patch.chart.triangle_weights, map.z);
    CHECK(measured.log2_scale_deviation < last);
    last = measured.log2_scale_deviation;
    CHECK(std::count(measured.flipped.begin(), measured.flipped.end(), true) == 0);
    // The map of a metric is conformal for it.
    if (amount == 1.0) CHECK(map.eigenvalue < 1e-20);
    // Pinned maps keep to the metric too.
    const Pins pins{{0, map.z[0]}, {5, map.z[5]}};
    if (amount == 1.0) CHECK(difference(blended.solve({Method::lscm}, pins).z, map.z) < 1e-8);
  }
  const Parameterization plain = solver(patch).solve({}, {});
  CHECK_FALSE(plain.relaxation);
  CHECK(std::isnan(plain.scale_deviation));
}

TEST_CASE("a patch that is thin to a point is blended as any other") {
  const Patch patch(rounded_grid(40, 1.0 / 20));
  PatchOptions options;
  options.area_blend = 0.5;
  const Parameterization map = Solver::of(patch.chart, patch.positions, options).solve({}, {});
  CHECK(map.fallback == Fallback::none);
  CHECK(map.relaxation);
}

TEST_CASE("the area blend with filled holes") {
  const Patch patch(perforated_grid(10, 10));
  PatchOptions options;
  options.fill_holes = true;
  options.area_blend = 1;
  const Parameterization map = Solver::of(patch.chart, patch.positions, options).solve({}, {});
  CHECK(map.z.size() == patch.positions.rows());
  CHECK(map.eigenvalue < 1e-20);
}

TEST_CASE("triangles below the digits of the coordinates are counted, wherever the map lies") {
  // Pins draw a corner of the map to a point.
  const Patch patch(flat_grid(4, 4));
  const auto unresolved = [&](double offset) {
    Pins pins;
    const ComplexVector z = flat_map(patch.positions);
    for (int v = 0; v < static_cast<int>(z.size()); ++v) pins[v] = z[v];
    pins[1] = z[0] + Complex(0, offset);
    pins[5] = z[0] - offset;
    pins[6] = z[0] + offset;
    const Parameterization map = solver(patch).solve({Method::lscm}, pins);
    int count = 0;
    for (const Step& step : map.steps) count += step.kind == StepKind::unresolved_triangles ? step.count : 0;
    return count;
  };
  CHECK(unresolved(1e-14) == 2);
  CHECK(unresolved(1e-3) == 0);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
