#include "packing/overlap_separation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "geometry/plane_box.h"
#include "packing/packing_turns.h"
#include "packing/settling.h"

namespace spectral_conformal {
namespace {

// Samples per move near its own position and anywhere in the window. Most end after a few spans, so all together take
// as long as drawing the map.
constexpr int near_samples = 60;
constexpr int far_samples = 300;
// The number of best samples to refine: the very best leads to the least overlap only about every other time.
constexpr std::size_t n_refined = 3;
// A move sees a window of this many island lengths, so that its time does not depend on the size of the grid.
constexpr int window_lengths = 4;
// After each pass without overlap, the weight of a pair falls by this factor (Gardeyn et al.).
constexpr double decay = 0.95;

/// The largest weight, and the unit of weights on the map, where they are integers: the sums of a row stay below 2^31.
double max_weight(int width, int n) {
  return std::max(1.0, std::sqrt(std::numeric_limits<std::int32_t>::max() / (width * (n + 1.0))));
}

/// How far a move nearby goes and turns an island's ends, in fine cells: as far as islands settle.
int nearby_reach() { return refinement * refinement; }

/// The part of length `size` about `middle`, within begin and end.
std::pair<int, int> part_about(int middle, int size, int begin, int end) {
  const int first = std::clamp(middle - size / 2, begin, std::max(begin, end - size));
  return {first, std::min(end, first + size)};
}

}  // namespace

OverlapSeparation::OverlapSeparation(const PackingProblem& problem, const PackingGrid& grid,
                                     const std::vector<std::vector<Complex>>& turns, std::vector<bool> by_quarters,
                                     MoveRange range, std::uint32_t seed)
    : problem_(problem),
      grid_(grid),
      turns_(turns),
      range_(range),
      n_(static_cast<int>(problem.islands.size())),
      max_weight_(max_weight(grid.space().width(), n_)),
      chance_(seed),
      taken_(grid.space().taken()),
      spots_(problem.islands.size()),
      pairs_(problem.islands.size()) {
  for (const IslandOutline& island : problem.islands) middles_.push_back(PlaneBox::of(hull_of(island)).middle());
  by_area_.resize(problem.islands.size());
  std::iota(by_area_.begin(), by_area_.end(), 0);
  std::stable_sort(by_area_.begin(), by_area_.end(), [&](int a, int b) {
    return problem.islands[static_cast<std::size_t>(a)].area < problem.islands[static_cast<std::size_t>(b)].area;
  });
  for (std::size_t i = 0; i < turns.size(); ++i) {
    turn_units_.push_back(by_quarters[i] ? std::max(1, static_cast<int>(turns[i].size()) / 4) : 1);
  }
}

double OverlapSeparation::uniform() { return static_cast<double>(chance_()) / 4294967296.0; }

const IslandRaster& OverlapSeparation::raster(int island) const {
  return rasters_->at(island, spots_[static_cast<std::size_t>(island)].turn);
}

Complex OverlapSeparation::middle(int island, const Spot& spot) const {
  const IslandRaster& raster = rasters_->at(island, spot.turn);
  return raster.factor() * middles_[static_cast<std::size_t>(island)] + raster.origin() + Complex(spot.at.x, spot.at.y);
}

OverlapSeparation::Spot OverlapSeparation::spot_at(int island, const IslandPose& pose) const {
  const Complex corner = pose.middle - middle(island, {pose.turn, {}});
  return {pose.turn, {static_cast<int>(std::lround(corner.real())), static_cast<int>(std::lround(corner.imag()))}};
}

std::vector<IslandPose> OverlapSeparation::poses() const {
  std::vector<IslandPose> result;
  for (int i = 0; i < n_; ++i) {
    const Spot& spot = spots_[static_cast<std::size_t>(i)];
    result.push_back({spot.turn, middle(i, spot)});
  }
  return result;
}

CellWindow OverlapSeparation::region_of(int island) const {
  const int region = problem_.region[static_cast<std::size_t>(island)];
  if (region < 0) return {0, grid_.space().width(), 0, grid_.space().height()};
  const PackingGrid::Band& band = grid_.bands()[static_cast<std::size_t>(region)];
  return {0, band.width, band.bottom, band.top};
}

bool OverlapSeparation::clamp(const IslandRaster& raster, const CellWindow& window, CellPosition& at) {
  const int right = window.x_end - raster.width();
  const int top = window.y_end - raster.height();
  if (right < window.x_begin || top < window.y_begin) return false;
  at = {std::clamp(at.x, window.x_begin, right), std::clamp(at.y, window.y_begin, top)};
  return true;
}

bool OverlapSeparation::start(std::shared_ptr<const CachedRasters> rasters, const std::vector<IslandPose>& poses) {
  rasters_ = std::move(rasters);
  for (auto& pairs : pairs_) pairs.clear();
  for (int i = 0; i < n_; ++i) {
    Spot& spot = spots_[static_cast<std::size_t>(i)];
    spot = spot_at(i, poses[static_cast<std::size_t>(i)]);
    if (!clamp(raster(i), region_of(i), spot.at)) return false;
  }
  measure_pairs();
  return true;
}

void OverlapSeparation::swap_two() {
  if (n_ < 2) return;
  // Islands of about the same area fit into each other's places.
  const auto rank = static_cast<std::size_t>(below(n_ - 1));
  const int a = by_area_[rank];
  const int b = by_area_[rank + 1];
  Spot& one = spots_[static_cast<std::size_t>(a)];
  Spot& two = spots_[static_cast<std::size_t>(b)];
  const IslandPose for_two{two.turn, middle(a, one)};
  one = spot_at(a, {one.turn, middle(b, two)});
  two = spot_at(b, for_two);
  clamp(raster(a), region_of(a), one.at);
  clamp(raster(b), region_of(b), two.at);
  measure_pairs();
}

int OverlapSeparation::shared_cells(int i, int j) const {
  const IslandRaster& one = raster(i);
  const IslandRaster& two = raster(j);
  const CellPosition p = position(i);
  const CellPosition q = position(j);
  const int x = q.x - p.x;
  const int y = q.y - p.y;
  if (x >= one.width() || -x >= two.width() || y >= one.height() || -y >= two.height()) return 0;
  auto a = one.spans().begin();
  auto b = two.spans().begin();
  int sum = 0;
  while (a != one.spans().end() && b != two.spans().end()) {
    if (a->row != b->row + y) {
      ++(a->row < b->row + y ? a : b);
      continue;
    }
    sum += std::max(0, std::min(a->end, b->end + x) - std::max(a->begin, b->begin + x));
    ++(a->end < b->end + x ? a : b);
  }
  return sum;
}

int OverlapSeparation::taken_cells(int island) const {
  if (taken_.empty()) return 0;
  const CellPosition at = position(island);
  int sum = 0;
  auto first = taken_.begin();
  for (const CellSpan& span : raster(island).spans()) {
    const int row = at.y + span.row;
    first = std::lower_bound(first, taken_.end(), row, [](const CellSpan& s, int r) { return s.row < r; });
    for (auto taken = first; taken != taken_.end() && taken->row == row; ++taken) {
      sum += std::max(0, std::min(at.x + span.end, taken->end) - std::max(at.x + span.begin, taken->begin));
    }
  }
  return sum;
}

void OverlapSeparation::measure_pairs() {
  n_overlapping_cells_ = 0;
  for (auto& pairs : pairs_) {
    for (Pair& pair : pairs) pair.cells = 0;
  }
  const auto set = [&](int i, int other, int cells) {
    auto& pairs = pairs_[static_cast<std::size_t>(i)];
    auto at = std::lower_bound(pairs.begin(), pairs.end(), other, [](const Pair& p, int o) { return p.other < o; });
    if (at == pairs.end() || at->other != other) at = pairs.insert(at, {other, 1, 0});
    at->cells = cells;
  };
  for (int i = 0; i < n_; ++i) {
    for (int j = 0; j < i; ++j) {
      const int cells = shared_cells(i, j);
      if (cells == 0) continue;
      set(i, j, cells);
      set(j, i, cells);
      n_overlapping_cells_ += cells;
    }
    if (const int cells = taken_cells(i)) {
      set(i, n_, cells);
      n_overlapping_cells_ += cells;
    }
  }
  poll(static_cast<std::size_t>(n_) * static_cast<std::size_t>(n_));
}

void OverlapSeparation::reweigh() {
  int largest = 1;
  for (const auto& pairs : pairs_) {
    for (const Pair& pair : pairs) largest = std::max(largest, pair.cells);
  }
  for (auto& pairs : pairs_) {
    for (Pair& pair : pairs) {
      const double growth = pair.cells > 0 ? 1 + static_cast<double>(pair.cells) / largest : decay;
      pair.weight = std::clamp(growth * pair.weight, 1.0, max_weight_);
    }
    pairs.erase(std::remove_if(pairs.begin(), pairs.end(), [](const Pair& p) { return p.cells == 0 && p.weight == 1; }),
                pairs.end());
  }
}

std::int32_t OverlapSeparation::weight_of(int island, int other) const {
  const auto& pairs = pairs_[static_cast<std::size_t>(island)];
  const auto at = std::lower_bound(pairs.begin(), pairs.end(), other, [](const Pair& p, int o) { return p.other < o; });
  const double weight = at != pairs.end() && at->other == other ? at->weight : 1.0;
  return static_cast<std::int32_t>(max_weight_ * weight);
}

std::int64_t OverlapSeparation::present_cost(int island) const {
  std::int64_t cost = std::int64_t{weight_of(island, n_)} * taken_cells(island);
  for (int j = 0; j < n_; ++j) {
    if (j == island) continue;
    if (const int cells = shared_cells(island, j)) cost += std::int64_t{weight_of(island, j)} * cells;
  }
  return cost;
}

void OverlapSeparation::draw_map(int island, const CellWindow& window) {
  map_.begin(window);
  map_.add(taken_, {}, weight_of(island, n_));
  for (int j = 0; j < n_; ++j) {
    const CellPosition at = position(j);
    const IslandRaster& other = raster(j);
    if (j == island || at.x >= window.x_end || at.y >= window.y_end || at.x + other.width() <= window.x_begin ||
        at.y + other.height() <= window.y_begin) {
      continue;
    }
    map_.add(other.spans(), at, weight_of(island, j));
  }
  map_.sum_rows();
}

CellWindow OverlapSeparation::window_about(int island) {
  const CellPosition at = position(island);
  const IslandRaster& own = raster(island);
  const CellWindow region = region_of(island);
  if (range_ == MoveRange::nearby) {
    // By the move and the turn.
    const int reach = 2 * nearby_reach();
    return {std::max(region.x_begin, at.x - reach), std::min(region.x_end, at.x + own.width() + reach),
            std::max(region.y_begin, at.y - reach), std::min(region.y_end, at.y + own.height() + reach)};
  }
  const int size = window_lengths * std::max(own.width(), own.height());
  const bool is_about_own = below(2) == 0;
  const int x = is_about_own ? at.x + own.width() / 2 : region.x_begin + below(region.x_end - region.x_begin);
  const int y = is_about_own ? at.y + own.height() / 2 : region.y_begin + below(region.y_end - region.y_begin);
  const auto [left, right] = part_about(x, size, region.x_begin, region.x_end);
  const auto [bottom, top] = part_about(y, size, region.y_begin, region.y_end);
  return {left, right, bottom, top};
}

void OverlapSeparation::move(int island) {
  const std::int64_t present = present_cost(island);
  if (present == 0) return;
  Spot& spot = spots_[static_cast<std::size_t>(island)];
  const int length = std::max(raster(island).width(), raster(island).height());
  const CellWindow window = window_about(island);
  draw_map(island, window);

  std::vector<Candidate> best;
  const auto sample = [&](Spot tried) {
    const IslandRaster& raster = rasters_->at(island, tried.turn);
    if (!clamp(raster, window, tried.at)) return;
    const std::int64_t limit = best.size() < n_refined ? std::int64_t{1} << 62 : best.back().cost;
    const std::int64_t cost = map_.under(raster, tried.at, limit);
    if (cost >= limit) return;
    if (best.size() == n_refined) best.pop_back();
    const auto at = std::upper_bound(best.begin(), best.end(), cost,
                                     [](std::int64_t c, const Candidate& candidate) { return c < candidate.cost; });
    best.insert(at, {cost, tried});
  };
  const int unit = turn_units_[static_cast<std::size_t>(island)];
  const int n_turns = static_cast<int>(turns_[static_cast<std::size_t>(island)].size()) / unit;
  const int present_turn = (spot.turn + unit / 2) / unit;
  const Complex here = middle(island, spot);
  // Near its own position, at all orders of magnitude: from half of the length to a cell, from a quarter of a turn to a
  // step; nearby, from half of the reach, with a turn of half of it at the island's end.
  const bool is_nearby = range_ == MoveRange::nearby;
  const double reach = is_nearby ? nearby_reach() : length;
  const double turn_reach = is_nearby ? n_turns * nearby_reach() / (pi * length) : 0.5 * n_turns;
  const auto at_any_order = [&](double most) { return std::pow(std::max(1.0, 0.5 * most), uniform()); };
  for (int k = 0; k < near_samples; ++k) {
    const double distance = at_any_order(reach);
    const int turns = n_turns <= 4 ? n_turns : static_cast<int>(std::ceil(at_any_order(turn_reach)));
    const int turn = (present_turn + below(2 * turns + 1) - turns + n_turns) % n_turns;
    const Complex step(distance * (2 * uniform() - 1), distance * (2 * uniform() - 1));
    sample(spot_at(island, {unit * turn, here + step}));
  }
  // Refining finds turns between.
  const int coarse = std::min(number_of_turns(turns_.size()), n_turns);
  for (int k = 0; k < (is_nearby ? 0 : far_samples); ++k) {
    const int turn = unit * below(coarse) * (n_turns / coarse);
    const IslandRaster& raster = rasters_->at(island, turn);
    const int columns = window.x_end - window.x_begin - raster.width() + 1;
    const int rows = window.y_end - window.y_begin - raster.height() + 1;
    if (columns < 1 || rows < 1) continue;
    const int column = below(columns);
    sample({turn, {window.x_begin + column, window.y_begin + below(rows)}});
  }
  Candidate found{present, spot};
  for (const Candidate& candidate : best) {
    const Candidate next = refined(island, candidate);
    if (next.cost < found.cost) found = next;
  }
  spot = found.spot;
  // A nanosecond per cell of the map; the samples take as long.
  poll((window.x_end - window.x_begin) * (window.y_end - window.y_begin));
}

OverlapSeparation::Candidate OverlapSeparation::refined(int island, Candidate from) const {
  const int n_turns = static_cast<int>(turns_[static_cast<std::size_t>(island)].size());
  const IslandRaster& own = rasters_->at(island, from.spot.turn);
  // From the distance between samples down to a cell and a turn.
  const bool is_nearby = range_ == MoveRange::nearby;
  int step = is_nearby ? nearby_reach() / 8 : std::max(1, std::max(own.width(), own.height()) / 8);
  const bool is_upright = n_turns <= 4 || turn_units_[static_cast<std::size_t>(island)] > 1;
  int turn_step = is_upright ? 0 : is_nearby ? 1 : std::max(1, n_turns / (4 * number_of_turns(turns_.size())));
  while (from.cost > 0) {
    Candidate next = from;
    const auto try_spot = [&](Spot spot) {
      const IslandRaster& raster = rasters_->at(island, spot.turn);
      if (!clamp(raster, map_.window(), spot.at)) return;
      const std::int64_t cost = map_.under(raster, spot.at, next.cost);
      if (cost < next.cost) next = {cost, spot};
    };
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) {
        try_spot({from.spot.turn, {from.spot.at.x + step * x, from.spot.at.y + step * y}});
      }
    }
    if (turn_step > 0) {
      const Complex here = middle(island, from.spot);
      for (const int by : {-turn_step, turn_step}) {
        try_spot(spot_at(island, {(from.spot.turn + by + n_turns) % n_turns, here}));
      }
    }
    if (next.cost < from.cost) {
      from = next;
    } else if (step > 1 || turn_step > 1) {
      step = std::max(1, step / 2);
      turn_step = turn_step > 1 ? turn_step / 2 : turn_step;
    } else {
      break;
    }
  }
  return from;
}

bool OverlapSeparation::pass() {
  std::vector<int> overlapping;
  for (int i = 0; i < n_; ++i) {
    const auto& pairs = pairs_[static_cast<std::size_t>(i)];
    if (std::any_of(pairs.begin(), pairs.end(), [](const Pair& pair) { return pair.cells > 0; })) {
      overlapping.push_back(i);
    }
  }
  for (std::size_t k = overlapping.size(); k > 1; --k) {
    std::swap(overlapping[k - 1], overlapping[static_cast<std::size_t>(below(static_cast<int>(k)))]);
  }
  for (const int i : overlapping) move(i);
  measure_pairs();
  reweigh();
  return n_overlapping_cells_ == 0;
}

}  // namespace spectral_conformal
