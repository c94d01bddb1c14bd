#include <doctest/doctest.h>

#include <algorithm>

#include "conformal/affine_space.h"
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

TEST_SUITE("affine_space") {
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
      const auto space_of = [&](const LinearEquations& equations) {
        AffineSpace space =
            AffineSpace::of(LinearConstraints::of(equations, n), matrix, patch.positions, *factorization);
        CHECK(std::is_sorted(space.is_real().begin(), space.is_real().end()));
        // Parts of complex unknowns, and real ones.
        const auto n_real = std::count(space.is_real().begin(), space.is_real().end(), 1);
        CHECK(2 * space.size() - n_real == space.constraints().n_unknowns());
        return space;
      };
      const AffineSpace mixed = space_of(straight(20, 30));
      CHECK(mixed.is_ordered() == orders);
      CHECK_FALSE(mixed.is_complex());
      // Eleven u, and one v for all of them.
      const auto n_real = std::count(mixed.is_real().begin(), mixed.is_real().end(), 1);
      CHECK(n_real == (orders ? 12 : mixed.constraints().n_unknowns()));

      const AffineSpace real = space_of(straight(20, n - 1));
      CHECK(real.is_ordered() == orders);
      CHECK(real.size() == real.constraints().n_unknowns());
      // The v that many vertices share.
      ComplexVector shared = ComplexVector::Zero(real.size());
      shared[real.size() - 1] = 1;
      if (orders) CHECK(real.expanded(shared)[n - 1] == Complex(0, 1));

      LinearEquations level_border;
      for (const int v : border) {
        if (v != border.front()) level_border.add({{2 * v + 1, 1}, {2 * border.front() + 1, -1}});
      }
      const AffineSpace uncoupled = space_of(level_border);
      CHECK(uncoupled.is_ordered() == orders);
      CHECK(uncoupled.size() == uncoupled.constraints().n_unknowns());

      const AffineSpace tied = space_of(pairs);
      CHECK(!tied.is_ordered());
      CHECK(tied.size() == tied.constraints().n_unknowns());

      LinearEquations pinned;
      pinned.held = {{6, 1.0}, {7, 2.0}, {80, -1.0}, {81, 0.0}};
      const AffineSpace held = space_of(pinned);
      CHECK((held.is_complex() && held.size() == n - 2 && held.translations().empty()));
      CHECK((held.offset()[3] == Complex(1, 2) && held.offset()[40] == Complex(-1, 0)));
    }
  }

  TEST_CASE("P w is the map of the equations, P^* its adjoint, and P^* L P has the energy of the map") {
    const Patch patch(bumpy_grid(12, 12));
    const int n = static_cast<int>(patch.positions.rows());
    const ConformalEnergy energy = patch.energy(Weights::uniform);
    const BoundaryForm form = boundary_form(patch.outer(), patch.positions, BoundaryMeasure::length);
    LinearEquations slanted = straight(20, 30);
    slanted.add({{80, 0.3}, {81, -0.7}, {90, 2.0}});
    LinearEquations pinned;
    pinned.held = {{6, 1.0}, {7, 2.0}, {80, -1.0}, {81, 0.0}};
    for (const auto backend : backends()) {
      const auto factorization = make_factorization(backend, 1000);
      for (const LinearEquations& equations : {slanted, pinned}) {
        const AffineSpace space =
            AffineSpace::of(LinearConstraints::of(equations, n), energy.matrix(), patch.positions, *factorization);
        ComplexVector w = random_map(space.size());
        for (int k = 0; k < space.size(); ++k) w[k] = space.is_real()[k] ? w[k].real() : w[k];
        const ComplexVector x = space.expanded(w);
        for (int v = 20; equations.held.empty() && v < 30; ++v) CHECK(x[v].imag() == x[30].imag());
        const ComplexVector z = random_map(n, 1);
        CHECK(space.gathered(z).dot(w).real() == doctest::Approx(z.dot(x).real()));
        const ComplexVector image = space.reduced(energy.matrix()).selfadjointView<Eigen::Lower>() * w;
        CHECK(w.dot(image).real() == doctest::Approx(energy.value(x)).epsilon(1e-12));
        for (const ComplexVector& along : space.translations()) {
          CHECK((space.expanded(along).array() - space.expanded(along)[0]).abs().maxCoeff() == 0);
          ComplexVector rest = w + 3 * along;
          space.remove_translations(rest);
          CHECK(std::abs(along.dot(rest).real()) < 1e-12 * along.norm() * w.norm());
        }
        // Some vertices alone.
        std::vector<int> unknowns;
        const AffineSpace part = space.restricted(form.vertices, unknowns);
        CHECK((part.expanded(w(unknowns)) - x(form.vertices)).norm() == 0);
      }
    }
  }
}

}  // namespace spectral_conformal::test
