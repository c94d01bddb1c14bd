#include "relaxation/polish.h"

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "concurrency/cancellation_scope.h"
#include "geometry/tolerances.h"
#include "relaxation/line_search.h"

namespace spectral_conformal {
namespace {

/// The last map on the way from one that is allowed to one that is not, to a sixteenth of the way.
ComplexVector last_allowed(const PolishOptions& options, const ComplexVector& from, const ComplexVector& to) {
  double share = 0;
  for (double step = 0.5; step > 1.0 / 32; step *= 0.5) {
    if (options.is_allowed(from + (share + step) * (to - from))) share += step;
  }
  return from + share * (to - from);
}

/// Lowers a distortion whose infimum is `least`. Returns the number of steps.
int lower(DistortionSum& distortion, double least, const Lbfgs::Inverse& inverse, ComplexVector& z,
          const PolishOptions& options, const Progress& progress) {
  // Until the curvature along the first steps is known, a small decrease says little.
  constexpr int min_steps = 3;

  const auto function = [&](const ComplexVector& at, ComplexVector& gradient) {
    return distortion.value_and_gradient(at, gradient);
  };
  DescendingMap map{std::move(z)};
  map.energy = function(map.z, map.gradient);
  double scale = 0;  // of the inverse, chosen in the first step
  const auto scaled_inverse = [&](const ComplexVector& b, ComplexVector& x) {
    inverse(b, x);
    if (scale > 0) x *= scale;
  };
  Lbfgs lbfgs;
  int steps = 0;
  while (std::isfinite(map.energy) && steps < options.max_steps) {
    report(progress, static_cast<double>(steps) / options.max_steps, "polish");
    const ComplexVector direction = lbfgs.descent(scaled_inverse, map.gradient);
    const double slope = real_dot(map.gradient, direction);
    if (!(slope < 0)) break;
    double length = 1;
    if (steps == 0) {
      const double second = distortion.curvature(map.z, direction);
      if (!(second > 0) || !std::isfinite(second)) break;
      scale = length = -slope / second;
    }
    length = fraction_of_max_step * distortion.max_step(map.z, direction, length / fraction_of_max_step);
    const double before = map.energy;
    const ComplexVector from = options.is_allowed ? map.z : ComplexVector();
    const bool is_last = steps + 1 == options.max_steps;
    if (move_down(function, direction, slope, length, map, is_last ? nullptr : &lbfgs) == 0) break;
    const double fall = before - map.energy;
    if (!(fall > 0)) break;
    ++steps;
    if (options.is_allowed && !options.is_allowed(map.z)) {
      map.z = last_allowed(options, from, map.z);
      break;
    }
    if (steps >= min_steps && fall < options.tolerance * (map.energy - least)) break;
  }
  z = std::move(map.z);
  return steps;
}

}  // namespace

Polisher Polisher::of(const ConformalEnergy& energy, Lbfgs::Inverse inverse, const ComplexVector& z) {
  std::vector<DistortionElement> elements =
      distortion_elements(energy.triangles(), energy.energy_shapes(), energy.triangle_weights(), energy.n_virtual());
  for_each_polled(elements.size(), [&](std::size_t t) {
    if (!elements[t].barrier() || jacobian(elements[t], z).is_sliver()) elements[t].weight = 0;
  });
  return {std::move(inverse), DistortionSum::of(elements, {}, z.size())};
}

int Polisher::even_out_angles(ComplexVector& z, const PolishOptions& options, const Progress& progress) {
  // Smoothed by the anisotropy of the map. On the 92 islands of tests/benchmarks/models.py, polishing lowered mean
  // QC - 1 by 16 % and raised max QC - 1 by 31 %; with 0.3 times this smoothing, 18 % and 37 %, with twice as much,
  // 14 % and 25 %.
  const double smoothing = distortion_.anisotropy(z);
  // With less, there is nothing visible to gain.
  if (!(smoothing > single_rounding) || !std::isfinite(smoothing)) return 0;
  distortion_.set_measure({0, smoothing * smoothing});
  return lower(distortion_, 1, inverse_, z, options, progress);
}

int Polisher::even_out_sizes(ComplexVector& z, const PolishOptions& options, const Progress& progress) {
  const double scale = distortion_.mean_scale_factor(z);
  if (!(scale > 0) || !std::isfinite(scale)) return 0;
  distortion_.set_measure(DistortionMeasure::symmetric_dirichlet);
  PolishOptions scaled = options;
  if (options.is_allowed) {
    scaled.is_allowed = [&](const ComplexVector& moved) { return options.is_allowed(moved / scale); };
  }
  ComplexVector moved = z * scale;
  const int steps = lower(distortion_, distortion_.measure().infimum(), inverse_, moved, scaled, progress);
  if (steps > 0) z = moved / scale;
  return steps;
}

}  // namespace spectral_conformal
