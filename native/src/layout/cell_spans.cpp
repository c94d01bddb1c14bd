#include "layout/cell_spans.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>

namespace spectral_conformal {
namespace {

/// In cells: more than the rounding of coordinates up to 1e5, less than anyone sees.
constexpr double rounding = 1e-9;

struct Interval {
  double low = infinity;
  double high = -infinity;
  void add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
};

/// Adds the part of the segment a b that lies in the strip bottom <= y <= top.
void add_segment(Interval& interval, Complex a, Complex b, double bottom, double top) {
  const double rise = b.imag() - a.imag();
  if (rise == 0) {
    if (a.imag() < bottom || a.imag() > top) return;
    interval.add(a.real());
    interval.add(b.real());
    return;
  }
  double begin = (bottom - a.imag()) / rise;
  double end = (top - a.imag()) / rise;
  if (begin > end) std::swap(begin, end);
  begin = std::max(begin, 0.0);
  end = std::min(end, 1.0);
  if (begin > end) return;
  interval.add(a.real() + begin * (b.real() - a.real()));
  interval.add(a.real() + end * (b.real() - a.real()));
}

/// Adds the part of the disk about c that lies in the strip.
void add_disk(Interval& interval, Complex c, double radius, double bottom, double top) {
  const double away = std::max({0.0, bottom - c.imag(), c.imag() - top});
  if (away > radius) return;
  const double half = std::sqrt(std::max(0.0, radius * radius - away * away));
  interval.add(c.real() - half);
  interval.add(c.real() + half);
}

/// What the points within `radius` of the segment a b take of the strip. They form two disks and the quadrilateral
/// between the two parallels of the segment.
Interval capsule_in_strip(Complex a, Complex b, double radius, double bottom, double top) {
  Interval interval;
  add_disk(interval, a, radius, bottom, top);
  add_disk(interval, b, radius, bottom, top);
  const double length = std::abs(b - a);
  if (!(length > 0)) return interval;
  const Complex normal = Complex(0, radius / length) * (b - a);
  add_segment(interval, a + normal, b + normal, bottom, top);
  add_segment(interval, a - normal, b - normal, bottom, top);
  return interval;
}

int cell_at(double x) {
  // Islands far outside of any grid: the caller clips.
  constexpr double limit = 1e9;
  return static_cast<int>(std::floor(std::clamp(x, -limit, limit)));
}

/// Where an edge crosses the middle of a row.
struct Crossing {
  int row;
  double x;
  int winding;
};

}  // namespace

std::vector<CellSpan> cell_spans(const std::vector<OutlineEdge>& edges, Complex factor, Complex origin, double border,
                                 int n_rows) {
  const double radius = border + rounding;
  std::vector<CellSpan> touched;
  std::vector<Crossing> crossings;
  for (const OutlineEdge& edge : edges) {
    const Complex a = factor * edge.from + origin;
    const Complex b = factor * edge.to + origin;
    const double low = std::min(a.imag(), b.imag());
    const double high = std::max(a.imag(), b.imag());
    const int last = std::min(n_rows - 1, cell_at(high + radius));
    for (int row = std::max(0, cell_at(low - radius)); row <= last; ++row) {
      const Interval interval = capsule_in_strip(a, b, radius, row, row + 1.0);
      if (interval.low <= interval.high) {
        touched.push_back({row, cell_at(interval.low - rounding), cell_at(interval.high + rounding) + 1});
      }
      const double middle = row + 0.5;
      if ((a.imag() <= middle) != (b.imag() <= middle)) {
        const double x = a.real() + (middle - a.imag()) / (b.imag() - a.imag()) * (b.real() - a.real());
        crossings.push_back({row, x, a.imag() <= middle ? 1 : -1});
      }
    }
  }
  // A cell that no edge touches is inside or outside as a whole, as the middle of its row is.
  std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
    return std::tie(a.row, a.x, a.winding) < std::tie(b.row, b.x, b.winding);
  });
  int winding = 0;
  for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
    winding = (i > 0 && crossings[i - 1].row != crossings[i].row ? 0 : winding) + crossings[i].winding;
    if (winding == 0 || crossings[i + 1].row != crossings[i].row) continue;
    touched.push_back({crossings[i].row, cell_at(crossings[i].x), cell_at(crossings[i + 1].x) + 1});
  }
  std::sort(touched.begin(), touched.end(), [](const CellSpan& a, const CellSpan& b) {
    return std::tie(a.row, a.begin, a.end) < std::tie(b.row, b.begin, b.end);
  });
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
