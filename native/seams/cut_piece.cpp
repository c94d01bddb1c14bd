#include "seams/cut_piece.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "concurrency/parallel_calls.h"
#include "graph/numbering.h"

namespace spectral_conformal {
namespace {

/// Some faces of a mesh as a mesh of its own: building their charts visits nothing else.
class FaceSubset {
 public:
  /// `faces`: ascending. The mesh must outlive this object.
  FaceSubset(const PolygonMesh& mesh, std::vector<int> faces) : mesh_(mesh), faces_(std::move(faces)) {
    if (is_whole()) return;
    std::vector<int> number(static_cast<std::size_t>(mesh.n_vertices), -1);
    for (const int face : faces_) {
      for (int c = mesh.face_offsets[face]; c < mesh.face_offsets[face + 1]; ++c) number[mesh.corner_vertices[c]] = 0;
    }
    vertices_ = number_marked(number);
    own_.positions = Eigen::Map<const Positions>(mesh.positions, mesh.n_vertices, 3)(vertices_, Eigen::all);
    for (const int face : faces_) {
      for (int c = mesh.face_offsets[face]; c < mesh.face_offsets[face + 1]; ++c) {
        own_.corner_vertices.push_back(number[mesh.corner_vertices[c]]);
      }
      own_.end_face();
    }
    for (int i = 0; i < mesh.n_seam_edges; ++i) {
      const auto [a, b] = mesh.seam_edges[i];
      if (number[a] >= 0 && number[b] >= 0) own_.seams.push_back({number[a], number[b]});
    }
  }

  /// Valid as long as this object. The vertices keep their order.
  PolygonMesh view() const { return is_whole() ? mesh_ : own_.view(); }
  void number_as_in_mesh(Chart& chart) const {
    if (is_whole()) return;
    for (std::vector<int>* numbers : {&chart.faces, &chart.duplicates}) {
      for (int& face : *numbers) face = faces_[face];
    }
    for (int& v : chart.vertices) v = vertices_[v];
  }

 private:
  bool is_whole() const { return static_cast<int>(faces_.size()) == mesh_.n_faces; }

  const PolygonMesh& mesh_;
  std::vector<int> faces_;
  std::vector<int> vertices_;
  OwnedMesh own_;
};

/// The root of a piece's share of the mesh's area, in single precision, so that rounding does not decide.
double size_in(double mesh_area, const Piece& piece) {
  const double area = piece.area();
  return area > 0 && mesh_area > area ? static_cast<float>(std::sqrt(area / mesh_area)) : 1;
}

}  // namespace

void try_in_parallel(std::size_t n, const std::function<void(int, const Progress&)>& work, const Progress& progress) {
  run_in_parallel(static_cast<int>(n), work, progress, "seams", tries_at_once);
}

CutPiece::CutPiece(PieceSeams seams, const SeamSuggestionOptions& options, double mesh_area)
    : seams_(std::move(seams)), options_(&options), functional_(options, size_in(mesh_area, seams_.piece())) {}

void CutPiece::rate_by(const SeamSuggestionOptions& options) {
  options_ = &options;
  functional_.set_options(options);
  quality_ = map_quality(charts_, options.scale_limit);
  value_ =
      functional_(seams_cost({}, {}) + functional_.beyond_sheet(charts_), open_rings({}, {}), charts_.size(), quality_);
  seams_value_ = value_ - functional_.distortion(quality_);
}

void CutPiece::rate_by(double sheet_side) {
  functional_.set_sheet_side(sheet_side);
  rate_by(*options_);
}

void CutPiece::rate_turns(double least) {
  seams_.set_least_turn(least);
  rate_by(*options_);
}

void CutPiece::count_rings() {
  counts_rings_ = true;
  rate_by(*options_);
}

void CutPiece::solve(const KnownMaps& known, const Progress& progress) { apply(attempt({}, {}, known, progress)); }

void CutPiece::allow_fallbacks(const Progress& progress) {
  has_fallbacks_ = true;
  KnownMaps solved;
  for (const auto& old : charts_) {
    if (old->solved) solved.insert(old);
  }
  charts_.clear();
  current_ = {};
  solve(solved, progress);
}

SeamTrial CutPiece::attempt(SeamEdges added, SeamEdges removed, const KnownMaps& known,
                            const Progress& progress) const {
  SeamTrial trial;
  trial.charts = map_charts(added, removed, known, progress);
  trial.quality = map_quality(trial.charts, options_->scale_limit);
  trial.value = functional_(seams_cost(added, removed) + functional_.beyond_sheet(trial.charts),
                            open_rings(added, removed), trial.charts.size(), trial.quality);
  trial.seams_value = trial.value - functional_.distortion(trial.quality);
  trial.added = std::move(added);
  trial.removed = std::move(removed);
  return trial;
}

std::vector<SeamTrial> CutPiece::attempt_all(const std::vector<std::array<SeamEdges, 2>>& added_and_removed,
                                             const KnownMaps& known, const Progress& progress) const {
  std::vector<SeamTrial> trials(added_and_removed.size());
  try_in_parallel(
      trials.size(),
      [&](int i, const Progress& own_progress) {
        const auto& [added, removed] = added_and_removed[i];
        trials[i] = attempt(added, removed, known, own_progress);
      },
      progress);
  return trials;
}

void CutPiece::apply(SeamTrial&& trial) {
  seams_.remove(trial.removed);
  seams_.add(trial.added);
  charts_ = std::move(trial.charts);
  current_ = KnownMaps(charts_.begin(), charts_.end());
  quality_ = trial.quality;
  value_ = trial.value;
  seams_value_ = trial.seams_value;
  squared_excess_.clear();
  if (quality_.solved) {
    for (const auto& mapped : charts_) squared_excess_.push_back(squared_excess(*mapped, quality_.median_log2_scale));
  }
  chart_of_face_.assign(static_cast<std::size_t>(seams_.piece().n_faces()), -1);
  for (std::size_t i = 0; i < charts_.size(); ++i) {
    for (const int face : charts_[i]->chart.faces) chart_of_face_[face] = static_cast<int>(i);
  }
}

double CutPiece::cost_of_island() const { return functional_.price_of_island() * std::sqrt(quality_.area); }

bool CutPiece::shortens(const SeamTrial& trial) const {
  return trial.quality.solved && trial.seams_value < seams_value_ &&
         functional_.beyond_limits(trial.quality) <= functional_.beyond_limits(quality_);
}

bool CutPiece::is_sound(const SeamTrial& trial) const {
  return std::all_of(trial.charts.begin(), trial.charts.end(), [&](const auto& mapped) {
    return is_current(mapped) || (mapped->solved && defective_faces(*mapped).empty());
  });
}

/// With the turns, after a change.
double CutPiece::seams_cost(const SeamEdges& added, const SeamEdges& removed) const {
  return seams_.cost(seams_.edges()) + seams_.cost(added) - seams_.cost(removed) + seams_.turning(added, removed);
}

double CutPiece::open_rings(const SeamEdges& added, const SeamEdges& removed) const {
  return counts_rings_ ? seams_.open_rings(added, removed) : 0;
}

double CutPiece::least_value(const SeamEdges& added, const SeamEdges& removed) const {
  return least_value(charts_beside(added, removed), added, removed);
}

double CutPiece::least_value(int chart) const {
  std::vector<char> is_changed(charts_.size(), 0);
  is_changed[chart] = 1;
  // The cut includes the mirror image's.
  is_changed[seams_.mirrored_chart(charts_[chart]->chart.faces.front(), chart_of_face_)] = 1;
  return least_value(is_changed, {}, {});
}

double CutPiece::least_value(const std::vector<char>& is_changed, const SeamEdges& added,
                             const SeamEdges& removed) const {
  MapQuality of_others;
  of_others.area = quality_.area;
  double squares = 0;
  double cost = seams_cost(added, removed);
  for (std::size_t i = 0; i < charts_.size(); ++i) {
    if (is_changed[i] != 0) continue;
    squares += squared_excess_[i];
    cost += functional_.beyond_sheet({charts_[i]});
  }
  if (quality_.area > 0) of_others.rms_excess = std::sqrt(squares / quality_.area);
  return functional_(cost, open_rings(added, removed), charts_.size(), of_others);
}

/// Per chart, whether changed edges lie in it or beside it.
std::vector<char> CutPiece::charts_beside(const SeamEdges& added, const SeamEdges& removed) const {
  std::vector<char> is_changed(charts_.size(), 0);
  for (const SeamEdges* edges : {&added, &removed}) {
    for (const int edge : *edges) {
      for (const int face : seams_.graph().edges()[edge].faces) {
        if (face >= 0 && chart_of_face_[face] >= 0) is_changed[chart_of_face_[face]] = 1;
      }
    }
  }
  return is_changed;
}

/// The faces of the charts beside the changed edges, ascending. Adds the other charts to `others`.
std::vector<int> CutPiece::faces_beside(const SeamEdges& added, const SeamEdges& removed, TrialMaps& others) const {
  std::vector<int> faces;
  if (charts_.empty()) {
    faces.resize(static_cast<std::size_t>(seams_.piece().n_faces()));
    std::iota(faces.begin(), faces.end(), 0);
    return faces;
  }
  const std::vector<char> is_changed = charts_beside(added, removed);
  for (std::size_t i = 0; i < charts_.size(); ++i) {
    if (is_changed[i] == 0) {
      others.push_back(charts_[i]);
    } else {
      faces.insert(faces.end(), charts_[i]->chart.faces.begin(), charts_[i]->chart.faces.end());
    }
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

/// Rebuilds only the charts beside the changed edges, and solves only those that are not known.
TrialMaps CutPiece::map_charts(const SeamEdges& added, const SeamEdges& removed, const KnownMaps& known,
                               const Progress& progress) const {
  const std::vector<std::array<int, 2>> seams = seams_.changed(added, removed);
  const PolygonMesh mesh = seams_.piece().view(seams);
  TrialMaps result;
  const FaceSubset changed_faces(mesh, faces_beside(added, removed, result));
  ChartDecomposition decomposition = build_charts(changed_faces.view());
  std::vector<Chart> unknown;
  for (Chart& chart : decomposition.charts) {
    changed_faces.number_as_in_mesh(chart);
    const ChartKey key(chart);
    auto same = current_.find(key);
    if (same == current_.end() && (same = known.find(key)) == known.end()) {
      solved_vertices_ += chart.n_vertices();
      unknown.push_back(std::move(chart));
    } else {
      result.push_back(*same);
    }
  }
  const std::size_t first = result.size();
  result.resize(first + unknown.size());
  try_in_parallel(
      unknown.size(),
      [&](int i, const Progress& own_progress) {
        const auto k = static_cast<std::size_t>(i);
        result[first + k] = std::make_shared<const TrialMap>(
            solve_trial_map(mesh, std::move(unknown[k]), options_->map, has_fallbacks_, own_progress));
      },
      progress);
  std::sort(result.begin(), result.end(),
            [](const auto& a, const auto& b) { return a->chart.faces.front() < b->chart.faces.front(); });
  return result;
}

}  // namespace spectral_conformal
