#include "spectral_conformal/seam_suggestion.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "graph/parallel_calls.h"
#include "mesh/mirror_symmetry.h"
#include "seams/canonical_mesh.h"
#include "seams/carried_seams.h"
#include "seams/coarse_piece.h"
#include "seams/cutter.h"
#include "seams/filled_piece.h"
#include "seams/piece_seams.h"
#include "seams/pieces.h"
#include "seams/seam_preferences.h"

namespace spectral_conformal {
namespace {

/// Of one piece; far above what any took (at most 112 on the meshes of the tests): a bound, not a limit.
constexpr int max_steps = 1000;
/// Seams of pieces with more vertices are looked for on a coarse copy first, then carried over to finer ones and to the
/// piece, each of which has at most `level_ratio` times as many vertices.
constexpr int max_searched = 6000;
/// A smaller piece, down to `min_copied` vertices, gets coarse copies once its search has solved for this number of
/// vertices: seams found on copies were 9 % longer on meshes whose search ends before, but 9 % shorter, in less than
/// half the time, on bodies with many limbs.
constexpr std::int64_t patience = 220000;
constexpr int min_copied = 2048;
constexpr int level_ratio = 4;
constexpr int coarse_vertices = 1000;
/// The energy above that of an isometry that is allowed on coarse copies, as a fraction of what is allowed in the end:
/// finer ones have more of it with the same seams, and to cut them further takes longer.
constexpr double coarse_energy = 0.85;

bool has_extent(const Piece& piece) {
  if (!piece.positions.allFinite()) return false;
  const double extent = (piece.positions.colwise().maxCoeff() - piece.positions.colwise().minCoeff()).maxCoeff();
  return extent > 0 && std::isfinite(extent);
}

/// The whole mesh in canonical order: its pieces, the seams found so far, and what is left of the length that they may
/// have.
class SeamFinder {
 public:
  SeamFinder(const CanonicalMesh& canonical, const SeamSuggestionOptions& options, const Progress& progress)
      : options_(options),
        coarse_options_(options),
        progress_(progress),
        length_left_(options.max_length),
        mesh_vertices_(canonical.vertices()) {
    coarse_options_.energy_limit = 4 + coarse_energy * (options.energy_limit - 4);
    report(progress, 0.0, "charts");
    const PolygonMesh mesh = canonical.view();
    const ChartDecomposition decomposition = build_charts(mesh);
    pieces_ = split_into_pieces(mesh, decomposition);
    symmetry_ = find_mirror_symmetry(mesh);
    mirrors_ = mirror_pieces(mesh, decomposition, pieces_, symmetry_);
    cutters_.resize(pieces_.size());
    levels_.resize(pieces_.size());
    filled_.resize(pieces_.size());
    began_on_copies_.resize(pieces_.size(), false);
  }

  SeamSuggestion run() {
    for (std::size_t i = 0; i < pieces_.size(); ++i) open(i);
    run_in_parallel(
        static_cast<int>(cutters_.size()), Cutter::max_threads,
        [&](int i, const Progress& going_on) {
          if (cutters_[static_cast<std::size_t>(i)]) cutters_[static_cast<std::size_t>(i)]->solve(going_on);
        },
        quiet(), "seams");
    std::vector<int> steps(cutters_.size(), 0);
    for (int next = most_urgent(steps); next >= 0; next = most_urgent(steps)) {
      const auto i = static_cast<std::size_t>(next);
      ++steps_;
      ++steps[i];
      add(i, cutters_[i]->seams(), cutters_[i]->step(length_left_ / copies(i), quiet()));
      if (!levels_[i].empty() && (cutters_[i]->finished() || steps[i] >= max_steps)) {
        refine(i);
        steps[i] = 0;
      } else if (takes_too_long(i)) {
        begin_again_on_copies(i);
        steps[i] = 0;
      }
    }
    report(progress_, 1.0, "done");
    return result();
  }

 private:
  /// What topology needs. The first of two mirrored pieces does the work for both.
  void open(std::size_t i) {
    const int image = mirrors_[i].image;
    if (!has_extent(pieces_[i]) || (image >= 0 && image < static_cast<int>(i))) return;
    if (n_vertices(i) > max_searched) make_levels(i);
    begin(i);
  }
  /// On the coarsest copy that there is.
  void begin(std::size_t i) {
    report(progress_, 0.02, "seams");
    PieceSeams seams = unseamed(i);
    for (const SeamEdges& cut : seams.open()) add(i, seams, cut);
    cutters_[i] = cutter(i, std::move(seams), false);
  }
  bool takes_too_long(std::size_t i) const {
    return levels_[i].empty() && !began_on_copies_[i] && !cutters_[i]->finished() && n_vertices(i) > min_copied &&
           cutters_[i]->solved_vertices() > patience;
  }
  void begin_again_on_copies(std::size_t i) {
    make_levels(i);
    if (levels_[i].empty()) return;
    length_left_ += copies(i) * cutters_[i]->seams().length(cutters_[i]->seams().edges());
    cuts_.erase(std::remove_if(cuts_.begin(), cuts_.end(), [&](const auto& cut) { return cut.first == i; }),
                cuts_.end());
    begin(i);
    cutters_[i]->solve(quiet());
  }
  std::unique_ptr<Cutter> cutter(std::size_t i, PieceSeams&& seams, bool refined) const {
    return std::make_unique<Cutter>(std::move(seams), levels_[i].empty() ? options_ : coarse_options_,
                                    Cutter::Stage{n_vertices(i), refined});
  }
  int n_vertices(std::size_t i) const { return static_cast<int>(pieces_[i].vertices.size()); }
  /// Copies of a large piece, each with fewer vertices than the one before.
  void make_levels(std::size_t i) {
    began_on_copies_[i] = true;
    const bool is_own_image = mirrors_[i].image == static_cast<int>(i);
    const Piece* finer = &pieces_[i];
    const PieceMirror* mirror = &mirrors_[i];
    // Coarse seams are shorter than those that they become, so that a limit of the length could not be kept.
    if (std::isfinite(options_.max_length)) return;
    filled_[i] = fill_small_holes(pieces_[i], static_cast<int>(i), mirrors_[i]);
    if (filled_[i]) {
      finer = &filled_[i]->piece;
      mirror = &filled_[i]->mirror;
    }
    int n = n_vertices(i);
    while (n > coarse_vertices) {
      n = n / level_ratio > 2 * coarse_vertices ? n / level_ratio : coarse_vertices;
      std::vector<signed char> side;
      std::vector<double> preference;
      for (const int v : finer->vertices) {
        if (is_own_image) side.push_back(symmetry_.side[v]);
        if (options_.vertex_preference != nullptr) preference.push_back(options_.vertex_preference[mesh_vertices_[v]]);
      }
      levels_[i].push_back(std::make_unique<CoarsePiece>(
          coarse_piece(*finer, static_cast<int>(i), *mirror, side, preference, n, quiet())));
      finer = &levels_[i].back()->piece;
      mirror = &levels_[i].back()->mirror;
    }
  }
  /// The coarsest level that is left, without seams.
  PieceSeams unseamed(std::size_t i) const {
    return levels_[i].empty() ? priced(pieces_[i], i, mirrors_[i])
                              : priced(levels_[i].back()->piece, i, levels_[i].back()->mirror);
  }
  /// Without seams yet.
  PieceSeams priced(const Piece& piece, std::size_t i, const PieceMirror& mirror) const {
    PieceSeams seams(piece, static_cast<int>(i), mirror, symmetry_);
    std::vector<int> given_vertices;
    given_vertices.reserve(piece.vertices.size());
    for (const int v : piece.vertices) given_vertices.push_back(mesh_vertices_[static_cast<std::size_t>(v)]);
    seams.scale_costs(cost_factors(options_, seams.graph(), given_vertices));
    return seams;
  }
  /// Goes on with the next finer level, cut as the one before.
  void refine(std::size_t i) {
    const std::unique_ptr<CoarsePiece> coarse = std::move(levels_[i].back());
    levels_[i].pop_back();
    const bool was_filled = levels_[i].empty() && filled_[i];
    PieceSeams seams = was_filled ? priced(filled_[i]->piece, i, filled_[i]->mirror) : unseamed(i);
    std::vector<SeamEdges> cuts;
    for (const auto& [piece, cut] : cuts_) {
      if (piece == i) cuts.push_back(cut);
    }
    length_left_ += copies(i) * cutters_[i]->seams().length(cutters_[i]->seams().edges());
    std::vector<SeamEdges> carried = carry_seams(*coarse, cutters_[i]->seams(), cuts, seams);
    if (was_filled) {
      seams = with_holes(i, seams, carried);
      filled_[i].reset();
    }
    length_left_ -= copies(i) * seams.length(seams.edges());
    auto next = carried.begin();
    for (auto& [piece, cut] : cuts_) {
      if (piece == i) cut = *next++;
    }
    cutters_[i] = cutter(i, std::move(seams), true);
    cutters_[i]->solve(quiet());
  }
  /// The seams of a filled piece on the piece itself, whose edges have the same numbers. Those around holes are left
  /// out.
  PieceSeams with_holes(std::size_t i, const PieceSeams& filled, std::vector<SeamEdges>& cuts) const {
    PieceSeams seams = unseamed(i);
    if (!filled.is_symmetric()) seams.forget_symmetry();
    for (SeamEdges& cut : cuts) {
      cut.erase(std::remove_if(cut.begin(), cut.end(), [&](int edge) { return seams.graph().edges()[edge].cut; }),
                cut.end());
      seams.add(cut);
    }
    return seams;
  }
  /// Solves report that they go on, not how far they are; the fraction done only rises.
  Progress quiet() const {
    return [this](double, const char*) { return !progress_ || progress_(1 - 0.95 / (1 + 0.1 * steps_), "seams"); };
  }
  int copies(std::size_t piece) const {
    return mirrors_[piece].image >= 0 && mirrors_[piece].image != static_cast<int>(piece) ? 2 : 1;
  }
  int most_urgent(const std::vector<int>& steps) const {
    const auto urgency = [&](int i) {
      const MapQuality& quality = cutters_[i]->quality();
      return quality.solved ? quality.distortion() * quality.area : quality.distortion();
    };
    int best = -1;
    for (int i = 0; i < static_cast<int>(cutters_.size()); ++i) {
      if (!cutters_[i] || cutters_[i]->finished() || steps[static_cast<std::size_t>(i)] >= max_steps) continue;
      if (best < 0 || urgency(i) > urgency(best)) best = i;
    }
    return best;
  }
  void add(std::size_t i, const PieceSeams& seams, SeamEdges cut) {
    if (cut.empty()) return;
    length_left_ -= copies(i) * seams.length(cut);
    cuts_.emplace_back(i, std::move(cut));
  }
  /// The cuts in the order in which they were found, without what was sewn up since.
  SeamSuggestion result() const {
    SeamSuggestion result;
    std::set<std::array<int, 2>> proposed;
    std::vector<std::set<int>> left(pieces_.size());
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      if (cutters_[i]) left[i].insert(cutters_[i]->seams().edges().begin(), cutters_[i]->seams().edges().end());
    }
    for (const auto& [i, cut] : cuts_) {
      const std::vector<int>& vertices = pieces_[i].vertices;
      for (int copy = 0; copy < copies(i); ++copy) {
        for (const int e : cut) {
          if (left[i].count(e) == 0) continue;
          auto [a, b] = cutters_[i]->seams().graph().edges()[e].vertices;
          a = mesh_vertices_[copy == 0 ? vertices[a] : symmetry_.vertex[vertices[a]]];
          b = mesh_vertices_[copy == 0 ? vertices[b] : symmetry_.vertex[vertices[b]]];
          const std::array<int, 2> edge{std::min(a, b), std::max(a, b)};
          // Pieces that meet in an edge of three or more faces may both propose it.
          if (proposed.insert(edge).second) result.edges.push_back(edge);
        }
      }
      const int end = static_cast<int>(result.edges.size());
      if (end > result.cut_offsets.back()) result.cut_offsets.push_back(end);
    }
    return result;
  }

  const SeamSuggestionOptions& options_;
  SeamSuggestionOptions coarse_options_;
  const Progress& progress_;
  double length_left_;
  const std::vector<int>& mesh_vertices_;  ///< of the canonical ones
  int steps_ = 0;
  std::vector<Piece> pieces_;
  MirrorSymmetry symmetry_;
  std::vector<PieceMirror> mirrors_;
  std::vector<std::vector<std::unique_ptr<CoarsePiece>>>
      levels_;                                      ///< copies on which seams are still to be looked for, each coarser
  std::vector<std::optional<FilledPiece>> filled_;  ///< what the first of them is made from, where it has small holes
  std::vector<bool> began_on_copies_;
  std::vector<std::unique_ptr<Cutter>> cutters_;
  std::vector<std::pair<std::size_t, SeamEdges>> cuts_;  ///< with their pieces
};

}  // namespace

SeamSuggestion suggest_seams(const PolygonMesh& mesh, const SeamSuggestionOptions& options, const Progress& progress) {
  const CanonicalMesh canonical(mesh);
  return SeamFinder(canonical, options, progress).run();
}

}  // namespace spectral_conformal
