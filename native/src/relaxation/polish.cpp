#include "relaxation/polish.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/tolerances.h"
#include "relaxation/line_search.h"
#include "relaxation/mean_distortion.h"

namespace spectral_conformal {

int polish(const ConformalEnergy& energy, const Lbfgs::Inverse& inverse, ComplexVector& z, const PolishOptions& options,
           const Progress& progress) {
  // Until the curvature along the first steps is known, a small decrease says little.
  constexpr int min_steps = 3;

  MeanDistortion distortion = MeanDistortion::of(energy, z);
  // With less, there is nothing visible to gain.
  if (!(distortion.anisotropy() > single_rounding) || !std::isfinite(distortion.anisotropy())) return 0;

  ComplexVector gradient;
  double value = distortion.value_and_gradient(z, gradient);
  if (!std::isfinite(value)) return 0;
  double scale = 0;  // of the inverse, chosen in the first step
  const auto scaled_inverse = [&](const ComplexVector& b, ComplexVector& x) {
    inverse(b, x);
    if (scale > 0) x *= scale;
  };
  Lbfgs lbfgs;
  ComplexVector moved(z.size());
  ComplexVector moved_gradient(z.size());
  int steps = 0;
  while (steps < options.max_steps) {
    report(progress, static_cast<double>(steps) / options.max_steps, "polish");
    const ComplexVector direction = lbfgs.descent(scaled_inverse, gradient);
    const double slope = real_dot(gradient, direction);
    if (!(slope < 0)) break;
    double length = 1;
    if (steps == 0) {
      const double second = distortion.curvature(z, direction);
      if (!(second > 0) || !std::isfinite(second)) break;
      scale = length = -slope / second;
    }
    length = fraction_of_max_step * distortion.max_step(z, direction, length / fraction_of_max_step);
    double fall = 0;
    const double least = single_rounding * length;  // without visible effect
    for (; length > least && fall == 0; length *= 0.5) {
      moved = z + length * direction;
      const double moved_value = distortion.value_and_gradient(moved, moved_gradient);
      if (!(moved_value <= value + sufficient * length * slope)) continue;
      fall = value - moved_value;
      if (steps + 1 < options.max_steps) lbfgs.add(moved - z, moved_gradient - gradient);
      z.swap(moved);
      gradient.swap(moved_gradient);
      value = moved_value;
    }
    if (!(fall > 0)) break;
    ++steps;
    if (steps >= min_steps && fall < options.tolerance * (value - 1)) break;
  }
  return steps;
}

}  // namespace spectral_conformal
