#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Texels [x_begin, x_end) of the rows [y_begin, y_end).
struct TexelWindow {
  int x_begin = 0;
  int x_end = 0;
  int y_begin = 0;
  int y_end = 0;
};

/// A place of a triangle: its second and third barycentric coordinates.
struct PlaceInTriangle {
  double second = 0;
  double third = 0;
  /// The value there of what is linear on the triangle.
  template <class Value>
  Value between(const Value& a, const Value& b, const Value& c) const {
    return a + (b - a) * second + (c - a) * third;
  }
};

/// The samples that a triangle gets in an image: each of its texels is divided into rates[0] times rates[1] equal
/// cells, and the triangle has the samples at the centers of cells that lie in it. Of triangles with the same rates,
/// each center within their union belongs to exactly one, even on their common edges.
class TriangleSamples {
 public:
  static constexpr int max_rate = 32;  ///< 1,024 samples of a texel give its mean, however large its footprint

  /// corners: in texels; row y has its centers at y + 1/2. Without samples if the triangle has no area.
  static TriangleSamples of(const std::array<Complex, 3>& corners);

  bool has_area() const { return has_area_; }
  /// The change of the place per texel along x (0) or y (1).
  const PlaceInTriangle& change(int axis) const { return change_[static_cast<std::size_t>(axis)]; }
  /// The least number of samples along an axis whose neighbors are at most 1 apart: length is that of a texel there, in
  /// the units of the source. A sixteenth more is ignored, since rounded UVs of small triangles vary that much.
  static int rate_for(double length) {
    const double rate = std::ceil(length - 0.0625);
    // NaN gives 1.
    return rate > 1 ? static_cast<int>(std::min<double>(rate, max_rate)) : 1;
  }
  void set_rates(int along_x, int along_y) { rates_ = {along_x, along_y}; }
  /// Of a texel, the part that a sample stands for.
  double weight() const { return 1.0 / (rates_[0] * rates_[1]); }
  /// The place of a point, in texels; of one outside, that of a point of the triangle.
  PlaceInTriangle place(double x, double y) const;
  /// The window of the whole triangle within an image of this size.
  TexelWindow window(int width, int height) const;

  /// Calls visit(x, y, place) for the samples in a window, row by row; x and y are the texel.
  template <class Visit>
  void for_each(const TexelWindow& window, const Visit& visit) const {
    if (!has_area_) return;
    const auto [low, high] = std::minmax({corners_[0].imag(), corners_[1].imag(), corners_[2].imag()});
    const int y_end = first_from(high, 1, window.y_begin, window.y_end);
    for (int row = first_from(low, 1, window.y_begin, window.y_end); row < y_end; ++row) {
      const double y = (row + 0.5) / rates_[1];
      const auto [left, right] = span(y);
      const int x_end = first_from(right, 0, window.x_begin, window.x_end);
      for (int column = first_from(left, 0, window.x_begin, window.x_end); column < x_end; ++column) {
        visit(column / rates_[0], row / rates_[1], place((column + 0.5) / rates_[0], y));
      }
    }
  }

 private:
  TriangleSamples() = default;
  /// The first cell in texels [begin, end) whose center is at t or beyond; the end of the cells for none.
  int first_from(double t, int axis, int begin, int end) const {
    const int rate = rates_[static_cast<std::size_t>(axis)];
    const double first = std::ceil(t * rate - 0.5);
    return static_cast<int>(
        std::min(std::max(first, static_cast<double>(begin) * rate), static_cast<double>(end) * rate));
  }
  /// The part of a row within the triangle; empty if there is none.
  std::array<double, 2> span(double y) const;

  std::array<Complex, 3> corners_;
  std::array<PlaceInTriangle, 2> change_;
  std::array<int, 2> rates_{1, 1};
  bool has_area_ = false;
};

}  // namespace spectral_conformal
