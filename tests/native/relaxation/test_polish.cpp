#include <doctest/doctest.h>

#include <cmath>

#include "conformal/reduced_factor.h"
#include "meshes.h"
#include "relaxation/polish.h"
#include "spectral_conformal/distortion.h"

namespace spectral_conformal::test {
namespace {

/// A patch with its conformal energy and the factor of that.
struct Polished {
  Patch patch;
  ConformalEnergy energy;
  ReducedFactor factor;
  explicit Polished(const Mesh& mesh, FactorizationBackend backend = FactorizationBackend::automatic)
      : patch(mesh),
        energy(patch.energy(Weights::uniform)),
        factor(ReducedFactor::of(energy.matrix(), std::nullopt,
                                 boundary_form(patch.outer(), patch.positions, BoundaryMeasure::length),
                                 patch.positions, 1e-12, backend, {})) {}
  Lbfgs::Inverse inverse() {
    return [this](const ComplexVector& b, ComplexVector& x) { x = factor.inverse(b); };
  }
  int polish(ComplexVector& z, const PolishOptions& options = {}) {
    return Polisher::of(energy, inverse(), z).even_out_angles(z, options);
  }
  int even_out(ComplexVector& z, const PolishOptions& options = {}) {
    return Polisher::of(energy, inverse(), z).even_out_sizes(z, options);
  }
  double spread(const ComplexVector& z) const {
    return measure_distortion(patch.positions, patch.chart.triangles, patch.chart.triangle_weights, z)
        .log2_scale_deviation;
  }
  double mean_qc(const ComplexVector& z) const {
    return measure_distortion(patch.positions, patch.chart.triangles, patch.chart.triangle_weights, z).mean_qc;
  }
};

}  // namespace

TEST_SUITE_BEGIN("polish");

TEST_CASE("the mean QC of a conformal map falls, whatever the backend, and no triangle flips") {
  for (const auto backend : backends()) {
    Polished f(bumpy_grid(14, 10), backend);
    const ComplexVector conformal = conformal_map(f.patch);
    ComplexVector z = conformal;
    CHECK(f.polish(z) > 0);
    CHECK(f.mean_qc(z) < f.mean_qc(conformal));
    CHECK(count_flipped(f.patch, z) == 0);
  }
}

TEST_CASE("more steps bring it down further, toward a minimum") {
  Polished f(bumpy_grid(14, 10));
  const ComplexVector conformal = conformal_map(f.patch);
  double last = f.mean_qc(conformal);
  const double first = last;
  double gain = 0;
  for (const int steps : {3, 10, 60}) {
    ComplexVector z = conformal;
    CHECK(f.polish(z, {steps, 0}) <= steps);
    // At its end the mean that is lowered, which is smoothed, can fall while the other rises by a trace.
    CHECK(f.mean_qc(z) < last + (steps < 60 ? 0 : 1e-3 * (first - last)));
    if (steps == 10) gain = first - f.mean_qc(z);
    last = f.mean_qc(z);
  }
  CHECK(gain > 0.8 * (first - last));
}

TEST_CASE("sizes even out, at any scale, and no triangle flips") {
  Polished f(bumpy_grid(14, 10));
  const ComplexVector conformal = conformal_map(f.patch);
  ComplexVector z = conformal;
  CHECK(f.even_out(z) > 0);
  CHECK(f.spread(z) < 0.8 * f.spread(conformal));
  CHECK(count_flipped(f.patch, z) == 0);
  ComplexVector scaled = 1048576.0 * conformal;  // without rounding
  f.even_out(scaled);
  CHECK(difference(scaled / 1048576.0, z) < 1e-10);  // the mean of logarithms is rounded
}

TEST_CASE("sizes even out after angles, on the same elements") {
  Polished f(bumpy_grid(14, 10));
  const ComplexVector conformal = conformal_map(f.patch);
  Polisher polisher = Polisher::of(f.energy, f.inverse(), conformal);
  ComplexVector z = conformal;
  CHECK(polisher.even_out_angles(z) > 0);
  const double spread = f.spread(z);
  CHECK(polisher.even_out_sizes(z, {2, 0}) > 0);
  CHECK(f.spread(z) < spread);
  CHECK(f.mean_qc(z) < f.mean_qc(conformal));
  CHECK(count_flipped(f.patch, z) == 0);
}

TEST_CASE("the steps end with the last map that is allowed") {
  Polished f(bumpy_grid(14, 10));
  const ComplexVector conformal = conformal_map(f.patch);
  ComplexVector far = conformal;
  f.even_out(far);
  const double limit = 0.5 * (f.mean_qc(conformal) + f.mean_qc(far));
  ComplexVector z = conformal;
  CHECK(f.even_out(z, {20, 0, [&](const ComplexVector& at) { return f.mean_qc(at) <= limit; }}) > 0);
  CHECK(f.mean_qc(z) <= limit);
  CHECK(f.spread(z) < f.spread(conformal));
  ComplexVector kept = conformal;
  f.even_out(kept, {20, 0, [](const ComplexVector&) { return false; }});
  CHECK(difference(kept, conformal) < 1e-12);
}

TEST_CASE("scale and place of the map do not matter") {
  Polished f(bumpy_grid(10, 8));
  const ComplexVector conformal = conformal_map(f.patch);
  ComplexVector z = conformal;
  f.polish(z);
  const Complex factor(0, 1e-6);
  ComplexVector other = (factor * conformal).array() + Complex(3e-6, 1e-6);
  f.polish(other);
  const ComplexVector back = (other.array() - Complex(3e-6, 1e-6)) / factor;
  CHECK(difference(back, z) < 1e-8);
}

TEST_CASE("a map without distortion stays as it is, to the bit") {
  Polished f(flat_grid(8, 6));
  ComplexVector z = flat_map(f.patch.positions);
  const ComplexVector before = z;
  CHECK(f.polish(z) == 0);
  CHECK(z == before);
}

TEST_CASE("flipped triangles get no more, and do not keep the others from falling") {
  Polished f(bumpy_grid(12, 9));
  ComplexVector z = conformal_map(f.patch);
  const auto& [a, b, c] = f.patch.chart.triangles[f.patch.chart.triangles.size() / 2];
  z[a] += 1.5 * (z[b] + z[c] - 2.0 * z[a]);  // through the opposite side
  const int flipped = count_flipped(f.patch, z);
  REQUIRE(flipped > 0);
  CHECK(f.polish(z) > 0);
  CHECK(count_flipped(f.patch, z) <= flipped);
  CHECK(z.allFinite());
}

TEST_CASE("vertices at which the inverse is 0 stay to the bit") {
  Polished f(bumpy_grid(14, 10));
  const ComplexVector conformal = conformal_map(f.patch);
  LinearEquations equations;
  for (const int v : f.patch.outer()) {
    equations.held.emplace_back(2 * v, conformal[v].real());
    equations.held.emplace_back(2 * v + 1, conformal[v].imag());
  }
  ReducedFactor factor = ReducedFactor::of_held(f.energy, LinearConstraints::of(equations, f.energy.n_vertices()),
                                                f.patch.positions, FactorizationBackend::automatic, {});
  ComplexVector z = conformal;
  const auto inverse = [&factor](const ComplexVector& b, ComplexVector& x) { x = factor.inverse(b); };
  CHECK(Polisher::of(f.energy, inverse, z).even_out_angles(z) > 0);
  for (const int v : f.patch.outer()) CHECK(z[v] == conformal[v]);
  CHECK(f.mean_qc(z) < f.mean_qc(conformal));
  CHECK(count_flipped(f.patch, z) == 0);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
