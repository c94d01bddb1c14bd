#include "packing/cell_spans.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "geometry/tolerances.h"
#include "graph/grouped.h"

namespace spectral_conformal {
namespace {

/// The points within `radius` of a segment, a convex set. Its part in a strip of rows lies between its two sides; the
/// left side is convex, so it reaches farthest at the height of the strip nearest to that of the left end.
class Capsule {
 public:
  Capsule(Complex a, Complex b, double radius) : low_(a), high_(b), radius_(radius) {
    // The left end of a level segment counts as the lower one, and its normal points up.
    if (std::pair(b.imag(), b.real()) < std::pair(a.imag(), a.real())) std::swap(low_, high_);
    const Complex along = high_ - low_;
    const double length = std::abs(along);
    normal_ = length > 0 ? Complex(0, radius / length) * along : Complex(-radius, 0);
    slope_ = along.imag() > 0 ? along.real() / along.imag() : 0;
  }

  double bottom() const { return low_.imag() - radius_; }
  double top() const { return high_.imag() + radius_; }
  /// The least x in the strip from y = `from` to `to`, which must reach the capsule.
  double left(double from, double to) const {
    return side(nearest(low_.real() <= high_.real() ? low_ : high_, from, to), -1);
  }
  double right(double from, double to) const {
    return side(nearest(low_.real() <= high_.real() ? high_ : low_, from, to), 1);
  }

 private:
  double nearest(Complex end, double from, double to) const {
    return std::clamp(end.imag(), std::max(from, bottom()), std::min(to, top()));
  }
  /// x of the left (-1) or right (1) side at a height: on a disk about an end, or on a parallel of the segment.
  double side(double y, double sign) const {
    const Complex normal = -sign * normal_;
    const double below = low_.imag() - y;
    const double above = y - high_.imag();
    if (below >= -normal.imag()) return low_.real() + sign * half_width(below);
    if (above >= normal.imag()) return high_.real() + sign * half_width(above);
    const double x = low_.real() - (below + normal.imag()) * slope_;
    const auto [least, most] = std::minmax({low_.real(), high_.real()});
    return normal.real() + std::clamp(x, least, most);
  }
  double half_width(double away) const { return std::sqrt(std::max(0.0, radius_ * radius_ - away * away)); }

  Complex low_;
  Complex high_;
  double radius_;
  Complex normal_;  ///< to the left, as long as the radius
  double slope_;
};

int cell_at(double x) {
  // For outlines far outside any grid: a cell's sum or difference with another one is still an int.
  constexpr int farthest = std::numeric_limits<int>::max() / 2;
  return static_cast<int>(std::floor(std::clamp<double>(x, -farthest, farthest)));
}

/// Where an edge crosses the middle of a row.
struct Crossing {
  int row;
  double x;
  int winding;
};

/// Sorts by rows below n_rows, each row by `less`.
template <class Item, class Less>
void sort_by_row(std::vector<Item>& items, int n_rows, const Less& less) {
  Grouped<Item> rows(std::max(0, n_rows), [&](const auto& visit) {
    for (const Item& item : items) visit(item.row, item);
  });
  for (int row = 0; row < n_rows; ++row) std::sort(rows[row].begin(), rows[row].end(), less);
  items = rows.values();
}

}  // namespace

std::vector<CellSpan> cell_spans(const std::vector<OutlineEdge>& edges, Complex factor, Complex origin, double border,
                                 int n_rows) {
  const double radius = border + insignificant;
  std::vector<CellSpan> touched;
  std::vector<Crossing> crossings;
  touched.reserve(4 * edges.size());
  crossings.reserve(2 * edges.size());
  // Edges that follow each other touch each other's cells: their spans are one, which leaves few to sort.
  std::vector<std::size_t> last_in(static_cast<std::size_t>(std::max(0, n_rows)), 0);
  const auto touch = [&](const CellSpan& span) {
    std::size_t& last = last_in[static_cast<std::size_t>(span.row)];
    if (last < touched.size() && touched[last].row == span.row && span.begin <= touched[last].end &&
        touched[last].begin <= span.end) {
      touched[last].begin = std::min(touched[last].begin, span.begin);
      touched[last].end = std::max(touched[last].end, span.end);
      return;
    }
    last = touched.size();
    touched.push_back(span);
  };
  for (const OutlineEdge& edge : edges) {
    const Complex a = factor * edge.from + origin;
    const Complex b = factor * edge.to + origin;
    const Capsule capsule(a, b, radius);
    const int last = std::min(n_rows - 1, cell_at(capsule.top()));
    for (int row = std::max(0, cell_at(capsule.bottom())); row <= last; ++row) {
      touch({row, cell_at(capsule.left(row, row + 1.0) - insignificant),
             cell_at(capsule.right(row, row + 1.0) + insignificant) + 1});
      const double middle = row + 0.5;
      if ((a.imag() <= middle) != (b.imag() <= middle)) {
        const double x = a.real() + (middle - a.imag()) / (b.imag() - a.imag()) * (b.real() - a.real());
        crossings.push_back({row, x, a.imag() <= middle ? 1 : -1});
      }
    }
  }
  // A cell that no edge touches is entirely inside or outside, like the middle of its row.
  sort_by_row(crossings, n_rows, [](const Crossing& a, const Crossing& b) {
    return std::pair(a.x, a.winding) < std::pair(b.x, b.winding);
  });
  int winding = 0;
  for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
    winding = (i > 0 && crossings[i - 1].row != crossings[i].row ? 0 : winding) + crossings[i].winding;
    if (winding == 0 || crossings[i + 1].row != crossings[i].row) continue;
    touched.push_back({crossings[i].row, cell_at(crossings[i].x), cell_at(crossings[i + 1].x) + 1});
  }
  sort_by_row(touched, n_rows, [](const CellSpan& a, const CellSpan& b) { return a.begin < b.begin; });
  std::size_t n = 0;
  for (const CellSpan& span : touched) {
    if (n > 0 && touched[n - 1].row == span.row && span.begin <= touched[n - 1].end) {
      touched[n - 1].end = std::max(touched[n - 1].end, span.end);
    } else {
      touched[n++] = span;
    }
  }
  touched.resize(n);
  return touched;
}

}  // namespace spectral_conformal
