#include "spectral_conformal/box_packing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <random>
#include <utility>

#include "concurrency/work_counter.h"
#include "geometry/tolerances.h"
#include "packing/shelves.h"
#include "packing/skyline.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {
namespace {

using Order = std::vector<std::size_t>;

using Pack = void (*)(double width, const Order& order, std::vector<PackedBox>& boxes);

/// Packs the boxes into a strip under a skyline.
void put_under_skyline(double width, const Order& order, std::vector<PackedBox>& boxes) {
  Skyline skyline(width);
  for (const std::size_t i : order) skyline.put(boxes[i]);
}

/// The best packing so far, with its order.
class BoxPackingSearch {
 public:
  explicit BoxPackingSearch(const std::vector<PackedBox>& boxes) : best_(boxes), tried_(boxes) {
    double area = 0;
    for (const PackedBox& box : boxes) {
      area += box.width * box.height;
      longest_ = std::max({longest_, box.width, box.height});
    }
    least_ = std::max(longest_, std::sqrt(area));
  }

  double side() const { return side_; }
  const std::vector<PackedBox>& boxes() const { return best_; }
  /// Whether no smaller packing is possible.
  bool is_done() const { return !(side_ > least_ * (1 + insignificant)); }

  /// Tries strips of all widths that may yield a smaller square: from the smallest possible one up to the best side so
  /// far, each wider by the factor `step`.
  void try_order(const Order& order, Pack pack, double step) {
    for (double width = least_; width < side_ && !is_done(); width *= step) {
      attempt(order, width, pack);
      if (!(width > 0)) return;
    }
  }

  /// Swaps pseudo-random boxes of the best order, the same in each run, this many times, and tries squares smaller by
  /// the factor `step`.
  void improve(std::size_t attempts, double step) {
    std::mt19937 chance;
    const auto n = static_cast<std::uint32_t>(order_.size());
    if (n < 2) return;
    Order order = order_;
    for (std::size_t k = 0; k < attempts && !is_done(); ++k) {
      std::size_t& one = order[chance() % n];
      std::size_t& other = order[chance() % n];
      if (is_same_size(best_[one], best_[other])) continue;
      std::swap(one, other);
      if (!attempt(order, std::max(least_, side_ / step), put_under_skyline)) std::swap(one, other);
    }
  }

 private:
  static bool is_same_size(const PackedBox& a, const PackedBox& b) {
    return a.width == b.width && a.height == b.height;
  }
  /// Packs the boxes into a strip; the side is that of the square that holds them.
  bool attempt(const Order& order, double width, Pack pack) {
    pack(width, order, tried_);
    count_steps(static_cast<double>(order.size()));
    double side = 0;
    for (const PackedBox& box : tried_) side = std::max({side, box.x + box.width, box.y + box.height});
    if (!(side < side_)) return false;
    side_ = side;
    order_ = order;
    best_.swap(tried_);
    return true;
  }

  std::vector<PackedBox> best_;
  std::vector<PackedBox> tried_;
  Order order_;
  double side_ = infinity;
  double longest_ = 0;
  double least_ = 0;
};

/// The boxes in the order of decreasing keys.
template <class Key>
Order by(const std::vector<PackedBox>& boxes, const Key& key) {
  Order order(boxes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return key(boxes[a]) > key(boxes[b]); });
  return order;
}

}  // namespace

double pack_boxes(std::vector<PackedBox>& boxes, std::size_t exchanged_boxes) {
  if (boxes.empty()) return 0;
  constexpr std::size_t max_boxes_in_orders = 400;
  constexpr double step = 1.01;
  // For shelves, which take less time than a skyline, and exchanges.
  constexpr double fine_step = 1.001;
  BoxPackingSearch search(boxes);
  const Order by_height = by(boxes, [](const PackedBox& box) { return std::pair(box.height, box.width); });
  search.try_order(by_height, put_under_skyline, step);
  if (boxes.size() <= max_boxes_in_orders) {
    const auto try_by = [&](const auto& key) { search.try_order(by(boxes, key), put_under_skyline, step); };
    try_by([](const PackedBox& box) { return std::max(box.width, box.height); });
    try_by([](const PackedBox& box) { return box.width * box.height; });
    try_by([](const PackedBox& box) { return std::pair(box.width, box.height); });
    search.improve(exchanged_boxes / boxes.size(), fine_step);
  }
  search.try_order(by_height, put_on_shelves, fine_step);
  boxes = search.boxes();
  return search.side();
}

}  // namespace spectral_conformal
