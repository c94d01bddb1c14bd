#include "spectral_conformal/island_packing.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "concurrency/parallel_calls.h"
#include "geometry/bounding_rectangles.h"
#include "geometry/plane_box.h"
#include "geometry/tolerances.h"
#include "layout/congruent_islands.h"
#include "layout/island_outline.h"
#include "layout/upright.h"
#include "packing/cell_outline.h"
#include "packing/overlapping_islands.h"
#include "packing/packing_as_given.h"
#include "packing/packing_by_boxes.h"
#include "packing/packing_growth.h"
#include "packing/packing_search.h"
#include "packing/settling.h"

namespace spectral_conformal {
namespace {

constexpr const char* phase = "packing";
// A quick packing looks at this many words of the grid for each corner, about 2 ns each: a fortieth of what solving
// takes.
constexpr double quick_looks_per_corner = 20;
// With more, a pass over all pairs of islands takes longer than artists wait.
constexpr std::size_t max_growing = 3000;
// From this many islands on, the first packing is searched for again on a finer grid. In a second, that gains more than
// growth; with fewer islands, growth gains more.
constexpr std::size_t finer_from = 60;
// Islands below the least size are enlarged for this share of the scale that was found, and often enough for a packing
// of small islands alone to get nowhere.
constexpr double least_share = 0.98;
constexpr int max_enlargements = 10;

std::vector<IslandOutline> outlines_of(const PackingIslands& islands) {
  return island_outlines(islands.points, islands.face_offsets, islands.corners, islands.island_of_face,
                         static_cast<int>(islands.region.size()));
}

IslandOutline obstacles_of(const PackingIslands& islands) {
  std::vector<int> stays(islands.island_of_face.size());
  std::transform(islands.island_of_face.begin(), islands.island_of_face.end(), stays.begin(),
                 [](int island) { return island == -1 ? 0 : -1; });
  return island_outlines(islands.points, islands.face_offsets, islands.corners, stays, 1).front();
}

/// The area that the outline covers, by the midpoint rule over horizontal lines.
double covered_area(const IslandOutline& outline) {
  constexpr int n_lines = 1000;
  PlaneBox box;
  for (const OutlineEdge& edge : outline.edges) box.include(edge.from);
  const double step = box.size().imag() / n_lines;
  if (!(step > 0)) return 0;
  /// Where the outline crosses each line, and by how much the winding changes there.
  std::vector<std::vector<std::pair<double, int>>> crossings(n_lines);
  for (const OutlineEdge& edge : outline.edges) {
    const auto place = [&](Complex z) { return (z.imag() - box.low[1]) / step - 0.5; };
    const auto [low, high] = std::minmax({place(edge.from), place(edge.to)});
    for (int k = std::max(0, static_cast<int>(std::ceil(low))); k < high && k < n_lines; ++k) {
      const double share = (k - place(edge.from)) / (place(edge.to) - place(edge.from));
      const double x = edge.from.real() + share * (edge.to - edge.from).real();
      crossings[static_cast<std::size_t>(k)].emplace_back(x, place(edge.from) < place(edge.to) ? -1 : 1);
    }
  }
  double sum = 0;
  for (auto& line : crossings) {
    std::sort(line.begin(), line.end());
    int winding = 0;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      winding += line[i].second;
      if (winding != 0) sum += line[i + 1].first - line[i].first;
    }
  }
  return sum * step;
}

/// Whether both outlines have the same points, but for the rounding of maps in single precision.
bool are_equal(const IslandOutline& one, const IslandOutline& two) {
  double farthest = 0;
  for (const OutlineEdge& edge : one.edges) farthest = std::max(farthest, std::abs(edge.from));
  const double tolerance = single_rounding * farthest;
  return lies_on(one, {}, two, tolerance) && lies_on(two, {}, one, tolerance);
}

/// Stacked islands move as one. Outlines that differ from that of the representative are added to it, so that the
/// margin holds for all; n_outlines: of how many each then consists. If one of them keeps its turn, the representative
/// does.
std::vector<StackedIsland> stacked(std::vector<IslandOutline>& outlines, std::vector<int>& n_outlines,
                                   std::vector<bool>& keeps_turn, const PackingIslands& islands,
                                   const PackingOptions& options) {
  const std::size_t n = outlines.size();
  n_outlines.assign(n, 1);
  std::vector<StackedIsland> result(n);
  for (std::size_t i = 0; i < n; ++i) result[i].representative = static_cast<int>(i);
  const auto stack = [&](Congruence congruence) {
    std::vector<IslandOutline> alone(n);
    for (std::size_t i = 0; i < n; ++i) {
      if (result[i].representative == static_cast<int>(i)) alone[i] = outlines[i];
    }
    const std::vector<StackedIsland> found = congruent_islands(alone, congruence, options.stack_tolerance);
    for (std::size_t i = 0; i < n; ++i) {
      const StackedIsland& next = found[static_cast<std::size_t>(result[i].representative)];
      const auto own = static_cast<std::size_t>(result[i].representative);
      if (next.representative == result[i].representative) continue;
      if (keeps_turn[own]) {
        if (std::abs(next.onto.factor.imag()) > single_rounding) continue;
        keeps_turn[static_cast<std::size_t>(next.representative)] = true;
      }
      const bool was_alone = own == i;
      result[i] = {next.representative, composed(next.onto, result[i].onto)};
      // The outline of a representative includes those of its stack already.
      if (!was_alone) continue;
      const auto stack_of = static_cast<std::size_t>(next.representative);
      IslandOutline moved;
      add(moved, outlines[i], next.onto);
      if (are_equal(moved, alone[stack_of])) continue;
      add(outlines[stack_of], moved, {});
      n_outlines[stack_of] += n_outlines[i];
    }
  };
  if (options.keeps_stacks) stack(Congruence::in_place);
  if (options.keeps_overlaps) {
    // Those that coincide are in one group with their representative, whose triangles suffice.
    std::vector<int> island_of_face = islands.island_of_face;
    for (int& island : island_of_face) {
      if (island >= 0 && result[static_cast<std::size_t>(island)].representative != island) island = -1;
    }
    const std::vector<int> first =
        overlapping_islands(islands.points, islands.face_offsets, islands.corners, island_of_face, static_cast<int>(n));
    std::vector<bool> has_more(n);
    for (std::size_t i = 0; i < n; ++i) {
      const auto group = static_cast<std::size_t>(first[i]);
      if (group == i || result[i].representative != static_cast<int>(i)) continue;
      has_more[group] = true;
      if (keeps_turn[i]) keeps_turn[group] = true;
      add(outlines[group], outlines[i], {});
      n_outlines[group] += n_outlines[i];
    }
    for (std::size_t i = 0; i < n; ++i) {
      if (has_more[i]) outlines[i].area = covered_area(outlines[i]);
      result[i].representative = first[static_cast<std::size_t>(result[i].representative)];
    }
  }
  if (options.stacks == PackingStacks::equal) stack(Congruence::moved);
  if (options.stacks == PackingStacks::mirrored) stack(Congruence::mirrored);
  return result;
}

/// How an island turns: none, quarters or free.
PackingTurns turns_of(const IslandOutline& outline, PackingTurns turns) {
  if (turns == PackingTurns::upright) return PackingTurns::quarters;
  if (turns != PackingTurns::square) return turns;
  return is_rectilinear(outline) ? PackingTurns::quarters : PackingTurns::free;
}

/// Straightens the island about the middle of its box, so that it stays about where it is; returns the motion.
PlaneMotion straighten(IslandOutline& outline) {
  const Complex turn = straight_turn(outline);
  if (turn == 1.0) return {};
  PlaneBox box;
  for (const OutlineEdge& edge : outline.edges) box.include(edge.from);
  const PlaneMotion motion{turn, false, (1.0 - turn) * box.middle()};
  for (OutlineEdge& edge : outline.edges) edge = {motion(edge.from), motion(edge.to)};
  return motion;
}

}  // namespace

struct IslandPacking::State {
  State(PackingOptions given, double unit) : options(std::move(given)), unit(unit) {}

  void stack_islands(const PackingIslands& islands) {
    std::vector<IslandOutline> outlines = outlines_of(islands);
    std::vector<bool> keeps_turn = islands.keeps_turn;
    keeps_turn.resize(outlines.size());
    std::vector<int> n_outlines;
    stacks = stacked(outlines, n_outlines, keeps_turn, islands, options);
    for (const PackingRegion& region : options.regions) {
      const Complex size = region.high - region.low;
      region_area += size.real() * size.imag();
    }
    packed_as.assign(outlines.size(), -1);
    for (std::size_t i = 0; i < outlines.size(); ++i) {
      // Islands without faces stay.
      if (stacks[i].representative != static_cast<int>(i) || outlines[i].edges.empty()) continue;
      packed_as[i] = static_cast<int>(problem.islands.size());
      problem.islands.push_back(without_inner_edges(std::move(outlines[i]), n_outlines[i]));
      IslandOutline& island = problem.islands.back();
      const PackingTurns turns = keeps_turn[i] ? PackingTurns::none : turns_of(island, options.turns);
      const bool is_straightened = turns == PackingTurns::quarters && options.turns != PackingTurns::quarters;
      straightening.push_back(is_straightened ? straighten(island) : PlaneMotion{});
      problem.turns.push_back(turns);
      problem.region.push_back(islands.region[i]);
    }
    options.turns = options.turns == PackingTurns::upright  ? PackingTurns::quarters
                    : options.turns == PackingTurns::square ? PackingTurns::free
                                                            : options.turns;
    problem.obstacles = obstacles_of(islands);
    motions.resize(outlines.size());
    has_room.assign(outlines.size(), false);
    for (std::size_t i = 0; i < outlines.size(); ++i) stack.push_back(stacks[i].representative);
  }

  void begin(std::size_t n_corners) {
    if (problem.islands.empty()) return;
    if (!(static_cast<double>(problem.islands.size()) <= max_with_room())) return;
    if (!options.scales) enlarge_small(1);
    begin_packing(n_corners);
    if (!options.scales) return;
    for (int round = 0; best.scale > 0 && enlarge_small(best.scale); ++round) {
      best = {};
      has_room.assign(has_room.size(), false);
      // If all that fits is less and less, it comes to nothing.
      if (round < max_enlargements) begin_packing(n_corners);
    }
  }

  /// Enlarges the islands, about their middles, that are below the least size at this scale. Returns whether there are
  /// any.
  bool enlarge_small(double scale) {
    if (!(options.min_size > 0)) return false;
    if (longer_side.empty()) {
      for (const IslandOutline& island : problem.islands) {
        const Rectangle smallest = smallest_rectangles(hull_of(island), 0).front();
        longer_side.push_back(std::max(smallest.width, smallest.height));
      }
    }
    bool any = false;
    for (std::size_t i = 0; i < problem.islands.size(); ++i) {
      if (!(longer_side[i] > 0) || longer_side[i] * scale >= (1 - single_rounding) * options.min_size) continue;
      any = true;
      // Somewhat larger, since those that get larger make the scale smaller.
      const double growth = options.min_size / (longer_side[i] * (options.scales ? least_share * scale : scale));
      longer_side[i] *= growth;
      problem.islands[i].area *= growth * growth;
      PlaneBox box;
      for (const OutlineEdge& edge : problem.islands[i].edges) box.include(edge.from);
      const PlaneMotion larger{growth, false, (1 - growth) * box.middle()};
      for (OutlineEdge& edge : problem.islands[i].edges) edge = {larger(edge.from), larger(edge.to)};
      straightening[i] = composed(larger, straightening[i]);
    }
    return any;
  }

  void begin_packing(std::size_t n_corners) {
    best = packing_by_boxes(problem, options, true);
    if (options.is_quick && options.scales) {
      begin_quickly(n_corners);
      return;
    }
    begin_search();
    // All of the search for boxes is of use only where some are denser.
    if (best.scale < largest_scale_of_boxes(problem, options)) accept(packing_by_boxes(problem, options, false));
  }

  /// Packs by shape if that takes little work.
  void begin_quickly(std::size_t n_corners) {
    is_search_due = true;
    spread();
    // Beside obstacles there is no packing by boxes.
    const double looks = best.scale > 0 ? quick_looks_per_corner * static_cast<double>(n_corners) : infinity;
    if (!(PackingSearch::least_looks(problem, options) < looks)) return;
    search.emplace(problem, options);
    if (search->begin_within(looks, best.scale)) accept(search->unsettled());
  }

  void begin_search() {
    is_search_due = false;
    search.emplace(problem, options);
    is_complete = search->begin();
    accept(search->settled());
    const double least = n_with_room(best) == problem.islands.size() ? (1 - single_rounding) * best.scale : 0;
    const Packing given = packing_as_given(problem, options, search->fine_grid(), unit, least);
    if (given.scale == 0) return;
    is_complete = true;
    best = given;
    spread();
  }

  /// An upper bound for the number of islands that have room at any scale; without scaling, infinite if one may have
  /// room.
  double max_with_room() const {
    double number = 0;
    for (const PackingRegion& region : options.regions) {
      const Complex size = region.high - region.low - Complex(2, 2) * options.margin;
      if (!(size.real() >= 0 && size.imag() >= 0)) continue;
      if (!options.scales || options.margin == 0) return infinity;
      // Oler's inequality for points of a rectangle, a distance of 1 or more apart.
      const Complex sides = size / options.margin;
      number += 2 / std::sqrt(3.0) * sides.real() * sides.imag() + sides.real() + sides.imag() + 1;
    }
    return number;
  }

  /// Whether a denser packing may be found; at a given scale, one of more islands.
  bool may_improve() const {
    if (is_search_due) return true;
    if (!search || !search->may_improve() || best.scale == 0) return false;
    if (!options.scales) return !is_complete;
    return !are_points(best.scale) && (is_finer_due() || problem.islands.size() <= max_growing);
  }
  bool is_finer_due() const { return problem.islands.size() >= finer_from && !is_finer_done; }

  /// Tries to improve the packing once.
  void advance() {
    if (is_search_due) {
      begin_search();
    } else if (!options.scales) {
      is_complete = search->advance();
    } else if (is_finer_due()) {
      if (!finer) finer.emplace(problem, options, refinement);
      is_finer_done = finer->narrow(best.scale, best.scale / max_settled_growth);
      if (is_finer_done) accept(finer->settled());
    } else {
      const PackingGrid& fine_grid = (finer ? *finer : *search).fine_grid();
      if (!growth)
        growth.emplace(PackingGrowth::begin(problem, options, search->grid(), fine_grid, best, finer.has_value()));
      growth->advance();
    }
  }

  void accept_settled() { accept(growth ? growth->packing() : search->settled()); }

  void accept(const Packing& settled) {
    if (std::pair(n_with_room(settled), settled.scale) > std::pair(n_with_room(best), best.scale)) best = settled;
    spread();
  }

  /// Sets the motions of all islands from those of the packed ones.
  void spread() {
    double area = 0;
    for (std::size_t i = 0; i < motions.size(); ++i) {
      const int packed = packed_as[static_cast<std::size_t>(stacks[i].representative)];
      if (packed < 0 || best.has_room.empty() || !best.has_room[static_cast<std::size_t>(packed)]) continue;
      has_room[i] = true;
      const auto p = static_cast<std::size_t>(packed);
      motions[i] = composed(best.motions[p], composed(straightening[p], stacks[i].onto));
      if (packed_as[i] >= 0) area += problem.islands[static_cast<std::size_t>(packed)].area;
    }
    fill = area * best.scale * best.scale / region_area;
  }

  PackingOptions options;
  double unit;
  PackingProblem problem;
  std::vector<StackedIsland> stacks;
  std::vector<int> stack;
  std::vector<PlaneMotion> straightening;  ///< of each island of the problem, before it is packed; with its enlargement
  std::vector<double> longer_side;         ///< of each island of the problem, if there is a least size
  std::vector<int> packed_as;              ///< of each island: its index in the problem, -1 for stacked and empty ones
  std::vector<PlaneMotion> motions;
  std::vector<bool> has_room;
  Packing best;
  std::optional<PackingSearch> search;
  std::optional<PackingSearch> finer;
  bool is_search_due = false;  ///< after a quick first packing
  bool is_finer_done = false;  ///< whether the finer search has found its packing
  std::optional<PackingGrowth> growth;
  bool is_complete = false;  ///< whether all islands found room
  double region_area = 0;
  double fill = 0;
  int steps = 0;
  int tries_left_over = 0;  ///< asked for, but fewer than are made at once
};

IslandPacking IslandPacking::begin(const PackingIslands& islands, PackingOptions options, const Progress& progress) {
  const CancellationScope scope(progress, phase);
  auto state = std::make_unique<State>(std::move(options), islands.unit);
  state->stack_islands(islands);
  state->begin(islands.corners.size());
  report(scope.progress(), 1, phase);
  return IslandPacking(std::move(state));
}

IslandPacking::IslandPacking(std::unique_ptr<State> state) : state_(std::move(state)) {}
IslandPacking::~IslandPacking() = default;
IslandPacking::IslandPacking(IslandPacking&&) noexcept = default;

bool IslandPacking::advance(int n, double seconds, const Progress& progress) {
  State& state = *state_;
  const CancellationScope scope(progress, phase);
  const auto begin = std::chrono::steady_clock::now();
  const auto is_late = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() >= seconds;
  };
  const double tries = static_cast<double>(n) + state.tries_left_over;
  double done = 0;
  while (state.may_improve() && done + tries_at_once <= tries && !is_late()) {
    state.advance();
    done += tries_at_once;
    state.steps += tries_at_once;
    report(scope.progress(), done / tries, phase);
  }
  state.tries_left_over = static_cast<int>(std::min(tries - done, tries_at_once - 1.0));
  if (done > 0) state.accept_settled();
  report(scope.progress(), 1, phase);
  return state.may_improve();
}

const std::vector<PlaneMotion>& IslandPacking::motions() const { return state_->motions; }
const std::vector<bool>& IslandPacking::has_room() const { return state_->has_room; }
const std::vector<int>& IslandPacking::stack() const { return state_->stack; }
double IslandPacking::scale() const { return state_->best.scale; }
double IslandPacking::fill() const { return state_->fill; }
int IslandPacking::steps() const { return state_->steps; }

}  // namespace spectral_conformal
