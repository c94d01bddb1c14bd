#include "packing/packing_by_boxes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "geometry/bounding_rectangles.h"
#include "geometry/plane_box.h"
#include "geometry/tolerances.h"
#include "spectral_conformal/box_packing.h"

namespace spectral_conformal {
namespace {

struct Box {
  Complex turn = 1;
  Complex low;   ///< after the turn
  Complex size;  ///< width and height
};

Box box_of(const std::vector<Complex>& hull, Complex turn) {
  PlaneBox box;
  for (const Complex point : hull) box.include(turn * point);
  return {turn, box.low_corner(), box.size()};
}

Box as_given(const IslandOutline& island) {
  PlaneBox box;
  for (const OutlineEdge& edge : island.edges) {
    box.include(edge.from);
    box.include(edge.to);
  }
  return {1, box.low_corner(), box.size()};
}

/// The box, turned onto its long side if it may turn.
Box lying(const std::vector<Complex>& hull, PackingTurns turns) {
  if (turns == PackingTurns::none) return box_of(hull, 1);
  const Complex along =
      turns == PackingTurns::free ? std::conj(smallest_rectangles(hull, 0).front().direction) : Complex(1);
  const Box box = box_of(hull, along);
  return box.size.imag() > box.size.real() ? box_of(hull, along * Complex(0, -1)) : box;
}

/// The side of a square of the size, in units of its own, that this many squares of the margin's size need in rows.
double side_of_equal(std::size_t n, double margin, Complex size) {
  const double row = std::ceil(std::sqrt(static_cast<double>(n)));
  return row * margin / std::min(size.real(), size.imag());
}

/// The scale at which the boxes and their margins fill this part of the region.
double scale_of_fill(const std::vector<Box>& boxes, double margin, Complex size, double fill) {
  double square = 0;
  double linear = 0;
  for (const Box& box : boxes) {
    square += box.size.real() * box.size.imag();
    linear += margin * (box.size.real() + box.size.imag());
  }
  const double room = fill * size.real() * size.imag();
  const double rest = std::max(room - static_cast<double>(boxes.size()) * margin * margin, 0.01 * room);
  return 2 * rest / (linear + std::sqrt(linear * linear + 4 * square * rest));
}

Packing pack(const std::vector<Box>& boxes, const PackingRegion& region, double margin, bool is_quick) {
  // Boxes grow by the margin; region and boxes are in units of the remaining region.
  const Complex size = region.high - region.low - margin * Complex(1, 1);
  if (!(size.real() > 0 && size.imag() > 0)) return {};
  std::vector<PackedBox> packed(boxes.size());
  const auto side_at = [&](double scale) {
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      packed[i].width = (scale * boxes[i].size.real() + margin) / size.real();
      packed[i].height = (scale * boxes[i].size.imag() + margin) / size.imag();
    }
    return pack_boxes(packed, is_quick ? few_exchanged_boxes : all_exchanged_boxes);
  };
  Packing result;
  const auto adopt = [&](double scale) {
    result.scale = scale;
    result.motions.clear();
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const Complex corner(packed[i].x * size.real(), packed[i].y * size.imag());
      result.motions.push_back(
          {scale * boxes[i].turn, false, region.low + margin * Complex(1, 1) + corner - scale * boxes[i].low});
    }
    result.has_room.assign(boxes.size(), true);
  };
  double extent = 0;
  for (const Box& box : boxes)
    extent = std::max({extent, box.size.real() / size.real(), box.size.imag() / size.imag()});
  if (!(extent > 0)) return result;
  // The side is about that of the margins alone plus a part proportional to the scale. Secant steps, halved if they
  // leave the interval known to hold the best scale, come within a thousandth of it.
  const int steps = is_quick ? 3 : 8;
  const double side_of_margins = is_quick ? side_of_equal(boxes.size(), margin, size) : side_at(0);
  if (!(side_of_margins < 1)) return result;
  double scale = (1 - side_of_margins) / extent;
  constexpr double usual_fill = 0.95;
  if (is_quick) scale = std::min(scale, scale_of_fill(boxes, margin, size, usual_fill));
  double too_large = infinity;
  for (int k = 0; k < steps; ++k) {
    const double side = side_at(scale);
    if (side <= 1) {
      if (scale > result.scale) adopt(scale);
    } else {
      too_large = std::min(too_large, scale);
    }
    double next = (1 - insignificant) * scale * (1 - side_of_margins) / (side - side_of_margins);
    if (!(next > result.scale && next < too_large)) next = 0.5 * (result.scale + std::min(too_large, 2 * result.scale));
    scale = next;
  }
  return result;
}

/// Calls visit(boxes) for the boxes as given and, if islands may turn, for those turned to lie.
template <class Visit>
void for_each_kind(const PackingProblem& problem, const PackingOptions& options, const Visit& visit) {
  if (options.regions.size() != 1 || !problem.obstacles.edges.empty() || !options.scales) return;
  std::vector<Box> boxes;
  for (const IslandOutline& island : problem.islands) boxes.push_back(as_given(island));
  visit(boxes);
  if (options.turns == PackingTurns::none) return;
  for (std::size_t i = 0; i < boxes.size(); ++i)
    boxes[i] = lying(hull_of(problem.islands[i]), problem.turns_of(i, options.turns));
  visit(boxes);
}

}  // namespace

Packing packing_by_boxes(const PackingProblem& problem, const PackingOptions& options, bool is_quick) {
  Packing best;
  for_each_kind(problem, options, [&](const std::vector<Box>& boxes) {
    Packing packing = pack(boxes, options.regions.front(), options.margin, is_quick);
    if (best.motions.empty() || packing.scale > best.scale) best = std::move(packing);
  });
  return best;
}

double largest_scale_of_boxes(const PackingProblem& problem, const PackingOptions& options) {
  double largest = 0;
  for_each_kind(problem, options, [&](const std::vector<Box>& boxes) {
    const Complex size = options.regions.front().high - options.regions.front().low - options.margin * Complex(1, 1);
    if (size.real() > 0 && size.imag() > 0) largest = std::max(largest, scale_of_fill(boxes, options.margin, size, 1));
  });
  return largest;
}

}  // namespace spectral_conformal
