#include "layout/upright.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "concurrency/listening.h"
#include "geometry/bounding_rectangles.h"
#include "geometry/signed_area.h"
#include "geometry/tolerances.h"

namespace spectral_conformal {
namespace {

constexpr Complex up(0, 1);

// Rectangles within 1 % of the smallest count as equally small: the sides of a square then lean by at most 0.3 degrees.
constexpr double equal_area = 0.01;
// A coordinate is weak if another grows four times as fast in the map: a roof of less than 14 degrees is seen from
// above.
constexpr double weak = 0.25;
// Gradients below this fraction of the steepest possible are rounding: positions are in single precision, 6e-8, and the
// eigenvector's error is about as large.
constexpr double no_gradient = 1e-4;
// In radians, about one degree: directions that count as the same in a handmade model.
constexpr double same_direction = 0.02;
// Odd moments of a mirror-symmetric shape vanish: 1e-16 on Blender's monkey, 1e-5 on an asymmetrically triangulated
// rectangle, but 9e-4 on a 2 by 1 rectangle without a corner of legs 0.02.
constexpr double odd_moment = 3e-4;
// An outline is straight if this fraction of it runs along its smallest rectangle within 3 degrees: 7 % for a circle,
// half for a regular octagon; no regular outline is near the limit.
constexpr double straight_fraction = 0.18;
// The sine of slightly less than 3 degrees, since regular outlines have edges at 3 degrees.
constexpr double straight_sine = 0.0523;
// For a regular octagon this fraction is half, along two of its sides and across.
constexpr double main_fraction = 0.55;
// An axis is a diagonal if the outline's fourfold mean (fourfold_mean) falls below this: its sides then lean by at most
// 11 degrees from diagonal, half as much as those of a regular octagon, which has no diagonals.
constexpr double clear_diagonal = -0.7;
// For an outline that is not straight: the allowed relative growth of its box for being exactly upright.
constexpr double larger_box = 0.1;

/// Per vertex a third of the area of its triangles in the map, scaled to sum 1.
Eigen::VectorXd masses(const ComplexVector& z, const ConformalEnergy& energy) {
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(z.size());
  const auto& triangles = energy.triangles();
  for (std::size_t t = 0; t + energy.n_virtual() < triangles.size(); ++t) {
    const auto& [a, b, c] = triangles[t];
    const double area = energy.triangle_weights()[t] * std::abs(signed_area(z[a], z[b], z[c]));
    for (const int v : {a, b, c}) mass[v] += area;
  }
  still_working(25 * static_cast<double>(triangles.size()));
  return mass / mass.sum();
}

/// The moments c(p, q) = E[w^p conj(w)^q] with p > q and 2 <= p + q <= 5 of the region enclosed by an outline, moved
/// and scaled to E[w] = 0 and E[|w|^2] = 1, each divided by a bound of E[|w|^(p + q)]. A mirror image has the conjugate
/// moments; a turn by t multiplies by exp(i (p - q) t).
struct Moment {
  int harmonic = 0;  ///< p - q
  Complex value;
};

/// The largest p + q of the sums.
constexpr int max_order = 6;

/// The integrals of w^p conj(w)^q, p >= q, over the region to the left of an outline, as sums over the triangles
/// between the center, the origin of w, and the edges. In a triangle w is s times a point of the edge, 0 <= s <= 1, so
/// its integral is the mean of w^p conj(w)^q along the edge times cross(start, end) / (p + q + 2). The Gauss rule is
/// exact for this mean.
class RegionIntegrals {
 public:
  RegionIntegrals(const std::vector<Complex>& outline, Complex center) {
    // Exact up to degree 7.
    constexpr std::array<double, 4> nodes{0.06943184420297371, 0.33000947820757187, 0.6699905217924281,
                                          0.9305681557970263};
    constexpr std::array<double, 4> weights{0.17392742256872692, 0.32607257743127307, 0.32607257743127307,
                                            0.17392742256872692};
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Complex start = outline[i] - center;
      const Complex end = outline[(i + 1) % outline.size()] - center;
      const double weight = cross(start, end);
      for (std::size_t k = 0; k < nodes.size(); ++k) {
        const Complex w = start + nodes[k] * (end - start);
        const double square = std::norm(w);
        Complex power = weights[k] * weight;
        for (std::size_t harmonic = 0; harmonic < max_order; ++harmonic, power *= w) {
          Complex term = power;
          for (std::size_t q = 0; harmonic + 2 * q <= max_order; ++q, term *= square) sums_[harmonic][q] += term;
        }
      }
    }
  }
  Complex operator()(int p, int q) const {
    return sums_[static_cast<std::size_t>(p - q)][static_cast<std::size_t>(q)] / (p + q + 2.0);
  }

 private:
  std::array<std::array<Complex, max_order / 2 + 1>, max_order> sums_{};
};

/// The area of the region within an outline, and its first moment.
std::pair<double, Complex> area_and_moment(const std::vector<Complex>& outline) {
  double area = 0;
  Complex moment = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Complex start = outline[i];
    const Complex end = outline[(i + 1) % outline.size()];
    area += cross(start, end) / 2;
    moment += cross(start, end) / 6 * (start + end);
  }
  return {area, moment};
}

/// The moments of the region within a counterclockwise outline, so that they do not depend on the inner triangulation.
/// Empty if the outline encloses as much area clockwise.
std::vector<Moment> moments_of(const std::vector<Complex>& outline) {
  const auto [area, moment] = area_and_moment(outline);
  if (!(area > 0)) return {};
  const RegionIntegrals integrals(outline, moment / area);
  // E[|w|^n]; for odd n a bound from the neighboring even ones.
  std::array<double, max_order + 1> size{};
  for (int n = 2; n <= max_order; n += 2) {
    size[static_cast<std::size_t>(n)] = integrals(n / 2, n / 2).real() / area;
    if (!(size[static_cast<std::size_t>(n)] > 0)) return {};
  }
  for (std::size_t n = 3; n < max_order; n += 2) size[n] = std::sqrt(size[n - 1] * size[n + 1]);
  std::vector<Moment> moments;
  for (int n = 2; n < max_order; ++n) {
    for (int q = (n - 1) / 2; q >= 0; --q) {
      const int p = n - q;
      moments.push_back({p - q, integrals(p, q) / area / size[static_cast<std::size_t>(n)]});
    }
  }
  return moments;
}

/// Whether a moment locates an axis: an odd_moment turns it by less than half of same_direction, so that two that
/// locate the same axis agree.
bool is_clear(const Moment& moment) { return 0.5 * same_direction * std::abs(moment.value) >= odd_moment; }

/// The directions of the mirror axes of a map with these moments.
std::vector<Complex> mirror_axes(const std::vector<Moment>& moments) {
  std::vector<Complex> axes;
  for (const Moment& clear : moments) {
    if (!is_clear(clear)) continue;
    for (int k = 0; k < clear.harmonic; ++k) {
      const Complex axis = std::polar(1.0, (std::arg(clear.value) + k * pi) / clear.harmonic);
      // conj(axis)^harmonic; std::pow would compute a logarithm for each.
      std::array<Complex, 6> power{1};
      for (std::size_t n = 1; n < power.size(); ++n) power[n] = power[n - 1] * std::conj(axis);
      const auto is_odd = [&](const Moment& m) {
        return std::abs(std::imag(m.value * power[static_cast<std::size_t>(m.harmonic)])) > odd_moment;
      };
      const auto is_same = [&](Complex other) { return std::abs(cross(axis, other)) < same_direction; };
      if (std::any_of(moments.begin(), moments.end(), is_odd)) continue;
      if (std::none_of(axes.begin(), axes.end(), is_same)) axes.push_back(axis);
    }
  }
  return axes;
}

/// The gradient, u + i v, of the linear function of the map w (moved and scaled as for its moments) that best fits
/// `values`.
Complex gradient_of_fit(const ComplexVector& w, const Eigen::VectorXd& mass, const Eigen::VectorXd& values) {
  const Complex along = (w.array() * (mass.array() * values.array())).sum();
  const Complex shape = (w.array().square() * mass.array()).sum();
  // A map that degenerates to a line has no gradient across it.
  const double spread = 1 - std::norm(shape);
  return spread > 1e-12 ? 2.0 * (along - shape * std::conj(along)) / spread : along;
}

double area_of(const Rectangle& r) { return r.width * r.height; }

/// The length of an outline along a direction, for many queries: a round outline has as many directions as edges.
class OutlineDirections {
 public:
  /// Of a closed polygon.
  explicit OutlineDirections(const std::vector<Complex>& outline) {
    std::vector<std::pair<double, double>> edges;
    edges.reserve(outline.size());
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Complex edge = outline[(i + 1) % outline.size()] - outline[i];
      if (edge != 0.0) edges.emplace_back(side(edge), std::abs(edge));
    }
    std::sort(edges.begin(), edges.end());
    sides_.reserve(edges.size());
    lengths_.reserve(edges.size() + 1);
    for (const auto& [line, length] : edges) {
      sides_.push_back(line);
      lengths_.push_back(lengths_.back() + length);
    }
  }
  /// Whether enough of the outline runs along the sides of the rectangle to make a tilt visible.
  bool is_straight(const Rectangle& rectangle) const {
    return length_along(rectangle.direction) >= straight_fraction * lengths_.back();
  }
  /// The main direction: more of the outline clearly runs along and across it than in all others together, as for a
  /// cross or a letter L. The one with the most, if there are several; empty for most outlines.
  std::optional<Complex> main_direction() const {
    double most = 0;
    Complex main = 0;
    for (const double line : sides_) {
      const Complex direction(1 - line, line);
      const double length = length_along(direction);
      if (length <= most) continue;
      most = length;
      main = direction;
    }
    if (most < main_fraction * lengths_.back()) return std::nullopt;
    return main / std::abs(main);
  }

 private:
  /// Maps a line modulo a quarter turn to 0 to 1, monotonic in its angle; the angle itself would take an arctangent per
  /// edge.
  static double side(Complex line) {
    double x = line.real();
    double y = line.imag();
    if (y < 0 || (y == 0 && x < 0)) std::tie(x, y) = std::pair(-x, -y);
    if (x <= 0) std::tie(x, y) = std::pair(y, -x);
    return y / (x + y);
  }
  /// The length of the edges within 3 degrees of a direction or across it.
  double length_along(Complex direction) const {
    const Complex turn(std::sqrt(1 - straight_sine * straight_sine), straight_sine);
    const double first = side(direction * std::conj(turn));
    const double last = side(direction * turn);
    // Edges beyond one end of the quarter turn are at the other end.
    return first <= last ? length_between(first, last) : length_between(first, 1) + length_between(0, last);
  }
  double length_between(double first, double last) const {
    const auto begin = std::lower_bound(sides_.begin(), sides_.end(), first);
    const auto end = std::upper_bound(begin, sides_.end(), last);
    return lengths_[static_cast<std::size_t>(end - sides_.begin())] -
           lengths_[static_cast<std::size_t>(begin - sides_.begin())];
  }

  std::vector<double> sides_;         ///< of the edges, ascending
  std::vector<double> lengths_{0.0};  ///< prefix sums over the edges
};

/// Whether clearly more of an outline runs along and across a direction than in all others together.
bool is_main_direction(const std::vector<Complex>& outline, Complex direction) {
  double along = 0;
  double all = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Complex edge = outline[(i + 1) % outline.size()] - outline[i];
    const double length = std::abs(edge);
    const double off = std::min(std::abs(dot(direction, edge)), std::abs(cross(direction, edge)));
    all += length;
    if (off <= straight_sine * length) along += length;
  }
  return along >= main_fraction * all;
}

/// The mean of cos 4t over a closed polygon, with the angle t between each edge and a direction: 1 if all edges run
/// along or across it, -1 if all run diagonally, as those of a square along its diagonal; 0 for a circle.
double fourfold_mean(const std::vector<Complex>& outline, Complex direction) {
  double sum = 0;
  double all = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Complex edge = (outline[(i + 1) % outline.size()] - outline[i]) * std::conj(direction);
    const double length = std::abs(edge);
    if (length == 0) continue;
    const Complex square = edge * edge / (length * length);
    sum += length * (square * square).real();
    all += length;
  }
  return all > 0 ? sum / all : 0;
}

double deviation(Complex turned) { return std::abs(std::arg(turned * std::conj(up))); }

/// Keeps the turns that bring `direction` nearest to up, within a tolerance in radians.
void keep_nearest(std::vector<Complex>& turns, Complex direction, double tolerance) {
  if (turns.size() < 2) return;
  double nearest = infinity;
  for (const Complex turn : turns) nearest = std::min(nearest, deviation(turn * direction));
  const auto is_farther = [&](Complex turn) { return deviation(turn * direction) > nearest + tolerance; };
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
  still_working(100 * static_cast<double>(w.size()));
  const auto& [x, y, z] = gradient;
  const double steepest = std::max({std::abs(x), std::abs(y), std::abs(z)});
  const double least = no_gradient * std::sqrt(extent);
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
  std::vector<Complex> boundary;
  boundary.reserve(outer_loop.size());
  for (const int vertex : outer_loop) boundary.push_back(w[vertex]);
  const std::vector<Complex> hull = convex_hull(boundary);
  const std::vector<Moment> moments = moments_of(boundary);
  Preferences preferred = preferences(w, mass, positions);

  // If most of the outline runs along and across one direction, as for a cross, that direction is upright, not an axis
  // in between.
  std::vector<Complex> axes = mirror_axes(moments);
  // A bent square with split quads has only one or two axes: its diagonals.
  const auto is_diagonal = [&](Complex axis) { return fourfold_mean(boundary, axis) < clear_diagonal; };
  std::optional<Complex> across_diagonals;
  if (!axes.empty() && std::all_of(axes.begin(), axes.end(), is_diagonal)) {
    across_diagonals = axes.front() * std::polar(1.0, pi / 4);
    axes = {*across_diagonals};
  }
  const auto likely = std::find_if(axes.begin(), axes.end(),
                                   [&](Complex a) { return across_diagonals || is_main_direction(boundary, a); });
  std::optional<OutlineDirections> outline;
  std::optional<Complex> main_direction;
  if (likely == axes.end()) {
    outline.emplace(boundary);
    main_direction = outline->main_direction();
  } else {
    main_direction = *likely;
  }
  const auto is_between = [&](Complex direction) {
    const Complex turn = main_direction ? direction / *main_direction : 1;
    return std::min(std::abs(turn.real()), std::abs(turn.imag())) > straight_sine;
  };
  axes.erase(std::remove_if(axes.begin(), axes.end(), is_between), axes.end());
  std::vector<Rectangle> rectangles;
  if (axes.empty()) {
    rectangles = smallest_rectangles(hull, equal_area);
    const auto lies_between = [&](const Rectangle& r) { return is_between(r.direction); };
    const auto straight = [&](const Rectangle& r) { return outline->is_straight(r); };
    rectangles.erase(std::remove_if(rectangles.begin(), rectangles.end(), lies_between), rectangles.end());
    if (rectangles.empty()) {
      rectangles = {bounding_rectangle(hull, *main_direction)};
    } else if (!preferred.directions.empty() && std::none_of(rectangles.begin(), rectangles.end(), straight)) {
      const Complex highest = preferred.directions.front();
      const Rectangle exact = bounding_rectangle(hull, highest / std::abs(highest));
      const auto is_smaller = [](const Rectangle& a, const Rectangle& b) { return area_of(a) < area_of(b); };
      const Rectangle& smallest = *std::min_element(rectangles.begin(), rectangles.end(), is_smaller);
      if (area_of(exact) <= area_of(smallest) * (1 + larger_box)) rectangles = {exact};
    }
  } else {
    double smallest = infinity;
    for (const Complex axis : axes) {
      rectangles.push_back(bounding_rectangle(hull, axis));
      smallest = std::min(smallest, area_of(rectangles.back()));
    }
    const auto is_larger = [&](const Rectangle& r) { return area_of(r) > smallest * (1 + equal_area); };
    rectangles.erase(std::remove_if(rectangles.begin(), rectangles.end(), is_larger), rectangles.end());
  }
  const bool stands_on_axis = axes.size() == 1 && !across_diagonals && !preferred.has_height;

  std::vector<Complex> turns;
  for (const Rectangle& rectangle : rectangles) {
    const Complex lying = std::conj(rectangle.direction);
    const bool higher = rectangle.height > rectangle.width * (1 + equal_area);
    const bool wider = rectangle.width > rectangle.height * (1 + equal_area);
    // If nothing else distinguishes them, prefer higher than wide.
    const bool may_lie = !stands_on_axis && (!preferred.directions.empty() || !wider);
    const bool may_stand = stands_on_axis || !preferred.directions.empty() || !higher;
    if (may_lie) turns.insert(turns.end(), {lying, -lying});
    if (may_stand) turns.insert(turns.end(), {up * lying, -up * lying});
  }
  // Third moments point away from the broader end.
  for (const Moment& m : moments) {
    if (m.harmonic == 1 && is_clear(m)) preferred.directions.push_back(m.value);
  }
  for (const double tolerance : {same_direction, single_rounding}) {
    for (const Complex direction : preferred.directions) keep_nearest(turns, direction, tolerance);
  }
  return turns.front();
}

}  // namespace spectral_conformal
