#include "relaxation/sliding_border.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "geometry/signed_area.h"

namespace spectral_conformal {
namespace {

/// In radians. Positions in single precision turn straight lines by less, unless edges are shorter than 1e-4.
constexpr double straight_turn = 2e-3;
/// 35 degrees, between a polygon of ten sides and one of eleven: a circle of twelve is a curve, an octagon has corners.
constexpr double corner_turn = 0.61;

std::size_t before(std::size_t i, std::size_t n) { return i > 0 ? i - 1 : n - 1; }

/// The edges of a loop, each from a vertex to the next.
std::vector<Complex> sides_of(const BoundaryLoop& loop, const ComplexVector& z) {
  std::vector<Complex> sides;
  for (std::size_t i = 0; i < loop.size(); ++i) sides.push_back(z[loop[(i + 1) % loop.size()]] - z[loop[i]]);
  return sides;
}

Complex unit(Complex side) { return side == 0.0 ? side : side / std::abs(side); }

}  // namespace

std::vector<BorderTurn> border_turns(const std::vector<BoundaryLoop>& loops, const ComplexVector& z) {
  std::vector<BorderTurn> result(static_cast<std::size_t>(z.size()), BorderTurn::none);
  for (const BoundaryLoop& loop : loops) {
    const std::size_t n = loop.size();
    const std::vector<Complex> sides = sides_of(loop, z);
    std::vector<double> turn;
    for (std::size_t i = 0; i < n; ++i) {
      const Complex in = sides[before(i, n)];
      turn.push_back(in == 0.0 || sides[i] == 0.0 ? corner_turn : std::abs(std::arg(sides[i] * std::conj(in))));
    }
    for (std::size_t i = 0; i < n; ++i) {
      const bool between_straight = turn[before(i, n)] <= straight_turn && turn[(i + 1) % n] <= straight_turn;
      const bool is_corner = turn[i] >= corner_turn || (between_straight && turn[i] > 5 * straight_turn);
      BorderTurn& at = result[static_cast<std::size_t>(loop[i])];
      if (is_corner || at != BorderTurn::none) {
        at = BorderTurn::corner;
      } else {
        at = turn[i] <= straight_turn ? BorderTurn::straight : BorderTurn::curved;
      }
    }
  }
  return result;
}

SlidingBorder SlidingBorder::along(const std::vector<BoundaryLoop>& loops, const ComplexVector& z,
                                   const std::vector<char>& slides) {
  const std::vector<BorderTurn> turns = border_turns(loops, z);
  const auto turn_at = [&](int v) { return turns[static_cast<std::size_t>(v)]; };
  SlidingBorder result;
  for (const BoundaryLoop& loop : loops) {
    if (std::none_of(loop.begin(), loop.end(), [&](int v) { return slides[v] != 0; })) continue;
    const std::size_t n = loop.size();
    const std::vector<Complex> sides = sides_of(loop, z);
    std::vector<Complex> tangents;
    for (std::size_t i = 0; i < n; ++i) {
      const Complex in = sides[before(i, n)];
      // Straight parts end straight; elsewhere the chord of both neighbors.
      const bool in_is_straight = turn_at(loop[before(i, n)]) == BorderTurn::straight;
      const bool out_is_straight = turn_at(loop[(i + 1) % n]) == BorderTurn::straight;
      const bool is_end = turn_at(loop[i]) == BorderTurn::curved && in_is_straight != out_is_straight;
      tangents.push_back(unit(!is_end ? in + sides[i] : in_is_straight ? in : sides[i]));
    }
    Curve curve;
    double s = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const int to = loop[(i + 1) % n];
      const Complex along = unit(sides[i]);
      const auto mirrored = [&](Complex tangent) { return along * along * std::conj(tangent); };
      const bool leaves_corner = turn_at(loop[i]) == BorderTurn::corner;
      const bool ends_at_corner = turn_at(to) == BorderTurn::corner;
      Edge edge{z[loop[i]], z[to], tangents[i], tangents[(i + 1) % n]};
      if (leaves_corner) edge.leaving = ends_at_corner ? along : mirrored(edge.arriving);
      if (ends_at_corner) edge.arriving = leaves_corner ? along : mirrored(edge.leaving);
      if (slides[loop[i]]) result.sliders_.push_back({loop[i], static_cast<int>(result.curves_.size()), s});
      curve.edges.push_back(edge);
      curve.at.push_back(s);
      s += std::abs(sides[i]);
    }
    curve.at.push_back(s);
    result.curves_.push_back(std::move(curve));
  }
  return result;
}

SlidingBorder::Place SlidingBorder::place(const Slider& slider, const ComplexVector& x) const {
  const auto& [edges, at] = curves_[static_cast<std::size_t>(slider.curve)];
  double s = x[slider.vertex].real();
  s -= at.back() * std::floor(s / at.back());
  // The last edge also for an s that rounding puts at its end.
  const auto next = std::upper_bound(at.begin() + 1, at.end() - 1, s);
  const auto k = static_cast<std::size_t>(next - at.begin()) - 1;
  const double length = at[k + 1] - at[k];
  return {edges[k], length, (s - at[k]) / length};
}

Complex SlidingBorder::tangent(const Slider& slider, const ComplexVector& x) const {
  const auto& [edge, length, t] = place(slider, x);
  return 6 * t * (1 - t) / length * (edge.to - edge.from) + (1 - t) * (1 - 3 * t) * edge.leaving +
         t * (3 * t - 2) * edge.arriving;
}

ComplexVector SlidingBorder::coordinates(ComplexVector z) const {
  for (const Slider& slider : sliders_) z[slider.vertex] = slider.start;
  return z;
}

ComplexVector SlidingBorder::map_at(ComplexVector x) const {
  for (const Slider& slider : sliders_) {
    const auto& [edge, length, t] = place(slider, x);
    // So that a coordinate that all have stays exactly.
    x[slider.vertex] = edge.from + t * t * (3 - 2 * t) * (edge.to - edge.from) +
                       length * t * (1 - t) * ((1 - t) * edge.leaving - t * edge.arriving);
  }
  return x;
}

void SlidingBorder::push_forward(const ComplexVector& x, ComplexVector& displacement) const {
  for (const Slider& slider : sliders_) {
    displacement[slider.vertex] = displacement[slider.vertex].real() * tangent(slider, x);
  }
}

void SlidingBorder::pull_back(const ComplexVector& x, ComplexVector& gradient) const {
  for (const Slider& slider : sliders_) {
    gradient[slider.vertex] = dot(tangent(slider, x), gradient[slider.vertex]);
  }
}

}  // namespace spectral_conformal
