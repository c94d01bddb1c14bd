#include "seams/cut_candidates.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <set>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "concurrency/parallel_calls.h"
#include "geometry/polygon_normal.h"
#include "seams/faces_in_the_way.h"
#include "seams/separating_cut.h"

namespace spectral_conformal {
namespace {

/// The largest number of faces in a connected part that cut_out takes: flaps of one or two faces, and the faces under
/// them, at the ragged edges of scans. All parts of a chart together are crumbs (min_island). A torn scan of a million
/// faces got 678 islands; halving took longer and made 1727.
constexpr std::size_t max_flap = 50;

/// The results of independent searches, which run in parallel.
std::vector<SeamEdges> found_by(const std::vector<std::function<SeamEdges()>>& searches) {
  std::vector<SeamEdges> result(searches.size());
  run_in_parallel(
      static_cast<int>(searches.size()), [&](int i, const Progress&) { result[i] = searches[i](); }, {}, "seams");
  return result;
}

std::vector<int> all_of(const SeparableFaces& faces) {
  std::vector<int> result(faces.size());
  std::iota(result.begin(), result.end(), 0);
  return result;
}

int farthest_face(const SeparableFaces& faces, const std::vector<int>& among, int from) {
  const std::vector<double> distance = face_distances(faces, {from});
  return *std::max_element(among.begin(), among.end(), [&](int a, int b) {
    return std::isfinite(distance[b]) && (distance[a] < distance[b] || !std::isfinite(distance[a]));
  });
}

}  // namespace

CutCandidates::CutCandidates(const CutPiece& piece)
    : seams_(piece.seams()),
      charts_(piece.charts()),
      quality_(piece.quality()),
      chart_of_face_(piece.chart_of_face()),
      mutexes_(charts_.size()),
      separable_(charts_.size()) {}

bool CutCandidates::is_first_of_mirrored(int chart) const {
  return seams_.mirrored_chart(charts_[chart]->chart.faces.front(), chart_of_face_) >= chart;
}

bool CutCandidates::is_self_mirrored(int chart) const {
  return seams_.self_mirrored(charts_[chart]->chart.faces.front(), chart_of_face_);
}

const std::vector<CutCandidates::Region>& CutCandidates::regions(Kind kind) const {
  std::optional<std::vector<Region>>& result = regions_[kind == Kind::scale ? 0 : 1];
  if (!result) result = found_regions(kind);
  return *result;
}

std::vector<CutCandidates::Region> CutCandidates::found_regions(Kind kind) const {
  const PolygonMesh mesh = seams_.piece().view();
  std::vector<Region> result;
  for (std::size_t i = 0; i < charts_.size(); ++i) {
    const int chart = static_cast<int>(i);
    if (!charts_[i]->solved || !is_first_of_mirrored(chart)) continue;
    const bool halved = is_self_mirrored(chart);
    std::vector<DistortedRegion> of_chart;
    call_while_polling(steps_per_face * charts_[i]->chart.triangles.size(), [&] {
      of_chart = kind == Kind::scale ? scale_extrema(mesh, *charts_[i], quality_.median_log2_scale)
                                     : angle_peaks(mesh, *charts_[i]);
    });
    for (DistortedRegion region : of_chart) {
      if (halved) region.vertex = seams_.on_positive_side(region.vertex);
      result.push_back({region, chart});
    }
  }
  std::stable_sort(result.begin(), result.end(), [](const Region& a, const Region& b) { return a.volume > b.volume; });
  std::set<int> known;
  result.erase(std::remove_if(result.begin(), result.end(),
                              [&](const Region& region) { return !known.insert(region.vertex).second; }),
               result.end());
  return result;
}

SeamEdges CutCandidates::cut_to(const Region& region, const PieceSeams& seams) const {
  return seams.cut_to(region.vertex, region.on_loop, charts_[region.chart]->chart.faces.front(), chart_of_face_);
}

SeamEdges CutCandidates::loop_through(const Region& region, std::size_t which) const {
  return seams_.loop_through(region.vertex, which, charts_[region.chart]->chart.faces.front(), chart_of_face_);
}

SeamEdges CutCandidates::cut_around(const Region& region) const {
  const Piece& piece = seams_.piece();
  const TrialMap& mapped = *charts_[region.chart];
  const auto offset = [&](std::size_t i) { return mapped.log2_scale[i] - quality_.median_log2_scale; };
  std::vector<int> sources;
  double sign = 0;
  for (std::size_t i = 0; i < mapped.chart.faces.size(); ++i) {
    const int face = mapped.chart.faces[i];
    const auto first = piece.corner_vertices.begin() + piece.face_offsets[face];
    const auto last = piece.corner_vertices.begin() + piece.face_offsets[face + 1];
    if (std::find(first, last, region.vertex) == last) continue;
    sources.push_back(static_cast<int>(i));
    sign += offset(i);
  }
  std::vector<int> sinks;
  for (std::size_t i = 0; i < mapped.chart.faces.size(); ++i) {
    const auto face = static_cast<int>(i);
    const bool near = std::binary_search(sources.begin(), sources.end(), face);
    if (sign * offset(i) <= 0 && !near) sinks.push_back(face);
  }
  if (sources.empty() || sinks.empty()) return {};
  return seams_.cut_apart(separable(region.chart), sources, sinks, chart_of_face_);
}

std::vector<SeamEdges> CutCandidates::cuts_apart(int chart, const std::vector<int>& defective) const {
  const SeparableFaces& faces = separable(chart);
  const std::vector<int> all = all_of(faces);
  const std::vector<int> largest = connected_parts(faces, defective).front();
  std::vector<SeamEdges> result;
  result.push_back(halve(chart));
  if (largest.size() < all.size()) result.push_back(seams_.border(faces, largest));
  if (all.size() > 1) result.push_back(seams_.border(faces, {largest.front()}));
  return result;
}

std::vector<SeamEdges> CutCandidates::cuts_between(int chart, const std::vector<int>& defective) const {
  const SeparableFaces& faces = separable(chart);
  const auto parts = connected_parts(faces, defective);
  std::vector<std::function<SeamEdges()>> searches;
  // Each part costs two solves.
  for (std::size_t i = 0; i < std::min<std::size_t>(parts.size(), tries_at_once); ++i) {
    searches.emplace_back([&, i] {
      std::vector<int> others;
      for (std::size_t j = 0; j < parts.size(); ++j) {
        if (j != i) others.insert(others.end(), parts[j].begin(), parts[j].end());
      }
      return others.empty() ? SeamEdges{} : seams_.cut_apart(faces, parts[i], others, chart_of_face_);
    });
    // A part can overlap itself: cut between its farthest faces.
    searches.emplace_back([&, i] { return cut_between_ends(chart, parts[i]); });
  }
  return found_by(searches);
}

SeamEdges CutCandidates::cut_out(int chart, const std::vector<int>& defective) const {
  const SeparableFaces& faces = separable(chart);
  if (static_cast<double>(defective.size()) > min_island * static_cast<double>(faces.size())) return {};
  for (const std::vector<int>& part : connected_parts(faces, defective)) {
    if (part.size() > max_flap) return {};
  }
  return seams_.border(faces, faces_in_the_way(faces, *charts_[chart], defective));
}

std::vector<int> CutCandidates::most_distorted() const {
  std::vector<std::pair<double, int>> worst;
  for (std::size_t i = 0; i < charts_.size(); ++i) {
    if (!charts_[i]->solved || !is_first_of_mirrored(static_cast<int>(i))) continue;
    const MapQuality quality = map_quality({charts_[i]}, 2);  // any limit: within_limit is not used
    if (quality.distortion() > 0) worst.emplace_back(-quality.area * quality.distortion(), static_cast<int>(i));
  }
  std::sort(worst.begin(), worst.end());
  worst.resize(std::min<std::size_t>(worst.size(), tries_at_once));
  std::vector<int> result;
  for (const auto& [distortion, chart] : worst) {
    if (charts_[chart]->chart.faces.size() > 1) result.push_back(chart);
  }
  return result;
}

std::vector<SeamEdges> CutCandidates::halves(const std::vector<int>& charts) const {
  std::vector<std::function<SeamEdges()>> searches;
  searches.reserve(charts.size());
  for (const int chart : charts) searches.emplace_back([&, chart] { return halve(chart); });
  return found_by(searches);
}

SeamEdges CutCandidates::halve(int chart) const { return cut_between_ends(chart, all_of(separable(chart))); }

/// Separates two faces that are far apart among `some`.
SeamEdges CutCandidates::cut_between_ends(int chart, const std::vector<int>& some) const {
  const SeparableFaces& faces = separable(chart);
  const int one = farthest_face(faces, some, some.front());
  const int two = farthest_face(faces, some, one);
  return one == two ? SeamEdges{} : seams_.cut_apart(faces, {one}, {two}, chart_of_face_);
}

SeamEdges CutCandidates::halve_unsolved() const {
  std::vector<std::function<SeamEdges()>> searches;
  for (std::size_t i = 0; i < charts_.size(); ++i) {
    const int chart = static_cast<int>(i);
    if (!charts_[i]->solved && is_first_of_mirrored(chart)) searches.emplace_back([&, chart] { return halve(chart); });
  }
  SeamEdges all;
  for (const SeamEdges& cut : found_by(searches)) all.insert(all.end(), cut.begin(), cut.end());
  return all;
}

/// In an unsolved chart, areas are those of the polygons.
const SeparableFaces& CutCandidates::separable(int chart) const {
  const std::lock_guard<std::mutex> lock(mutexes_[chart]);
  std::unique_ptr<const SeparableFaces>& result = separable_[chart];
  if (result) return *result;
  const Piece& piece = seams_.piece();
  const TrialMap& mapped = *charts_[chart];
  std::vector<double> areas;
  if (mapped.solved) areas = mapped.area;
  std::vector<Eigen::Vector3d> centers;
  centers.reserve(mapped.chart.faces.size());
  for (const int face : mapped.chart.faces) {
    poll();
    const Positions corners = piece.corners(face);
    centers.emplace_back(corners.colwise().mean());
    if (!mapped.solved) areas.push_back(0.5 * polygon_normal(corners, corners.row(0).transpose()).norm());
  }
  result =
      std::make_unique<const SeparableFaces>(seams_.graph(), mapped.chart.faces, std::move(areas), std::move(centers));
  return *result;
}

}  // namespace spectral_conformal
