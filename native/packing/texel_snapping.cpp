#include "packing/texel_snapping.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

#include "concurrency/cancellation_scope.h"
#include "geometry/tolerances.h"
#include "layout/island_outline.h"

namespace spectral_conformal {
namespace {

/// In pixels: how far the points of a straight border may be from one line, and edges from each other.
constexpr double same_line = 0.01;

/// A straight border along an axis, or several on one line.
struct StraightBorder {
  double low = 0;  ///< the range of its points across
  double high = 0;
  double length = 0;

  double middle() const { return 0.5 * (low + high); }
};

/// The borders of an island with a constant coordinate `across`, ascending. along: the other coordinate.
template <class Across, class Along>
std::vector<StraightBorder> straight_borders(const IslandOutline& outline, const Across& across, const Along& along) {
  std::vector<StraightBorder> edges;
  for (const OutlineEdge& edge : outline.edges) {
    const auto [low, high] = std::minmax({across(edge.from), across(edge.to)});
    const double length = std::abs(along(edge.to - edge.from));
    if (length > 0 && high - low <= std::min(sliver * length, same_line)) edges.push_back({low, high, length});
  }
  std::sort(edges.begin(), edges.end(), [](const auto& a, const auto& b) { return a.low < b.low; });
  std::vector<StraightBorder> borders;
  for (const StraightBorder& edge : edges) {
    if (borders.empty() || edge.low - borders.back().high > same_line) {
      borders.push_back(edge);
      continue;
    }
    StraightBorder& border = borders.back();
    border.high = std::max(border.high, edge.high);
    border.length += edge.length;
  }
  return borders;
}

/// A monotone function of one coordinate.
class Snapping {
 public:
  explicit Snapping(const std::vector<StraightBorder>& borders) {
    for (const StraightBorder& border : borders) {
      const double integer = std::round(border.middle());
      if (border.length < 1) continue;
      if (knots_.empty() || knots_.back().integer != integer) {
        knots_.push_back({border, integer});
      } else if (border.length > knots_.back().border.length) {
        knots_.back().border = border;
      }
    }
  }

  double operator()(double x) const {
    const auto above =
        std::partition_point(knots_.begin(), knots_.end(), [&](const Knot& knot) { return knot.border.high < x; });
    if (above != knots_.end() && above->border.low <= x) return above->integer;
    if (above == knots_.begin()) return knots_.empty() ? x : x - above->border.low + above->integer;
    const Knot& below = *std::prev(above);
    if (above == knots_.end()) return x - below.border.high + below.integer;
    const double share = (x - below.border.high) / (above->border.low - below.border.high);
    return (1 - share) * below.integer + share * above->integer;
  }

 private:
  struct Knot {
    StraightBorder border;
    double integer = 0;  ///< where it goes
  };

  std::vector<Knot> knots_;  ///< ascending
};

}  // namespace

void snap_to_texels(ComplexVector& points, const std::vector<int>& face_offsets, const std::vector<int>& corners,
                    const std::vector<int>& island_of_face, int n) {
  const std::vector<IslandOutline> outlines = island_outlines(points, face_offsets, corners, island_of_face, n);
  std::vector<Snapping> u;
  std::vector<Snapping> v;
  for_each_polled(outlines.size(), [&](std::size_t i) {
    const auto real = [](Complex z) { return z.real(); };
    const auto imag = [](Complex z) { return z.imag(); };
    u.emplace_back(straight_borders(outlines[i], real, imag));
    v.emplace_back(straight_borders(outlines[i], imag, real));
  });
  std::vector<char> is_moved(static_cast<std::size_t>(points.size()), 0);
  for_each_polled(island_of_face.size(), [&](std::size_t f) {
    if (island_of_face[f] < 0 || island_of_face[f] >= n) return;
    const auto island = static_cast<std::size_t>(island_of_face[f]);
    for (int c = face_offsets[f]; c < face_offsets[f + 1]; ++c) {
      const int p = corners[static_cast<std::size_t>(c)];
      if (is_moved[static_cast<std::size_t>(p)] != 0) continue;
      is_moved[static_cast<std::size_t>(p)] = 1;
      points[p] = {u[island](points[p].real()), v[island](points[p].imag())};
    }
  });
}

}  // namespace spectral_conformal
