#include "packing/packing_search.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "concurrency/parallel_calls.h"
#include "concurrency/work_counter.h"
#include "geometry/bounding_rectangles.h"
#include "geometry/tolerances.h"
#include "packing/packing_turns.h"

namespace spectral_conformal {
namespace {

// With more islands a trial takes long, and the first packing must do with fewer.
constexpr std::size_t many = 200;

/// Bisection of the scale ends at this ratio; settling makes up for some of it.
double scale_precision(std::size_t n_islands, double fineness) {
  return 1 + (n_islands > many ? 0.01 : 0.004) / fineness;
}

/// Where the search for a position begins.
///
/// A raster about as large as an earlier one will hardly fit where that one did not. So rasters are classed by width
/// and height, and the search begins where it ended for the class, less the raster's height. With few islands, it
/// begins at the bottom, since every gap counts.
class SearchStart {
 public:
  explicit SearchStart(bool is_used) : is_used_(is_used) {}

  int of(const IslandRaster& raster, int region, int bottom) {
    return is_used_ ? std::max(bottom, end(raster, region) - raster.height()) : bottom;
  }
  void set(const IslandRaster& raster, int region, int y) {
    if (is_used_) end(raster, region) = y;
  }

 private:
  /// Four per factor 2: lengths of a class differ by at most 19 %.
  static int class_of(int length) { return static_cast<int>(4 * std::log2(std::max(1, length))); }
  int& end(const IslandRaster& raster, int region) {
    return ends_[{region, class_of(raster.width()), class_of(raster.height())}];
  }

  bool is_used_;
  std::map<std::tuple<int, int, int>, int> ends_;  ///< by region and class
};

double cells_along(const PackingProblem& problem, const PackingOptions& options, double fineness) {
  const double per_region = static_cast<double>(problem.islands.size()) /
                            static_cast<double>(std::max<std::size_t>(1, options.regions.size()));
  return fineness * std::max(cells_across, std::round(cells_per_island * std::sqrt(per_region)));
}

/// Cells per pixel of the coarse grid.
double cell_resolution(const PackingProblem& problem, const PackingOptions& options, double fineness) {
  // Of the finer grid: 60 MB at 12 levels.
  constexpr double max_fine_cells = 4e7;
  double side = 0;
  double area = 0;
  for (const PackingRegion& region : options.regions) {
    const Complex size = region.high - region.low - options.margin * Complex(1, 1);
    side = std::max({side, size.real(), size.imag()});
    area += size.real() * size.imag();
  }
  return std::min(cells_along(problem, options, fineness) / side, std::sqrt(max_fine_cells / area) / refinement);
}

// What it takes to make a span of a raster, in words read.
constexpr double looks_per_span = 60;

/// The islands by falling key.
template <class Key>
std::vector<int> by(std::size_t n, const Key& key) {
  std::vector<double> keys(n);
  for (std::size_t i = 0; i < n; ++i) keys[i] = key(i);
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return keys[static_cast<std::size_t>(a)] > keys[static_cast<std::size_t>(b)]; });
  return order;
}

}  // namespace

PackingSearch::PackingSearch(const PackingProblem& problem, const PackingOptions& options, double fineness)
    : problem_(problem),
      options_(options),
      fineness_(fineness),
      grid_(options.regions, options.margin, problem.obstacles, cell_resolution(problem, options, fineness)) {
  const std::size_t n = problem.islands.size();
  for (std::size_t i = 0; i < n; ++i) {
    hulls_.push_back(hull_of(problem.islands[i]));
    turns_.push_back(turns_of(hulls_.back(), problem.turns_of(i, options.turns), number_of_turns(n)));
  }
  const auto area = [&](std::size_t i) { return problem.islands[i].area; };
  const auto box = [&](std::size_t i) { return bounding_rectangle(hulls_[i], 1); };
  const auto length = [&](std::size_t i) { return std::hypot(box(i).width, box(i).height); };
  first_orders_ = {by(n, area), by(n, length)};
  chains_ = first_orders_;
  chains_.push_back(by(n, [&](std::size_t i) { return area(i) * length(i); }));
  chains_.push_back(by(n, [&](std::size_t i) { return box(i).width * box(i).height; }));
  for (std::uint32_t k = 0; k < tries_at_once; ++k) chances_.emplace_back(tries_at_once * options.seed + k);
}

PackingSearch::TurnedRasters PackingSearch::rasters(double scale) const {
  const std::size_t n = problem_.islands.size();
  TurnedRasters result(n);
  double edges = 0;
  for (const IslandOutline& island : problem_.islands) edges += static_cast<double>(island.edges.size());
  const double factor = scale * grid_.cells_per_pixel();
  const double visits = 1 + number_of_turns(n) * edges / static_cast<double>(n);  // of an island
  const auto block_size = static_cast<std::size_t>(std::max(1.0, shared_steps / visits));
  run_blocks_in_parallel(n, block_size, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (const Complex turn : turns_[i]) {
        const Rectangle box = bounding_rectangle(hulls_[i], std::conj(turn));
        if (factor * box.width + 2 * grid_.border() > grid_.space().width() ||
            factor * box.height + 2 * grid_.border() > grid_.space().height()) {
          continue;
        }
        IslandRaster raster = IslandRaster::of(problem_.islands[i], factor * turn, grid_.border());
        const auto same = [&](const IslandRaster& other) { return other.has_same_cells(raster); };
        if (std::none_of(result[i].begin(), result[i].end(), same)) result[i].push_back(std::move(raster));
      }
    }
  });
  return result;
}

PackingSearch::Trial PackingSearch::put_in(const Order& order, const TurnedRasters& rasters, bool is_quick) const {
  Trial trial;
  trial.spots.resize(rasters.size());
  FreeSpace space = grid_.space();
  SearchStart start(is_quick && rasters.size() > many);
  for (const int i : order) {
    const int region = problem_.region[static_cast<std::size_t>(i)];
    int bottom = 0;
    int top = space.height();
    if (region >= 0) {
      bottom = grid_.bands()[static_cast<std::size_t>(region)].bottom;
      top = grid_.bands()[static_cast<std::size_t>(region)].top;
    }
    Spot& spot = trial.spots[static_cast<std::size_t>(i)];
    const auto& turned = rasters[static_cast<std::size_t>(i)];
    for (std::size_t k = 0; k < turned.size(); ++k) {
      const FreeSpace::Window window = space.window(turned[k], start.of(turned[k], region, bottom), top);
      const auto found = space.lowest(turned[k], window, trial.looks);
      start.set(turned[k], region, found ? found->y : std::max(window.y_begin, window.y_end));
      if (!found) continue;
      spot = {static_cast<int>(k), *found};
      // Another turn must have a lower top.
      top = found->y + turned[k].height() - 1;
    }
    if (spot.turn < 0) {
      trial.without_room.push_back(i);
      if (is_quick) break;
      continue;
    }
    space.occupy(turned[static_cast<std::size_t>(spot.turn)].spans(), spot.at);
  }
  return trial;
}

bool PackingSearch::try_orders(const std::vector<Order>& orders, double scale, bool is_quick) {
  if (scale != rasters_scale_) {
    rasters_ = rasters(scale);
    rasters_scale_ = scale;
    double spans = 0;
    for (const auto& turned : rasters_) {
      for (const IslandRaster& raster : turned) spans += static_cast<double>(raster.spans().size());
    }
    count_steps(looks_per_span * spans);
    looks_ += looks_per_span * spans;
  }
  trials_.assign(orders.size(), {});
  run_in_parallel(
      static_cast<int>(orders.size()),
      [&](int k, const Progress&) {
        const auto i = static_cast<std::size_t>(k);
        trials_[i] = put_in(orders[i], rasters_, is_quick);
      },
      {}, "packing");
  double looks = 0;
  for (const Trial& trial : trials_) looks += trial.looks;
  count_steps(looks);
  looks_ += looks;
  for (std::size_t k = 0; k < trials_.size(); ++k) {
    if (!trials_[k].without_room.empty()) continue;
    scale_ = scale;
    best_ = trials_[k];
    best_rasters_ = rasters_;
    is_settled_ = false;
    for (Order& chain : chains_) chain = Order(orders[k]);
    return true;
  }
  return false;
}

double PackingSearch::first_scale() const {
  // The part of the cells that most first packings take.
  const double usual = hulls_.size() > many ? 0.85 : 0.7;
  double room = 0;
  double side = infinity;
  for (const PackingGrid::Band& band : grid_.bands()) {
    const int shorter = std::min(band.width, band.top - band.bottom);
    if (shorter == 0) continue;
    room += static_cast<double>(band.width) * (band.top - band.bottom);
    side = std::min(side, static_cast<double>(shorter));
  }
  if (room == 0) return 0;
  // The cells that islands take: their area, half the margin, and the touched cells around their outlines.
  double area = 0;
  double length = 0;
  double longest = 0;
  for (std::size_t i = 0; i < hulls_.size(); ++i) {
    area += problem_.islands[i].area;
    for (const OutlineEdge& edge : problem_.islands[i].edges) length += std::abs(edge.to - edge.from);
    const Rectangle box = bounding_rectangle(hulls_[i], 1);
    longest = std::max({longest, box.width, box.height});
  }
  if (!(longest > 0)) return 1;
  const double cells = grid_.cells_per_pixel();
  const double border = grid_.border();
  // If the margins alone take more, the search starts from a hundredth of the cells.
  const double fixed = static_cast<double>(hulls_.size()) * (2 * border + 1) * (2 * border + 1);
  const double rest = std::max(usual * room - fixed, 0.01 * usual * room);
  // A line of length 1 touches 4 / pi cells on average, half of them on each side.
  const double by_length = (border + 2 / pi) * length;
  const double by_area = 2 * rest / (by_length + std::sqrt(by_length * by_length + 4 * area * rest));
  // Thin islands fit by length rather than by area; diagonals allow somewhat more than a side.
  return std::min(1.4 * side / longest, by_area) / cells;
}

bool PackingSearch::begin() {
  if (options_.scales) {
    const double first = first_scale();
    while (first > 0 && !narrow(first, insignificant * first)) {
    }
    return scale_ > 0;
  }
  if (try_orders(first_orders_, 1, false)) return true;
  const auto fewest = std::min_element(trials_.begin(), trials_.end(), [](const Trial& a, const Trial& b) {
    return a.without_room.size() < b.without_room.size();
  });
  scale_ = 1;
  best_ = *fewest;
  best_rasters_ = rasters_;
  return false;
}

double PackingSearch::least_looks(const PackingProblem& problem, const PackingOptions& options) {
  // Two scales that have no room, and two that have. An island of mean size has as many rows as cells across.
  constexpr double n_scales = 4;
  const auto n = static_cast<double>(problem.islands.size());
  const double cells = cells_along(problem, options, 1);
  const double turns = options.turns == PackingTurns::none       ? 1
                       : options.turns == PackingTurns::quarters ? 4
                                                                 : number_of_turns(problem.islands.size());
  return n_scales * turns * looks_per_span * n * cells / std::sqrt(n);
}

bool PackingSearch::begin_within(double looks, double least_scale) {
  const double first = first_scale();
  const double least = std::max(least_scale, insignificant * first);
  while (first > 0 && looks_ < looks && !narrow(std::max(first, least), least)) {
  }
  return scale_ > 0;
}

bool PackingSearch::narrow(double first_scale, double least_scale) {
  // Up until there is no room, down until there is room, then bisection. The first steps are half of what settling may
  // gain.
  const double precision = scale_precision(problem_.islands.size(), fineness_);
  if (trial_scale_ == 0) {
    trial_scale_ = first_scale;
    factor_ = std::sqrt(max_settled_growth);
  }
  if (try_orders(first_orders_, trial_scale_, true)) {
    if (high_ == infinity) {
      trial_scale_ *= factor_;
      factor_ *= factor_;
    }
  } else {
    high_ = trial_scale_;
    if (scale_ == 0) {
      trial_scale_ /= factor_;
      factor_ *= factor_;
    }
  }
  if (scale_ > 0 && high_ < infinity) trial_scale_ = std::sqrt(scale_ * high_);
  if (scale_ == 0) return trial_scale_ < least_scale;
  return are_points(trial_scale_) || high_ <= precision * scale_;
}

bool PackingSearch::may_improve() const { return problem_.islands.size() > 1 || options_.turns == PackingTurns::free; }

bool PackingSearch::advance() {
  if (try_orders(std::vector<Order>(chains_), scale_, false)) return true;
  for (int k = 0; k < tries_at_once; ++k) reorder(k);
  return false;
}

void PackingSearch::reorder(int chain) {
  const auto c = static_cast<std::size_t>(chain);
  Order& order = chains_[c];
  std::mt19937& chance = chances_[c];
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(chance() % static_cast<std::uint32_t>(n)); };
  const std::vector<int>& without_room = trials_[c].without_room;
  // An island that found no room goes to the front.
  const int island = without_room[below(without_room.size())];
  const auto at = std::find(order.begin(), order.end(), island);
  const auto position = static_cast<std::size_t>(at - order.begin());
  if (position > 0) {
    const auto to = static_cast<std::ptrdiff_t>(below(position));
    std::rotate(order.begin() + to, at, at + 1);
  }
  // Two others change places, to escape dead ends.
  std::swap(order[below(order.size())], order[below(order.size())]);
}

const PackingGrid& PackingSearch::fine_grid() {
  if (!fine_) {
    fine_.emplace(options_.regions, options_.margin, problem_.obstacles, refinement * grid_.cells_per_pixel());
  }
  return *fine_;
}

GridLayout PackingSearch::layout() const {
  GridLayout layout{scale_, std::vector<const IslandRaster*>(best_.spots.size()), {}};
  for (std::size_t i = 0; i < best_.spots.size(); ++i) {
    const Spot& spot = best_.spots[i];
    if (spot.turn >= 0) layout.rasters[i] = &best_rasters_[i][static_cast<std::size_t>(spot.turn)];
    layout.at.push_back(spot.at);
  }
  return layout;
}

Packing PackingSearch::unsettled() const { return best_.spots.empty() ? Packing{} : on_cells(grid_, layout()); }

const Packing& PackingSearch::settled() {
  // The margin leaves no room.
  if (is_settled_ || best_.spots.empty()) return packing_;
  is_settled_ = true;
  // As much finer as the cells are.
  const double precision = (scale_precision(best_.spots.size(), fineness_) - 1) / refinement;
  Packing packing = spectral_conformal::settled(problem_, grid_, fine_grid(), layout(), options_.scales, precision);
  if (packing.scale >= packing_.scale) packing_ = std::move(packing);
  return packing_;
}

}  // namespace spectral_conformal
