#include "rebake/triangle_samples.h"

#include <cstddef>
#include <utility>

namespace spectral_conformal {

TriangleSamples TriangleSamples::of(const std::array<Complex, 3>& corners) {
  TriangleSamples samples;
  samples.corners_ = corners;
  const Complex second = corners[1] - corners[0];
  const Complex third = corners[2] - corners[0];
  const double area = second.real() * third.imag() - second.imag() * third.real();
  samples.change_ = {{{third.imag() / area, -second.imag() / area}, {-third.real() / area, second.real() / area}}};
  samples.has_area_ = true;
  for (const PlaceInTriangle& change : samples.change_) {
    samples.has_area_ = samples.has_area_ && std::isfinite(change.second) && std::isfinite(change.third);
  }
  return samples;
}

TexelWindow TriangleSamples::window(int width, int height) const {
  if (!has_area_) return {};
  const auto [left, right] = std::minmax({corners_[0].real(), corners_[1].real(), corners_[2].real()});
  const auto [low, high] = std::minmax({corners_[0].imag(), corners_[1].imag(), corners_[2].imag()});
  const auto bounded = [](double t, int n) {
    return static_cast<int>(std::min(std::max(t, 0.0), static_cast<double>(n)));
  };
  return {bounded(std::floor(left), width), bounded(std::ceil(right), width), bounded(std::floor(low), height),
          bounded(std::ceil(high), height)};
}

std::array<double, 2> TriangleSamples::span(double y) const {
  double left = infinity;
  double right = -infinity;
  for (std::size_t k = 0; k < 3; ++k) {
    // From the upper end to the lower one, so that both triangles at an edge compute the same number.
    Complex from = corners_[k];
    Complex to = corners_[(k + 1) % 3];
    if (from.imag() > to.imag()) std::swap(from, to);
    if (!(from.imag() <= y && y < to.imag())) continue;
    const double x = from.real() + (y - from.imag()) * ((to.real() - from.real()) / (to.imag() - from.imag()));
    left = std::min(left, x);
    right = std::max(right, x);
  }
  return {left, right};
}

PlaceInTriangle TriangleSamples::place(double x, double y) const {
  const double dx = x - corners_[0].real();
  const double dy = y - corners_[0].imag();
  // Rounding must not leave a needle.
  const auto inside = [](double t) { return std::min(std::max(t, 0.0), 1.0); };
  return {inside(change_[0].second * dx + change_[1].second * dy),
          inside(change_[0].third * dx + change_[1].third * dy)};
}

}  // namespace spectral_conformal
