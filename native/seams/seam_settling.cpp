#include "seams/seam_settling.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace spectral_conformal {
namespace {

/// A change of the seams that lowers their cost.
struct Move {
  SeamEdges added;
  SeamEdges removed;
  double saved;
  bool may_join = true;  ///< islands: less than half of a chain would leave a narrow hinge
};

class SeamSettling {
 public:
  SeamSettling(CutPiece& piece, const Progress& progress) : piece_(piece), progress_(progress) {}

  void run(std::int64_t max_vertices) {
    const std::int64_t first = piece_.solved_vertices();
    while (piece_.solved_vertices() - first < max_vertices) {
      std::vector<Move> moves = possible_moves();
      if (moves.empty()) return;
      std::stable_sort(moves.begin(), moves.end(), [](const Move& a, const Move& b) { return a.saved > b.saved; });
      moves.resize(std::min<std::size_t>(moves.size(), trials_at_once));
      std::vector<std::array<SeamEdges, 2>> changes;
      changes.reserve(moves.size());
      for (const Move& move : moves) changes.push_back({move.added, move.removed});
      std::vector<SeamTrial> trials = piece_.attempt_all(changes, known_, progress_);
      SeamTrial* best = nullptr;
      for (std::size_t i = 0; i < trials.size(); ++i) {
        SeamTrial& trial = trials[i];
        for (const auto& mapped : trial.charts) {
          if (!known_.contains(mapped)) known_.add(mapped);
        }
        const bool joins = trial.charts.size() < piece_.charts().size();
        if (!(trial.value < piece_.value()) || (joins && !moves[i].may_join) || !piece_.is_sound(trial)) {
          failed_.insert({trial.added, trial.removed});
        } else if (best == nullptr || trial.value < best->value) {
          best = &trial;
        }
      }
      if (best != nullptr) piece_.take(std::move(*best));
    }
  }

 private:
  using Change = std::pair<SeamEdges, SeamEdges>;

  std::vector<Move> possible_moves() {
    std::vector<Move> result;
    const PieceSeams& seams = piece_.seams();
    for (const SeamChain& chain : seams.chains()) {
      const SeamEdges whole = seams.with_cut_images(chain.edges);
      add_if_new({}, whole, result);
      if (failed_.count({{}, whole}) > 0) add_parts(chain, result);
      add_if_new(straightened(chain, whole), whole, result);
    }
    return result;
  }

  void add_if_new(const SeamEdges& added, const SeamEdges& removed, std::vector<Move>& moves,
                  bool may_join = true) const {
    if (failed_.count({added, removed}) > 0 || meets_others(added, removed)) return;
    const double saved = piece_.seams().cost(removed) - piece_.seams().cost(added);
    if (saved > 0) moves.push_back({added, removed, saved, may_join});
  }

  /// Whether an added edge is cut and not among the removed ones: other moves came after its path was found.
  bool meets_others(const SeamEdges& added, const SeamEdges& removed) const {
    return std::any_of(added.begin(), added.end(), [&](int e) {
      return piece_.seams().graph().edges()[e].cut && !std::binary_search(removed.begin(), removed.end(), e);
    });
  }

  /// Adds the next smaller part at each end, once the larger one has failed.
  void add_parts(const SeamChain& chain, std::vector<Move>& moves) const {
    if (chain.is_own_image && !is_mapped_onto_itself(chain)) return;
    for (const int end : {0, 1}) {
      // The rest must still meet other seams at the other end.
      if (chain.is_tip[static_cast<std::size_t>(1 - end)]) continue;
      SeamEdges part = chain.edges;
      if (end == 1) std::reverse(part.begin(), part.end());
      for (const std::size_t fraction : {2, 4, 8}) {
        if (chain.edges.size() < fraction) break;
        part.resize(chain.edges.size() / fraction);
        const SeamEdges removed = piece_.seams().with_cut_images(part);
        if (failed_.count({{}, removed}) > 0) continue;
        add_if_new({}, removed, moves, fraction == 2);
        break;
      }
    }
  }

  /// Whether a chain that is its own image lies in the mirror plane, rather than across it.
  bool is_mapped_onto_itself(const SeamChain& chain) const {
    return piece_.seams().with_cut_images({chain.edges.front()}).size() == 1;
  }

  const SeamEdges& straightened(const SeamChain& chain, const SeamEdges& whole) {
    const auto [known, is_new] = straight_.try_emplace(whole);
    if (is_new) {
      PieceSeams without = piece_.seams();
      without.remove(whole);
      known->second = without.straightened(chain);
    }
    // Without a cheaper path, the chain itself, which saves nothing.
    return known->second.empty() ? known->first : known->second;
  }

  CutPiece& piece_;
  const Progress& progress_;
  KnownMaps known_;                          ///< of trials: moves that lowered F, but others more, are tried again
  std::set<Change> failed_;                  ///< moves
  std::map<SeamEdges, SeamEdges> straight_;  ///< per chain with its image, empty if nothing is cheaper
};

}  // namespace

void settle_seams(CutPiece& piece, std::int64_t max_vertices, const Progress& progress) {
  SeamSettling(piece, progress).run(max_vertices);
}

}  // namespace spectral_conformal
