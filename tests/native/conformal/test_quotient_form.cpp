#include <doctest/doctest.h>

#include "conformal/quotient_form.h"
#include "meshes.h"

namespace spectral_conformal::test {
namespace {

struct Fixture {
  Patch patch{perforated_grid(7, 7)};
  BoundaryForm outer = boundary_form(patch.outer(), patch.positions, BoundaryMeasure::length);
  BoundaryForm hole() const {
    for (const BoundaryLoop& loop : patch.chart.boundary_loops) {
      if (loop.size() < patch.outer().size()) return boundary_form(loop, patch.positions, BoundaryMeasure::length);
    }
    return {};
  }
  Eigen::Index n() const { return patch.positions.rows(); }
};

double value(const QuotientForm& form, const ComplexVector& z) { return form.value_of_map(z); }

}  // namespace

TEST_SUITE_BEGIN("quotient_form");

TEST_CASE("adds to the boundary form what section 4.2 says") {
  const Fixture f;
  const ComplexVector z = random_map(f.n());
  QuotientForm form(f.outer);
  CHECK(value(form, z) == doctest::Approx(f.outer.value(z)).epsilon(1e-14));
  form.add_extender({{3}, {30}, 0.7});
  form.add_extender({{5}, {11}, -0.2});
  const double expected = f.outer.value(z) + 0.7 * f.outer.total() * std::norm(z[3] - z[30]) -
                          0.2 * f.outer.total() * std::norm(z[5] - z[11]);
  CHECK(value(form, z) == doctest::Approx(expected).epsilon(1e-13));
  form.add_spread(f.hole(), 2.5);
  CHECK(value(form, z) == doctest::Approx(expected + 2.5 * f.hole().value(z)).epsilon(1e-13));
  const PinAttraction attraction = pin_attraction({{1, {0, 0}}, {4, {3, 0.5}}, {9, {-1, 1}}}, f.outer, 3);
  form.add_attraction(attraction);
  CHECK(value(form, z) == doctest::Approx(expected + 2.5 * f.hole().value(z) - attraction.value(z)).epsilon(1e-13));
}

TEST_CASE("copies of a vertex count as their barycenter") {
  const Fixture f;
  const ComplexVector z = random_map(f.n());
  QuotientForm form(f.outer);
  form.add_extender({{2, 7, 9}, {20, 21}, 1.5});
  const Complex difference = (z[2] + z[7] + z[9]) / 3.0 - (z[20] + z[21]) / 2.0;
  CHECK(value(form, z) ==
        doctest::Approx(f.outer.value(z) + 1.5 * f.outer.total() * std::norm(difference)).epsilon(1e-13));
}

TEST_CASE("the product is that of the quadratic form, on the support, and blind to constants") {
  const Fixture f;
  QuotientForm form(f.outer);
  form.add_extender({{2, 7}, {20}, 1.5});
  form.add_extender({{31}, {20}, -4});
  form.add_spread(f.hole(), 0.5);
  const auto n = static_cast<Eigen::Index>(form.support().size());
  CHECK(std::vector<int>(form.support().begin(), form.support().begin() + f.outer.mass.size()) == f.outer.vertices);
  Eigen::MatrixXcd matrix(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    ComplexVector column;
    form.apply(ComplexVector::Unit(n, j), column);
    matrix.col(j) = column;
  }
  CHECK((matrix - matrix.adjoint()).norm() < 1e-14 * matrix.norm());
  CHECK((matrix * ComplexVector::Ones(n)).norm() < 1e-14 * matrix.norm());
  const ComplexVector z = random_map(f.n());
  const ComplexVector x = form.restrict(z);
  CHECK(x.dot(matrix * x).real() == doctest::Approx(form.value(x)).epsilon(1e-13));
  ComplexVector full = z;
  form.add_applied(z, -2, full);
  const ComplexVector image = matrix * x;
  for (std::size_t i = 0; i < form.support().size(); ++i) {
    CHECK(std::abs(full[form.support()[i]] - (z[form.support()[i]] - 2.0 * image[static_cast<Eigen::Index>(i)])) <
          1e-12);
  }
}

TEST_CASE("A is twice the signed area, on the boundary alone unless triangles are weighted") {
  const Fixture f;
  const ComplexVector z = random_map(f.n());
  for (const auto weights : {Weights::uniform, Weights::inverse_area}) {
    const ConformalEnergy energy = f.patch.energy(weights);
    const QuotientForm area = QuotientForm::area(energy);
    CHECK(value(area, z) == doctest::Approx(energy.area_form(z)).epsilon(1e-12));
    CHECK(value(area, (z.array() + Complex(1e6, 1e6)).matrix()) == doctest::Approx(energy.area_form(z)).epsilon(1e-8));
    ComplexVector image = ComplexVector::Zero(f.n());
    area.add_applied(z, 2, image);
    CHECK(z.dot(image).real() == doctest::Approx(2 * energy.area_form(z)).epsilon(1e-12));
    CHECK(std::abs(image.sum()) < 1e-12 * image.norm());
    std::size_t n_boundary = 0;
    for (const BoundaryLoop& loop : f.patch.chart.boundary_loops) n_boundary += loop.size();
    if (weights == Weights::uniform) CHECK(area.support().size() == n_boundary);
  }
}

TEST_CASE("the eigen-residual is L z - lambda B z with the quotient of Eq. 5") {
  const Patch patch(bumpy_grid(5, 4));
  const ConformalEnergy energy = patch.energy(Weights::uniform);
  const BoundaryForm form = boundary_form(patch.outer(), patch.positions, BoundaryMeasure::length);
  const ComplexVector z = random_map(energy.n_vertices());
  ComplexVector r;
  const double lambda = eigen_residual(energy, QuotientForm(form), z, r);
  CHECK(lambda == doctest::Approx(energy.value(z) / form.value(z)));
  ComplexVector expected = dense(energy.matrix()) * z;
  form.add_applied(z, -lambda, expected);
  CHECK(difference(r, expected) < 1e-13);
  CHECK(std::abs(z.dot(r)) < 1e-12 * energy.value(z));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
