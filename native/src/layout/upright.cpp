#include "layout/upright.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "concurrency/cancellation_scope.h"
#include "geometry/bounding_rectangles.h"
#include "geometry/signed_area.h"
#include "geometry/tolerances.h"
#include "layout/congruent_islands.h"

namespace spectral_conformal {
namespace {

constexpr Complex up(0, 1);

// In a handmade model, lengths that differ by 2 % count as equal, and directions by as many radians, about one degree.
constexpr double equal = 0.02;
// An outline is straight if a fifth of it runs along one direction within 3 degrees, as 7 % of a circle do: turned by
// an angle from there, it is longer by a fifth of it.
constexpr double straight = 0.2;
// A coordinate is weak if another grows four times as fast in the map: a roof of less than 14 degrees is seen from
// above.
constexpr double weak = 0.25;
// Radians that rounding in single precision turns the shorter edges of an outline: a hundredth of a pixel in 1000.
constexpr double unseen = 1e-5;

/// Per vertex a third of the area of its triangles in the map, scaled to sum 1.
Eigen::VectorXd masses(const ComplexVector& z, const ConformalEnergy& energy) {
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(z.size());
  const auto& triangles = energy.triangles();
  for (std::size_t t = 0; t + energy.n_virtual() < triangles.size(); ++t) {
    const auto& [a, b, c] = triangles[t];
    const double area = energy.triangle_weights()[t] * std::abs(signed_area(z[a], z[b], z[c]));
    for (const int v : {a, b, c}) mass[v] += area;
  }
  poll(triangles.size());
  return mass / mass.sum();
}

/// An outline's length in the Manhattan metric, |x| + |y|, after a turn: the shortest are those with the most edges
/// along the axes, or for a round outline those with the smallest box.
class ManhattanLength {
 public:
  static ManhattanLength of(const std::vector<OutlineEdge>& edges) {
    ManhattanLength result;
    for (const OutlineEdge& edge : edges) {
      const Complex step = edge.to - edge.from;
      if (step == 0.0) continue;
      result.steps_.push_back(in_first_quadrant(step));
      result.euclidean_ += std::abs(step);
    }
    std::sort(result.steps_.begin(), result.steps_.end(), is_before);
    for (const Complex step : result.steps_) result.sums_.push_back(result.sums_.back() + step);
    for (const Complex step : result.steps_)
      result.shortest_ = std::min(result.shortest_, result.along(step / std::abs(step)));
    return result;
  }
  /// The edges, by quarter turns in the first quadrant.
  const std::vector<Complex>& steps() const { return steps_; }
  /// The least length, which is that along one of the edges.
  double shortest() const { return shortest_; }
  double euclidean() const { return euclidean_; }
  /// The length if `direction`, of length 1, comes to lie along an axis.
  double along(Complex direction) const {
    const Complex d = in_first_quadrant(direction);
    const auto at = std::lower_bound(steps_.begin(), steps_.end(), d, is_before) - steps_.begin();
    const Complex behind = std::conj(d) * sums_[static_cast<std::size_t>(at)];
    const Complex ahead = std::conj(d) * sums_.back() - behind;
    return behind.real() - behind.imag() + ahead.real() + ahead.imag();
  }

 private:
  static bool is_before(Complex a, Complex b) { return cross(a, b) > 0; }
  static Complex in_first_quadrant(Complex z) {
    while (!(z.real() > 0 && z.imag() >= 0)) z = {-z.imag(), z.real()};
    return z;
  }

  std::vector<Complex> steps_;
  std::vector<Complex> sums_{0.0};  ///< of the first steps
  double euclidean_ = 0;
  double shortest_ = infinity;
};

/// That of the outline if it is rectilinear, otherwise that of its hull.
ManhattanLength length_of(const IslandOutline& outline) {
  ManhattanLength length = ManhattanLength::of(outline.edges);
  if (is_rectilinear(length.shortest(), length.euclidean())) return length;
  const std::vector<Complex> hull = hull_of(outline);
  std::vector<OutlineEdge> edges;
  for (std::size_t i = 0; i < hull.size(); ++i) edges.push_back({hull[i], hull[(i + 1) % hull.size()]});
  return ManhattanLength::of(edges);
}

/// Moments of the region within an outline, so that they do not depend on the inner triangulation.
struct OutlineMoments {
  /// Whether it is longer one way than another.
  bool is_oblong() const { return spread > 0 && std::abs(second) > equal * spread; }
  /// The direction in which an oblong one is longest.
  Complex long_axis() const { return std::sqrt(second / std::abs(second)); }

  Complex center;
  Complex second;     ///< the mean of w^2, with w from the center
  double spread = 0;  ///< the mean of |w|^2
};

OutlineMoments moments_of(const IslandOutline& outline) {
  OutlineMoments sum;
  double area = 0;
  for (const auto& [a, b] : outline.edges) {
    // The integrals over the triangle from the origin to the edge.
    const double triangle = cross(a, b) / 2;
    area += triangle;
    sum.center += triangle * (a + b) / 3.0;
    sum.second += triangle * (a * a + a * b + b * b) / 6.0;
    sum.spread += triangle * (std::norm(a) + dot(a, b) + std::norm(b)) / 6;
  }
  const Complex center = sum.center / area;
  return {center, sum.second / area - center * center, sum.spread / area - std::norm(center)};
}

/// Whether the reflection in the axis through the center maps the outline to itself.
bool is_mirrored(const IslandOutline& outline, const OutlineMoments& moments, Complex axis) {
  const Complex factor = axis * axis;
  return lies_on(outline, {factor, true, moments.center - factor * std::conj(moments.center)}, outline,
                 equal * std::sqrt(moments.spread));
}

/// The mirror axes of an oblong outline, along it and across.
struct MirrorAxes {
  static MirrorAxes of(const IslandOutline& outline, const OutlineMoments& moments, const ManhattanLength& length) {
    if (!moments.is_oblong()) return {};
    const Complex axis = moments.long_axis();
    // A diagonal is no axis: a square on its corner is longer by sqrt(2); the limit is halfway.
    return {is_mirrored(outline, moments, axis), is_mirrored(outline, moments, up * axis),
            length.along(axis) >= std::sqrt(std::sqrt(2)) * length.shortest()};
  }
  bool along = false;
  bool across = false;
  bool are_diagonal = false;
};

/// The gradient, u + i v, of the linear function of the map w (moved and scaled as for its moments) that best fits
/// `values`.
Complex gradient_of_fit(const ComplexVector& w, const Eigen::VectorXd& mass, const Eigen::VectorXd& values) {
  const Complex along = (w.array() * (mass.array() * values.array())).sum();
  const Complex shape = (w.array().square() * mass.array()).sum();
  // A map that degenerates to a line has no gradient across it.
  const double spread = 1 - std::norm(shape);
  return spread > 1e-12 ? 2.0 * (along - shape * std::conj(along)) / spread : along;
}

/// A turn of the map, and how much farther from upright it counts than it is, in radians, so that upright does not lead
/// away from a straight outline.
struct Turn {
  Complex factor;
  double handicap;
  double off(Complex direction) const { return std::abs(std::arg(factor * direction * std::conj(up))) + handicap; }
};

/// Keeps the turns that bring `direction` nearest to up, within a tolerance in radians.
void keep_nearest(std::vector<Turn>& turns, Complex direction, double tolerance) {
  if (turns.size() < 2) return;
  double nearest = infinity;
  for (const Turn& turn : turns) nearest = std::min(nearest, turn.off(direction));
  const auto is_farther = [&](const Turn& turn) { return turn.off(direction) > nearest + tolerance; };
  turns.erase(std::remove_if(turns.begin(), turns.end(), is_farther), turns.end());
}

/// The directions of the map that should point up, in decreasing priority.
struct Preferences {
  std::vector<Complex> directions;
  bool has_height = false;  ///< the first is the direction in which the third coordinate grows
};

Preferences preferences(const ComplexVector& w, const Eigen::VectorXd& mass,
                        const Eigen::Ref<const Positions>& positions) {
  const Eigen::RowVector3d center = mass.transpose() * positions;
  std::array<Complex, 3> gradient;
  double extent = 0;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Eigen::VectorXd values = positions.col(k).array() - center[k];
    gradient[static_cast<std::size_t>(k)] = gradient_of_fit(w, mass, values);
    extent += (mass.array() * values.array().square()).sum();
  }
  poll(w.size());
  const auto& [x, y, z] = gradient;
  const double steepest = std::max({std::abs(x), std::abs(y), std::abs(z)});
  // Positions are in single precision, and the eigenvector has about its error.
  const double least = single_rounding * std::sqrt(extent);
  Preferences result;
  const auto add = [&](Complex direction, double limit) {
    if (std::abs(direction) >= limit && std::abs(direction) > least) result.directions.push_back(direction);
  };
  // x to the right means i x up.
  add(z, weak * steepest);
  result.has_height = !result.directions.empty();
  add(y, weak * steepest);
  add(up * x, weak * steepest);
  // Any gradient distinguishes all four quarter turns, by pointing up or to the right.
  for (const Complex direction : {z, y, up * x, x, up * y, up * z}) add(direction, 0);
  return result;
}

}  // namespace

Complex upright_turn(const ComplexVector& z, const ConformalEnergy& energy, const BoundaryLoop& outer_loop,
                     const Eigen::Ref<const Positions>& positions) {
  const Eigen::VectorXd mass = masses(z, energy);
  const Complex center = (z.array() * mass.array()).sum();
  ComplexVector w = z.array() - center;
  w /= std::sqrt((w.array().abs2() * mass.array()).sum());
  IslandOutline outline;
  for (std::size_t i = 0; i < outer_loop.size(); ++i) {
    outline.edges.push_back({w[outer_loop[i]], w[outer_loop[(i + 1) % outer_loop.size()]]});
  }
  const OutlineMoments moments = moments_of(outline);
  const ManhattanLength length = length_of(outline);
  const MirrorAxes mirror = MirrorAxes::of(outline, moments, length);
  Preferences preferred = preferences(w, mass, positions);
  // Away from the broader end.
  const Complex narrow = (w.array() * w.array().abs2() * mass.array()).sum();
  if (preferred.directions.empty() && moments.is_oblong()) {
    const Complex along = moments.long_axis();
    preferred.directions.push_back(dot(along, narrow) < 0 ? -along : along);
  }
  if (std::abs(narrow) > single_rounding) preferred.directions.push_back(narrow);

  std::vector<Complex> directions = length.steps();
  if (!preferred.directions.empty()) directions.push_back(preferred.directions.front());
  // The loop is a single point.
  if (directions.empty()) return 1;
  for (Complex& direction : directions) direction /= std::abs(direction);
  std::vector<Turn> turns;
  const std::array<Complex, 4> quarters{1, up, -1, -up};
  if (mirror.along || mirror.across) {
    const Complex lying = std::conj(moments.long_axis());
    // A single axis is vertical on a floor, and at 45 degrees if it is a diagonal: as near to the one side as to the
    // other.
    if (mirror.are_diagonal && mirror.along != mirror.across) {
      for (const Complex quarter : quarters) turns.push_back({quarter * lying * std::polar(1.0, pi / 4), 0});
    }
    if (!mirror.are_diagonal && (mirror.along || (mirror.across && preferred.has_height))) {
      turns.insert(turns.end(), {{up * lying, 0}, {-up * lying, 0}});
    }
    if (!mirror.are_diagonal && (mirror.across || (mirror.along && preferred.has_height))) {
      turns.insert(turns.end(), {{lying, 0}, {-lying, 0}});
    }
  }
  if (turns.empty()) {
    for (const Complex direction : directions) {
      const double longer = length.along(direction) / length.shortest() - 1;
      if (longer > equal) continue;
      for (const Complex quarter : quarters) {
        turns.push_back({quarter * std::conj(direction), longer / straight});
      }
    }
  }
  for (const double tolerance : {equal, single_rounding}) {
    for (const Complex direction : preferred.directions) keep_nearest(turns, direction, tolerance);
  }
  // Equally near from both sides.
  const Complex first = preferred.directions.empty() ? up : preferred.directions.front();
  return std::min_element(turns.begin(), turns.end(),
                          [&](const Turn& a, const Turn& b) {
                            return std::arg(a.factor * first * std::conj(up)) <
                                   std::arg(b.factor * first * std::conj(up));
                          })
      ->factor;
}

bool is_rectilinear(const IslandOutline& outline) {
  const ManhattanLength length = ManhattanLength::of(outline.edges);
  return is_rectilinear(length.shortest(), length.euclidean());
}

Complex straight_turn(const IslandOutline& outline) {
  const ManhattanLength length = length_of(outline);
  std::vector<Complex> directions;
  const OutlineMoments moments = moments_of(outline);
  const MirrorAxes mirror = MirrorAxes::of(outline, moments, length);
  if (!mirror.are_diagonal && (mirror.along || mirror.across)) {
    directions.push_back(moments.long_axis());
  } else if (mirror.along != mirror.across) {
    directions.push_back(moments.long_axis() * std::polar(1.0, pi / 4));
  } else if (!(length.along(1) <= (1 + unseen) * length.shortest())) {
    for (const Complex step : length.steps()) {
      const Complex direction = step / std::abs(step);
      if (length.along(direction) <= (1 + single_rounding) * length.shortest()) directions.push_back(direction);
    }
  }
  Complex nearest = std::polar(1.0, pi / 4);
  for (Complex turn : directions) {
    turn = std::conj(turn);
    while (std::abs(turn.imag()) > std::abs(turn.real()) || turn.real() < 0) turn *= up;
    if (turn.real() > nearest.real()) nearest = turn;
  }
  return directions.empty() || std::abs(nearest.imag()) <= unseen ? 1 : nearest;
}

}  // namespace spectral_conformal
