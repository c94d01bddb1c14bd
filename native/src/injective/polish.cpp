#include "injective/polish.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "injective/distortion_energy.h"
#include "injective/lbfgs.h"

namespace spectral_conformal {
namespace {

constexpr DistortionMeasure measure = DistortionMeasure::quasi_conformal;

/// Those that have area on the surface and, but for slivers, in the map.
std::vector<DistortionElement> with_area(std::vector<DistortionElement> elements, const ComplexVector& z) {
  const auto has_none = [&z](const DistortionElement& element) {
    const MapJacobian j = jacobian(element, z);
    return !element.barrier() || !(j.determinant > MapJacobian::min_determinant * j.half_square);
  };
  elements.erase(std::remove_if(elements.begin(), elements.end(), has_none), elements.end());
  return elements;
}

/// The second derivative of the distortion along a direction, as `stiffness` has it.
double curvature(const std::vector<DistortionElement>& elements, const ComplexVector& z, const ComplexVector& direction,
                 double smoothing) {
  double sum = 0;
  for (const DistortionElement& element : elements) {
    const DistortionStiffness s = stiffness(element, measure, jacobian(element, z), smoothing);
    const MapJacobian change = jacobian(element, direction);
    sum += element.weight *
           (s.holomorphic * std::norm(change.holomorphic) + s.antiholomorphic * std::norm(change.antiholomorphic));
  }
  return sum;
}

/// The mean of sqrt(c^2 - 1) of DistortionMeasure::quasi_conformal.
double mean_anisotropy(const std::vector<DistortionElement>& elements, const ComplexVector& z) {
  double sum = 0;
  double weight = 0;
  for (const DistortionElement& element : elements) {
    sum += element.weight * jacobian(element, z).anisotropy();
    weight += element.weight;
  }
  return weight > 0 ? sum / weight : 0;
}

}  // namespace

int polish(const ConformalEnergy& energy, Factorization& factor, ComplexVector& z, const PolishOptions& options,
           const Progress& progress) {
  constexpr double fraction_of_max_step = 0.9;  // leaves each triangle a tenth of its way to a flip
  constexpr double sufficient = 1e-4;           // Armijo's condition
  constexpr int max_halvings = 10;
  // Relative to the mean anisotropy. On the 92 islands of tests/benchmarks/models.py it took 16 % of mean QC - 1 and
  // added 31 % to max QC - 1; 0.3 took 18 % and added 37 %, 2 took 14 % and added 25 %.
  constexpr double relative_smoothing = 1;
  // Until the curvature along the first steps is known, a small fall says little.
  constexpr int min_steps = 3;
  // Below this distortion nothing can be seen or gained.
  constexpr double negligible = 1e-6;

  const std::vector<DistortionElement> all =
      distortion_elements(energy.triangles(), energy.energy_shapes(), energy.triangle_weights(), energy.n_virtual());
  const std::vector<DistortionElement> elements = with_area(all, z);
  const double anisotropy = mean_anisotropy(elements, z);
  if (!(anisotropy > negligible) || !std::isfinite(anisotropy)) return 0;
  const double smoothing = relative_smoothing * anisotropy;

  ComplexVector gradient;
  double value = energy_and_gradient(elements, measure, z, gradient, smoothing);
  if (!std::isfinite(value)) return 0;
  double scale = 0;  // of the inverse, chosen by the first step
  const auto inverse = [&](const ComplexVector& b, ComplexVector& x) {
    factor.solve(b, x);
    x.array() -= x.mean();  // the shifted energy hardly holds the constant
    if (scale > 0) x *= scale;
  };
  Lbfgs lbfgs;
  int steps = 0;
  while (steps < options.max_steps) {
    report(progress, static_cast<double>(steps) / options.max_steps, "polish");
    const ComplexVector direction = lbfgs.descent(inverse, gradient);
    const double slope = real_dot(gradient, direction);
    if (!(slope < 0)) break;
    double length = 1;
    if (steps == 0) {
      const double second = curvature(elements, z, direction, smoothing);
      if (!(second > 0) || !std::isfinite(second)) break;
      scale = length = -slope / second;
    }
    length = std::min(length, fraction_of_max_step * max_step(all, z, direction));
    double fall = 0;
    for (int k = 0; k < max_halvings && fall == 0; ++k, length *= 0.5) {
      ComplexVector moved = z + length * direction;
      ComplexVector moved_gradient;
      const double moved_value = energy_and_gradient(elements, measure, moved, moved_gradient, smoothing);
      if (!(moved_value <= value + sufficient * length * slope)) continue;
      fall = value - moved_value;
      lbfgs.add(moved - z, moved_gradient - gradient);
      z = std::move(moved);
      gradient = std::move(moved_gradient);
      value = moved_value;
    }
    if (!(fall > 0)) break;
    ++steps;
    if (steps >= min_steps && fall < options.tolerance * (value - 1)) break;
  }
  return steps;
}

}  // namespace spectral_conformal
