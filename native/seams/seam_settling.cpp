#include "seams/seam_settling.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "concurrency/parallel_calls.h"
#include "seams/seam_retraction.h"

namespace spectral_conformal {
namespace {

/// A path that leaves a chain farther than a part of the chain's length may be another cut than the chain, such as
/// around the other side of a limb. Where it does not pay, one nearer the chain may.
constexpr std::array<double, 3> corridors{1.0 / 2, 1.0 / 8, 1.0 / 32};

class SeamSettling {
 public:
  /// What a change must lower: the functional, or its terms for seams alone, within the limits.
  enum class Aim { value, length };

  SeamSettling(CutPiece& piece, Aim aim, std::int64_t max_vertices, const Progress& progress)
      : piece_(piece), aim_(aim), progress_(progress), first_(piece.solved_vertices()), max_vertices_(max_vertices) {}

  void run() {
    do {
      join_crumbs();
      straighten();
    } while (aim_ == Aim::value ? take_back() : retract_seams(piece_, vertices_left(), progress_));
  }

  void run_with_rings() {
    while (complete_rings()) run();
  }

 private:
  std::int64_t vertices_left() const { return max_vertices_ - (piece_.solved_vertices() - first_); }
  bool has_time() const { return vertices_left() > 0; }

  bool improves(const SeamTrial& trial) const {
    return (aim_ == Aim::value ? trial.value < piece_.value() : piece_.shortens(trial)) && piece_.is_sound(trial);
  }

  void remember(const TrialMaps& charts) { known_.insert(charts.begin(), charts.end()); }

  /// Removes chains or parts of them. Returns whether any was removed.
  bool take_back() {
    bool any = false;
    while (has_time()) {
      std::vector<SeamEdges> removals = possible_removals();
      if (removals.empty()) break;
      const auto saved = [&](const SeamEdges& removed) { return piece_.seams().cost(removed); };
      std::stable_sort(removals.begin(), removals.end(),
                       [&](const SeamEdges& a, const SeamEdges& b) { return saved(a) > saved(b); });
      removals.resize(std::min<std::size_t>(removals.size(), tries_at_once));
      std::vector<std::array<SeamEdges, 2>> changes;
      changes.reserve(removals.size());
      for (SeamEdges& removed : removals) changes.push_back({SeamEdges{}, std::move(removed)});
      any = make_best(changes) || any;
    }
    return any;
  }

  /// Makes the change that lowers the functional most, if any does.
  bool make_best(const std::vector<std::array<SeamEdges, 2>>& changes) {
    std::vector<SeamTrial> trials = piece_.attempt_all(changes, known_, progress_);
    SeamTrial* best = nullptr;
    for (SeamTrial& trial : trials) {
      remember(trial.charts);
      if (!improves(trial)) {
        failed_.insert({trial.added, trial.removed});
      } else if (best == nullptr || trial.value < best->value) {
        best = &trial;
      }
    }
    if (best == nullptr) return false;
    piece_.apply(std::move(*best));
    return true;
  }

  /// Completes a ring that is cut for the most part. Returns whether that lowered the functional.
  bool complete_rings() {
    if (!has_time()) return false;
    std::vector<std::array<SeamEdges, 2>> changes;
    for (SeamEdges& missing : piece_.seams().missing_in_rings()) {
      if (failed_.count({missing, {}}) > 0 || !(piece_.least_value(missing, {}) < piece_.value())) continue;
      changes.push_back({std::move(missing), SeamEdges{}});
    }
    return make_best(changes);
  }

  /// Every chain; once all have failed, the half of each at either end, and at a tip the next smaller part.
  std::vector<SeamEdges> possible_removals() const {
    std::vector<SeamEdges> result;
    const std::vector<SeamChain> chains = piece_.seams().chains();
    for (const SeamChain& chain : chains) add_if_new(chain.edges, result);
    if (!result.empty()) return result;
    for (const SeamChain& chain : chains) {
      if (chain.is_own_image && !is_mapped_onto_itself(chain)) continue;
      for (const std::size_t end : {0, 1}) {
        // The rest must still meet other seams at the other end.
        if (chain.is_tip[1 - end]) continue;
        SeamEdges part = chain.edges;
        if (end == 1) std::reverse(part.begin(), part.end());
        // A slit may be a little too long.
        for (const std::size_t fraction : {2, 4, 8}) {
          if (chain.edges.size() < fraction || (fraction > 2 && !chain.is_tip[end])) break;
          part.resize(chain.edges.size() / fraction);
          if (add_if_new(part, result)) break;
        }
      }
    }
    return result;
  }

  /// Returns whether the removal has not failed yet.
  bool add_if_new(const SeamEdges& edges, std::vector<SeamEdges>& removals) const {
    SeamEdges removed = piece_.seams().with_cut_images(edges);
    if (failed_.count({{}, removed}) > 0) return false;
    if (piece_.seams().cost(removed) > 0) removals.push_back(std::move(removed));
    return true;
  }

  /// Whether a chain that is its own image lies in the mirror plane, rather than across it.
  bool is_mapped_onto_itself(const SeamChain& chain) const {
    return piece_.seams().with_cut_images({chain.edges.front()}).size() == 1;
  }

  /// A change of the seams. `chain` is the one that it moves, if any.
  struct Move {
    SeamChain chain;
    SeamEdges removed;
    SeamEdges added;
  };
  using Moves = std::vector<Move>;
  /// Adapts moves to the seams of now.
  using Adapt = std::function<Moves(const Moves&)>;

  /// Joins every crumb to a neighbor.
  void join_crumbs() {
    make(crumbs(), [](const Moves& moves) { return moves; });
  }

  /// For each island whose border is shorter than what an island costs, the seams that it shares with one neighbor, the
  /// longest of such. Cuts around defects leave such islands where they cross other seams.
  Moves crumbs() const {
    const auto& edges = piece_.seams().graph().edges();
    const std::vector<int>& chart_of_face = piece_.chart_of_face();
    std::vector<std::map<int, SeamEdges>> shared(piece_.charts().size());  // per chart and its neighbor
    for (const int edge : piece_.seams().edges()) {
      const int one = chart_of_face[edges[edge].faces[0]];
      const int other = chart_of_face[edges[edge].faces[1]];
      if (one == other || one < 0 || other < 0) continue;
      shared[one][other].push_back(edge);
      shared[other][one].push_back(edge);
    }
    const double longest = piece_.cost_of_island();
    std::set<int> used;
    Moves moves;
    for (const auto& neighbors : shared) {
      double whole = 0;
      std::pair<double, const SeamEdges*> best{0, nullptr};
      for (const auto& neighbor : neighbors) {
        const double length = piece_.seams().graph().length(neighbor.second);
        whole += length;
        if (length > best.first) best = {length, &neighbor.second};
      }
      if (best.second == nullptr || !(whole < longest)) continue;
      SeamEdges removed = piece_.seams().with_cut_images(*best.second);
      const bool is_new = std::none_of(removed.begin(), removed.end(), [&](int e) { return used.count(e) > 0; });
      if (!is_new || failed_.count({{}, removed}) > 0) continue;
      used.insert(removed.begin(), removed.end());
      moves.push_back({{}, std::move(removed), {}});
    }
    return moves;
  }

  void straighten() {
    for (const double corridor : corridors) {
      while (straighten(piece_.seams().chains(), corridor)) {
      }
    }
  }

  bool straighten(const std::vector<SeamChain>& chains, double corridor) {
    const auto again = [&](const Moves& moves) {
      std::vector<SeamChain> others;
      std::transform(moves.begin(), moves.end(), std::back_inserter(others),
                     [](const Move& move) { return move.chain; });
      return straightening(others, corridor);
    };
    return has_time() && make(straightening(chains, corridor), again);
  }

  /// Each chain's path depends on the moves before it.
  Moves straightening(const std::vector<SeamChain>& chains, double corridor) const {
    PieceSeams later = piece_.seams();
    Moves moves;
    for (const SeamChain& chain : chains) {
      SeamEdges whole = later.with_cut_images(chain.edges);
      later.remove(whole);
      SeamEdges path = later.straightened(chain, corridor);
      const bool is_moved = !path.empty() && failed_.count({path, whole}) == 0;
      later.add(is_moved ? path : whole);
      if (is_moved) moves.push_back({chain, std::move(whole), std::move(path)});
    }
    return moves;
  }

  /// Makes all moves at once, for one solve of each chart; if that does not pay, each half of them. Returns whether any
  /// was made.
  bool make(const Moves& moves, const Adapt& adapt) {
    if (moves.empty() || !has_time()) return false;
    SeamEdges added;
    SeamEdges removed;
    for (const Move& move : moves) {
      added.insert(added.end(), move.added.begin(), move.added.end());
      removed.insert(removed.end(), move.removed.begin(), move.removed.end());
    }
    SeamTrial trial = piece_.attempt(std::move(added), std::move(removed), known_, progress_);
    remember(trial.charts);
    if (improves(trial)) {
      piece_.apply(std::move(trial));
      return true;
    }
    if (moves.size() == 1) {
      failed_.insert({trial.added, trial.removed});
      return false;
    }
    // The moves of the first half stay; without them, those of the second would be others.
    const auto middle = moves.begin() + static_cast<std::ptrdiff_t>(moves.size() / 2);
    const bool first = make({moves.begin(), middle}, adapt);
    const bool second = has_time() && make(adapt({middle, moves.end()}), adapt);
    return first || second;
  }

  CutPiece& piece_;
  Aim aim_;
  const Progress& progress_;
  std::int64_t first_;  ///< solved vertices at the start
  std::int64_t max_vertices_;
  KnownMaps known_;  ///< of trials: those that lowered F less than the one made are tried again
  std::set<std::pair<SeamEdges, SeamEdges>> failed_;  ///< edges added and removed
};

}  // namespace

void settle_seams(CutPiece& piece, std::int64_t max_vertices, const Progress& progress) {
  SeamSettling(piece, SeamSettling::Aim::value, max_vertices, progress).run();
}

void complete_rings(CutPiece& piece, std::int64_t max_vertices, const Progress& progress) {
  piece.count_rings();
  SeamSettling(piece, SeamSettling::Aim::value, max_vertices, progress).run_with_rings();
}

void shorten_seams(CutPiece& piece, std::int64_t max_vertices, const Progress& progress) {
  SeamSettling(piece, SeamSettling::Aim::length, max_vertices, progress).run();
}

}  // namespace spectral_conformal
