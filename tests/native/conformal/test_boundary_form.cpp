#include <doctest/doctest.h>

#include <cmath>

#include "conformal/boundary_form.h"
#include "mesh/boundary_loops.h"
#include "meshes.h"

namespace spectral_conformal::test {
namespace {

/// B^ of Eq. 7, stored.
Eigen::MatrixXd stored(const BoundaryForm& form, Eigen::Index n) {
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(n);
  for (std::size_t i = 0; i < form.vertices.size(); ++i) mass[form.vertices[i]] = form.mass[i];
  return Eigen::MatrixXd(mass.asDiagonal()) - mass * mass.transpose() / mass.sum();
}

}  // namespace

TEST_SUITE_BEGIN("boundary_form");

TEST_CASE("value is the quadratic form of Eq. 7 and does not see a constant") {
  const Patch patch(perforated_grid(6, 6));
  const ComplexVector z = random_map(patch.positions.rows());
  for (const auto measure : {BoundaryMeasure::length, BoundaryMeasure::vertex}) {
    const BoundaryForm form = boundary_form(patch.outer(), patch.positions, measure);
    const Eigen::MatrixXd matrix = stored(form, z.size());
    CHECK((matrix * Eigen::VectorXd::Ones(z.size())).norm() < 1e-12);
    CHECK(form.value(z) == doctest::Approx(z.dot(matrix * z).real()).epsilon(1e-12));
    ComplexVector applied = z;
    form.add_applied(z, -2, applied);
    CHECK(difference(applied, z - 2 * (matrix * z)) < 1e-13);
    CHECK(form.value((z.array() + Complex(1e6, -3e5)).matrix()) == doctest::Approx(form.value(z)).epsilon(1e-9));
    CHECK(form.value(ComplexVector::Constant(z.size(), Complex(0.7, 0.1))) < 1e-28);
  }
}

TEST_CASE("only the vertices of the loop carry mass: 1 each, or the length of the boundary in all") {
  const Patch patch(perforated_grid(6, 6));
  const BoundaryLoop& loop = patch.outer();
  const BoundaryForm vertex = boundary_form(loop, patch.positions, BoundaryMeasure::vertex);
  CHECK(vertex.vertices == loop);
  CHECK(vertex.mass == Eigen::VectorXd::Ones(static_cast<Eigen::Index>(loop.size())));
  const BoundaryForm length = boundary_form(loop, patch.positions, BoundaryMeasure::length);
  CHECK(length.vertices == loop);
  CHECK(length.total() == doctest::Approx(loop_length(loop, patch.positions)).epsilon(1e-14));
}

TEST_CASE("the length form of a straight-sided map converges under subdivision of the boundary, the vertex form not") {
  // A square of side 1 whose first side has n vertices; the map is the square itself.
  const auto value = [](int n, BoundaryMeasure measure) {
    Positions square(n + 3, 3);
    for (int i = 0; i < n; ++i) square.row(i) << static_cast<double>(i) / n, 0, 0;
    square.bottomRows(3) << 1, 0, 0, 1, 1, 0, 0, 1, 0;
    BoundaryLoop loop(static_cast<std::size_t>(n) + 3);
    for (int i = 0; i < n + 3; ++i) loop[i] = i;
    const BoundaryForm form = boundary_form(loop, square, measure);
    CHECK((measure == BoundaryMeasure::vertex || form.total() == doctest::Approx(4)));
    return form.value(flat_map(square)) / form.total();
  };
  const double limit = value(4000, BoundaryMeasure::length);
  CHECK(value(20, BoundaryMeasure::length) == doctest::Approx(limit).epsilon(2e-3));
  CHECK(std::abs(value(20, BoundaryMeasure::vertex) / limit - 1) > 0.1);
}

TEST_CASE("vertices whose boundary edges have no length get no mass") {
  Positions positions(5, 3);
  positions << 0, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0;
  const BoundaryForm form = boundary_form({0, 1, 2, 3, 4}, positions, BoundaryMeasure::length);
  CHECK(form.vertices == std::vector<int>{0, 1, 3, 4});
  CHECK(form.mass.minCoeff() > 0);
  CHECK(form.total() == doctest::Approx(2 + std::sqrt(2.0)));
}

TEST_CASE("the identity form measures the spread of all vertices about their mean") {
  const ComplexVector z = random_map(30);
  const BoundaryForm form = identity_form(30);
  CHECK(form.value(z) == doctest::Approx((z.array() - z.mean()).matrix().squaredNorm()).epsilon(1e-13));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
