#include <doctest/doctest.h>

#include <algorithm>
#include <set>

#include "conformal/mixed_unknowns.h"
#include "linear_algebra/cholmod_factorization.h"
#include "meshes.h"

namespace spectral_conformal::test {
namespace {

LinearEquations straight(int first, int last) {
  LinearEquations equations;
  for (int v = first; v < last; ++v) equations.add({{2 * v + 1, 1}, {2 * v + 3, -1}});
  return equations;
}

}  // namespace

TEST_SUITE("mixed_unknowns") {
  TEST_CASE("few constrained unknowns are real and last; all are real with more, or where u and v are not coupled") {
    const Patch patch(bumpy_grid(12, 12));
    const int n = static_cast<int>(patch.positions.rows());
    const HermitianMatrix matrix = patch.energy(Weights::uniform).matrix();
    std::vector<int> border;
    for (int v = 0; v < n; ++v) {
      if (v % 13 % 12 == 0 || v / 13 % 12 == 0) border.push_back(v);
    }
    LinearEquations pairs;
    for (int v = 0; v + 1 < n; v += 2) pairs.add({{2 * v + 1, 1}, {2 * v + 3, -1}});
    for (const auto backend : backends()) {
      const auto factorization = make_factorization(backend, 1000);
      const bool orders = backend != FactorizationBackend::eigen && has_cholmod();
      const auto rows_of = [&](const LinearConstraints& constraints) {
        MixedUnknowns unknowns = mixed_unknowns(constraints, matrix, patch.positions, *factorization);
        std::set<int> parts;
        for (int k = 0; k < constraints.n_unknowns(); ++k) {
          const bool is_imaginary = unknowns.is_imaginary[k] != 0;
          CHECK((!is_imaginary || !unknowns.is_real[unknowns.row[k]]));
          parts.insert(2 * unknowns.row[k] + (is_imaginary ? 1 : 0));
        }
        CHECK(static_cast<int>(parts.size()) == constraints.n_unknowns());
        CHECK(std::is_sorted(unknowns.is_real.begin(), unknowns.is_real.end()));
        return unknowns;
      };
      const LinearConstraints few = LinearConstraints::of(straight(20, 30), n);
      const MixedUnknowns mixed = rows_of(few);
      CHECK(mixed.is_ordered == orders);
      CHECK(mixed.size() == (orders ? n + 1 : few.n_unknowns()));
      // Eleven u, and one v for all of them.
      CHECK(std::count(mixed.is_real.begin(), mixed.is_real.end(), 1) == (orders ? 12 : few.n_unknowns()));

      const LinearConstraints many = LinearConstraints::of(straight(20, n - 1), n);
      const MixedUnknowns real = rows_of(many);
      CHECK(real.is_ordered == orders);
      CHECK(real.size() == many.n_unknowns());
      // The v that many vertices share.
      const auto shared = std::find(many.coordinates().begin(), many.coordinates().end(), 2 * 20 + 1);
      REQUIRE(shared != many.coordinates().end());
      if (orders) CHECK(real.row[shared - many.coordinates().begin()] == real.size() - 1);

      LinearEquations level_border;
      for (const int v : border) {
        if (v != border.front()) level_border.add({{2 * v + 1, 1}, {2 * border.front() + 1, -1}});
      }
      const LinearConstraints uncoupled = LinearConstraints::of(level_border, n);
      const MixedUnknowns apart = rows_of(uncoupled);
      CHECK(apart.is_ordered == orders);
      CHECK(apart.size() == uncoupled.n_unknowns());

      const LinearConstraints tied = LinearConstraints::of(pairs, n);
      const MixedUnknowns plain = rows_of(tied);
      CHECK(!plain.is_ordered);
      for (int k = 0; k < tied.n_unknowns(); ++k) CHECK(plain.row[k] == k);
    }
  }

  TEST_CASE("the mixed matrix has the energy of the map") {
    const Patch patch(bumpy_grid(12, 12));
    const int n = static_cast<int>(patch.positions.rows());
    const ConformalEnergy energy = patch.energy(Weights::uniform);
    LinearEquations equations = straight(20, 30);
    equations.add({{80, 0.3}, {81, -0.7}, {90, 2.0}});
    const LinearConstraints constraints = LinearConstraints::of(equations, n);
    const Eigen::VectorXd w = random_map(constraints.n_unknowns()).real();
    const double expected = energy.value(constraints.expanded(w));
    for (const auto backend : backends()) {
      const auto factorization = make_factorization(backend, 1000);
      const MixedUnknowns unknowns = mixed_unknowns(constraints, energy.matrix(), patch.positions, *factorization);
      ComplexVector z = ComplexVector::Zero(unknowns.size());
      for (int k = 0; k < constraints.n_unknowns(); ++k) {
        z[unknowns.row[k]] += unknowns.is_imaginary[k] ? Complex(0, w[k]) : Complex(w[k]);
      }
      const HermitianMatrix matrix = mixed_matrix(energy.matrix(), constraints, unknowns);
      const ComplexVector image = matrix.selfadjointView<Eigen::Lower>() * z;
      CHECK(z.dot(image).real() == doctest::Approx(expected).epsilon(1e-12));
    }
  }
}

}  // namespace spectral_conformal::test
