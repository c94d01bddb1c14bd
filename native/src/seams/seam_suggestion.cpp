#include "spectral_conformal/seam_suggestion.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "mesh/mirror_symmetry.h"
#include "seams/canonical_mesh.h"
#include "seams/cutter.h"
#include "seams/piece_seams.h"
#include "seams/pieces.h"

namespace spectral_conformal {
namespace {

/// Far above what any mesh took (at most 112 cuts on those of the tests): a bound, not a limit.
constexpr int max_steps = 300;

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
      : options_(options), progress_(progress), length_left_(options.max_length), mesh_vertices_(canonical.vertices()) {
    report(progress, 0.0, "charts");
    const PolygonMesh mesh = canonical.view();
    const ChartDecomposition decomposition = build_charts(mesh);
    pieces_ = split_into_pieces(mesh, decomposition);
    symmetry_ = find_mirror_symmetry(mesh);
    mirrors_ = mirror_pieces(mesh, decomposition, pieces_, symmetry_);
    cutters_.resize(pieces_.size());
  }

  SeamSuggestion run() {
    for (std::size_t i = 0; i < pieces_.size(); ++i) open(i);
    for (auto& cutter : cutters_) {
      if (cutter) cutter->solve(quiet());
    }
    for (steps_ = 1; steps_ <= max_steps; ++steps_) {
      const int next = most_urgent();
      if (next < 0) break;
      const auto i = static_cast<std::size_t>(next);
      add(i, cutters_[i]->seams(), cutters_[i]->step(length_left_ / copies(i), quiet()));
    }
    report(progress_, 1.0, "done");
    return std::move(result_);
  }

 private:
  /// What topology needs. The first of two mirrored pieces does the work for both.
  void open(std::size_t i) {
    const int image = mirrors_[i].image;
    if (!has_extent(pieces_[i]) || (image >= 0 && image < static_cast<int>(i))) return;
    report(progress_, 0.02, "seams");
    PieceSeams seams(pieces_[i], static_cast<int>(i), mirrors_[i], symmetry_);
    for (const SeamEdges& cut : seams.open()) add(i, seams, cut);
    cutters_[i] = std::make_unique<Cutter>(std::move(seams), options_);
  }
  /// Solves report that they go on, not how far they are; the fraction done only rises.
  Progress quiet() const {
    return [this](double, const char*) { return !progress_ || progress_(1 - 0.95 / (1 + 0.1 * steps_), "seams"); };
  }
  int copies(std::size_t piece) const {
    return mirrors_[piece].image >= 0 && mirrors_[piece].image != static_cast<int>(piece) ? 2 : 1;
  }
  int most_urgent() const {
    const auto urgency = [&](int i) {
      const MapQuality& quality = cutters_[i]->quality();
      return quality.solved ? quality.distortion() * quality.area : quality.distortion();
    };
    int best = -1;
    for (int i = 0; i < static_cast<int>(cutters_.size()); ++i) {
      if (!cutters_[i] || cutters_[i]->finished()) continue;
      if (best < 0 || urgency(i) > urgency(best)) best = i;
    }
    return best;
  }
  void add(std::size_t i, const PieceSeams& seams, const SeamEdges& cut) {
    if (cut.empty()) return;
    const std::vector<int>& vertices = pieces_[i].vertices;
    for (int copy = 0; copy < copies(i); ++copy) {
      for (const int e : cut) {
        auto [a, b] = seams.graph().edges()[e].vertices;
        a = copy == 0 ? vertices[a] : symmetry_.vertex[vertices[a]];
        b = copy == 0 ? vertices[b] : symmetry_.vertex[vertices[b]];
        a = mesh_vertices_[a];
        b = mesh_vertices_[b];
        const std::array<int, 2> edge{std::min(a, b), std::max(a, b)};
        // Pieces that meet in an edge of three or more faces may both propose it.
        if (proposed_.insert(edge).second) result_.edges.push_back(edge);
      }
    }
    const int end = static_cast<int>(result_.edges.size());
    if (end > result_.cut_offsets.back()) result_.cut_offsets.push_back(end);
    length_left_ -= copies(i) * seams.length(cut);
  }

  const SeamSuggestionOptions& options_;
  const Progress& progress_;
  double length_left_;
  const std::vector<int>& mesh_vertices_;  ///< of the canonical ones
  int steps_ = 0;
  std::vector<Piece> pieces_;
  MirrorSymmetry symmetry_;
  std::vector<PieceMirror> mirrors_;
  std::vector<std::unique_ptr<Cutter>> cutters_;
  std::set<std::array<int, 2>> proposed_;
  SeamSuggestion result_;
};

}  // namespace

SeamSuggestion suggest_seams(const PolygonMesh& mesh, const SeamSuggestionOptions& options, const Progress& progress) {
  const CanonicalMesh canonical(mesh);
  return SeamFinder(canonical, options, progress).run();
}

}  // namespace spectral_conformal
