#include "seams/piece_cutter.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "quality/overlap.h"

namespace spectral_conformal {
namespace {

constexpr double enough_area = 0.95;
/// In the first rounds, extrema with at least this part of the volume of the largest are cut to together.
constexpr double together = 0.2;
/// A cut must lower the distortion by at least this part.
constexpr double least_gain = 0.002;
/// Overlaps of less than this part of the area are left to the user.
constexpr double negligible_overlap = 0.005;
/// A cut against overlaps must remove at least this part of them, and may raise the distortion by this factor.
constexpr double least_overlap_gain = 0.2;
constexpr double distortion_for_overlap = 1.05;
/// What a cut gains counts less by this factor where it makes an island.
constexpr double island_penalty = 0.4;
/// A cut is priced at its length and this fraction of the root of the area, what any cut costs: without it the gain for
/// a length favours ever shorter cuts.
constexpr double base_price = 0.25;
/// Of larger pieces, which have fine edges, no cut shorter than this part of the root of the area is tried.
constexpr double least_length = 0.05;
/// Cuts with this part of the best one's gain are made together with it.
constexpr double nearly_as_good = 0.4;
/// Of pieces up to this number of vertices every place is tried before giving up.
constexpr int small_piece = 3000;
constexpr int most_blind_cuts = 30;

/// The faces of each chart whose images cover others, as indices into the chart's faces, and their area.
struct Overlaps {
  std::vector<std::vector<int>> faces;
  double area = 0;

  explicit Overlaps(const std::vector<std::shared_ptr<const MappedChart>>& charts) {
    for (const auto& mapped : charts) {
      faces.push_back(mapped->solved ? overlapping_faces(mapped->chart, mapped->z) : std::vector<int>{});
      for (const int face : faces.back()) area += mapped->area[face];
    }
  }
};

int farthest_face(const SeparableFaces& faces, const std::vector<int>& among, int from) {
  const std::vector<double> distance = face_distances(faces, {from});
  return *std::max_element(among.begin(), among.end(), [&](int a, int b) {
    return std::isfinite(distance[b]) && (distance[a] < distance[b] || !std::isfinite(distance[a]));
  });
}

}  // namespace

PieceCutter::PieceCutter(PieceSeams seams, const SeamSuggestionOptions& options)
    : seams_(std::move(seams)), options_(options) {}

void PieceCutter::solve(const Progress& progress) {
  charts_ = map_charts({}, progress);
  quality_ = map_quality(charts_, options_.scale_limit);
}

SeamEdges PieceCutter::step(double longest, const Progress& progress) {
  SeamEdges accepted;
  if (!quality_.solved) {
    accepted = blind_cut();
    if (!accepted.empty()) solve(progress);
  } else {
    if (quality_.within_limit < enough_area) accepted = cut_to_all(longest, progress);
    if (accepted.empty()) accepted = cut_between_overlaps(longest, progress);
    if (accepted.empty() && !good_enough()) accepted = best_cut(longest, progress);
  }
  finished_ = accepted.empty();
  return accepted;
}

bool PieceCutter::good_enough() const {
  return quality_.within_limit >= enough_area && quality_.mean_qc <= options_.qc_limit;
}

PieceCutter::MappedCharts PieceCutter::map_charts(const SeamEdges& more, const Progress& progress) const {
  PolygonMesh mesh = seams_.piece().view();
  const std::vector<std::array<int, 2>> seams = seams_.with(more);
  mesh.seam_edges = seams.data();
  mesh.n_seam_edges = static_cast<int>(seams.size());
  ChartDecomposition decomposition = build_charts(mesh);
  MappedCharts result;
  for (Chart& chart : decomposition.charts) {
    // Every cut makes copies of vertices or loops: a chart with as many of both is the same.
    const auto known = std::find_if(charts_.begin(), charts_.end(), [&](const auto& old) {
      return old->chart.faces == chart.faces && old->chart.vertices == chart.vertices &&
             old->chart.boundary_loops.size() == chart.boundary_loops.size();
    });
    if (known != charts_.end()) {
      result.push_back(*known);
    } else {
      result.push_back(std::make_shared<const MappedChart>(map_chart(mesh, std::move(chart), options_.map, progress)));
    }
  }
  return result;
}

/// Per face of the piece, the index of its chart.
std::vector<int> PieceCutter::chart_of_face() const {
  std::vector<int> result(static_cast<std::size_t>(seams_.piece().n_faces()), -1);
  for (std::size_t i = 0; i < charts_.size(); ++i) {
    for (const int face : charts_[i]->chart.faces) result[face] = static_cast<int>(i);
  }
  return result;
}

/// In falling order of volume; of mirrored places the one on the positive side, of mirrored charts the first.
std::vector<PieceCutter::Place> PieceCutter::places(Kind kind, const std::vector<int>& chart_of_face) const {
  const PolygonMesh mesh = seams_.piece().view();
  std::vector<Place> result;
  for (std::size_t i = 0; i < charts_.size(); ++i) {
    const int chart = static_cast<int>(i);
    if (!charts_[i]->solved || seams_.mirrored_chart(chart, chart_of_face) < chart) continue;
    const bool halved = seams_.self_mirrored(chart, chart_of_face);
    for (DistortedPlace place : kind == Kind::scale ? scale_extrema(mesh, *charts_[i], quality_.median_log2_scale)
                                                    : angle_peaks(mesh, *charts_[i])) {
      if (halved) place.vertex = seams_.on_positive_side(place.vertex);
      result.push_back({place, chart});
    }
  }
  std::stable_sort(result.begin(), result.end(), [](const Place& a, const Place& b) { return a.volume > b.volume; });
  std::set<int> known;
  result.erase(std::remove_if(result.begin(), result.end(),
                              [&](const Place& place) { return !known.insert(place.vertex).second; }),
               result.end());
  return result;
}

SeamEdges PieceCutter::cut_to(const Place& place, const std::vector<int>& chart_of_face) const {
  return seams_.cut_to(place.vertex, place.on_loop, place.chart, chart_of_face);
}

PieceCutter::Trial PieceCutter::attempt(SeamEdges cut, const Progress& progress) const {
  Trial trial;
  trial.charts = map_charts(cut, progress);
  trial.quality = map_quality(trial.charts, options_.scale_limit);
  trial.cut = std::move(cut);
  return trial;
}

bool PieceCutter::is_small() const { return seams_.graph().n_vertices() <= small_piece; }

bool PieceCutter::makes_islands(const Trial& trial) const { return trial.charts.size() > charts_.size(); }

double PieceCutter::price(const Trial& trial) const {
  return seams_.length(trial.cut) + base_price * std::sqrt(quality_.area);
}

SeamEdges PieceCutter::accept(Trial&& trial) {
  seams_.add(trial.cut);
  charts_ = std::move(trial.charts);
  quality_ = trial.quality;
  return std::move(trial.cut);
}

/// To all the places that matter at once: one solve instead of many.
SeamEdges PieceCutter::cut_to_all(double longest, const Progress& progress) {
  const std::vector<int> of_face = chart_of_face();
  const std::vector<Place> where = places(Kind::scale, of_face);
  if (where.size() < 2) return {};
  PieceSeams later = seams_;
  SeamEdges all;
  for (const Place& place : where) {
    if (place.volume < together * where.front().volume) break;
    const SeamEdges cut = later.cut_to(place.vertex, place.on_loop, place.chart, of_face);
    later.add(cut);
    all.insert(all.end(), cut.begin(), cut.end());
  }
  if (all.empty() || seams_.length(all) > longest) return {};
  Trial trial = attempt(std::move(all), progress);
  return gain(trial) > 0 && !makes_islands(trial) ? accept(std::move(trial)) : SeamEdges{};
}

double PieceCutter::gain(const Trial& trial) const {
  if (!trial.quality.solved) return 0;
  const double less = quality_.distortion() - trial.quality.distortion();
  if (less < least_gain * quality_.distortion()) return 0;
  return (makes_islands(trial) ? island_penalty : 1) * less / price(trial);
}

/// Of the cuts to the most distorted places, and around them, the one that gains most for its length.
SeamEdges PieceCutter::best_cut(double longest, const Progress& progress) {
  const std::vector<int> of_face = chart_of_face();
  std::vector<std::vector<Place>> wanted;
  if (quality_.within_limit < enough_area) wanted.push_back(places(Kind::scale, of_face));
  if (quality_.mean_qc > options_.qc_limit) wanted.push_back(places(Kind::angle, of_face));
  // Every trial solves a chart, so large pieces get fewer; the less distorted places only if the first do not help.
  const int n_vertices = seams_.graph().n_vertices();
  const auto most = static_cast<std::size_t>(std::clamp(40000 / std::max(1, n_vertices), 2, 6));
  const std::size_t groups = is_small() ? 50 : 4;
  for (std::size_t group = 0; group < groups; ++group) {
    std::vector<Trial> trials;
    for (const auto& list : wanted) {
      for (std::size_t i = group * most; i < std::min((group + 1) * most, list.size()); ++i) {
        try_cut(cut_to(list[i], of_face), false, longest, progress, trials);
      }
      if (group < list.size()) try_cut(cut_around(list[group], of_face), true, longest, progress, trials);
    }
    if (!trials.empty()) return accept_best(std::move(trials), longest, progress);
  }
  std::vector<Trial> trials;
  for (SeamEdges& cut : halves(of_face)) try_cut(std::move(cut), true, longest, progress, trials);
  return trials.empty() ? SeamEdges{} : accept_best(std::move(trials), longest, progress);
}

/// Solves with a cut, and adds it to the trials if that lowers the distortion.
void PieceCutter::try_cut(SeamEdges cut, bool islands_allowed, double longest, const Progress& progress,
                          std::vector<Trial>& trials) const {
  const double least = is_small() ? 0 : least_length * std::sqrt(quality_.area);
  if (cut.empty() || seams_.length(cut) > longest || seams_.length(cut) < least) return;
  Trial trial = attempt(std::move(cut), progress);
  if (gain(trial) > 0 && (islands_allowed || !makes_islands(trial))) trials.push_back(std::move(trial));
}

/// The best of several trials; of a large piece all that are nearly as good together, which saves solves.
SeamEdges PieceCutter::accept_best(std::vector<Trial>&& trials, double longest, const Progress& progress) {
  const auto best =
      std::max_element(trials.begin(), trials.end(), [&](const Trial& a, const Trial& b) { return gain(a) < gain(b); });
  if (is_small() || makes_islands(*best)) return accept(std::move(*best));
  SeamEdges all;
  for (const Trial& trial : trials) {
    if (makes_islands(trial) || gain(trial) < nearly_as_good * gain(*best)) continue;
    for (const int edge : trial.cut) {
      if (std::find(all.begin(), all.end(), edge) == all.end()) all.push_back(edge);
    }
  }
  if (all.size() > best->cut.size() && seams_.length(all) <= longest) {
    Trial trial = attempt(std::move(all), progress);
    if (!makes_islands(trial) && gain(trial) > nearly_as_good * gain(*best)) return accept(std::move(trial));
  }
  return accept(std::move(*best));
}

/// Cuts through the middle of the chart with most distortion.
std::vector<SeamEdges> PieceCutter::halves(const std::vector<int>& chart_of_face) const {
  int chart = -1;
  double most = 0;
  for (std::size_t i = 0; i < charts_.size(); ++i) {
    const MapQuality quality = map_quality({charts_[i]}, options_.scale_limit);
    if (quality.area * quality.distortion() <= most) continue;
    most = quality.area * quality.distortion();
    chart = static_cast<int>(i);
  }
  std::vector<SeamEdges> result;
  if (chart < 0 || charts_[chart]->chart.faces.size() < 2) return result;
  const SeparableFaces faces = separable(chart);
  const std::vector<int>& all = charts_[chart]->chart.faces;
  const int one = farthest_face(faces, all, all.front());
  const int two = farthest_face(faces, all, one);
  result.push_back(seams_.cut_apart(faces, {one}, {two}, chart, chart_of_face));
  if (seams_.self_mirrored(chart, chart_of_face)) result.push_back(seams_.cut_along_axis(faces));
  return result;
}

SeparableFaces PieceCutter::separable(int chart) const {
  const SeamPiece& piece = seams_.piece();
  const MappedChart& mapped = *charts_[chart];
  const auto n = static_cast<std::size_t>(piece.n_faces());
  SeparableFaces faces;
  faces.graph = &seams_.graph();
  faces.member.assign(n, 0);
  faces.area.assign(n, 0);
  faces.centre.assign(n, Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < mapped.chart.faces.size(); ++i) {
    const int face = mapped.chart.faces[i];
    faces.member[face] = 1;
    faces.area[face] = mapped.area[i];
    const int first = piece.face_offsets[face];
    const int last = piece.face_offsets[face + 1];
    for (int c = first; c < last; ++c) {
      faces.centre[face] += piece.positions.row(piece.corner_vertices[c]).transpose() / (last - first);
    }
  }
  return faces;
}

/// Makes an island of the distorted surroundings of a place.
SeamEdges PieceCutter::cut_around(const Place& place, const std::vector<int>& chart_of_face) const {
  const SeamPiece& piece = seams_.piece();
  const MappedChart& mapped = *charts_[place.chart];
  const auto offset = [&](std::size_t i) { return mapped.log2_scale[i] - quality_.median_log2_scale; };
  std::vector<int> sources;
  double sign = 0;
  for (std::size_t i = 0; i < mapped.chart.faces.size(); ++i) {
    const int face = mapped.chart.faces[i];
    const auto first = piece.corner_vertices.begin() + piece.face_offsets[face];
    const auto last = piece.corner_vertices.begin() + piece.face_offsets[face + 1];
    if (std::find(first, last, place.vertex) == last) continue;
    sources.push_back(face);
    sign += offset(i);
  }
  std::vector<int> sinks;
  for (std::size_t i = 0; i < mapped.chart.faces.size(); ++i) {
    const int face = mapped.chart.faces[i];
    const bool near = std::find(sources.begin(), sources.end(), face) != sources.end();
    if (sign * offset(i) <= 0 && !near) sinks.push_back(face);
  }
  if (sources.empty() || sinks.empty()) return {};
  return seams_.cut_apart(separable(place.chart), sources, sinks, place.chart, chart_of_face);
}

/// Cuts that may part the sheets of a map that lie on each other.
std::vector<SeamEdges> PieceCutter::cuts_between(int chart, const std::vector<int>& overlapping,
                                                 const std::vector<int>& chart_of_face) const {
  const SeparableFaces faces = separable(chart);
  std::vector<int> covering;
  covering.reserve(overlapping.size());
  for (const int face : overlapping) covering.push_back(charts_[chart]->chart.faces[face]);
  const auto parts = connected_parts(faces, covering);
  std::vector<SeamEdges> result;
  const auto cut_apart = [&](const std::vector<int>& sources, const std::vector<int>& sinks) {
    result.push_back(seams_.cut_apart(faces, sources, sinks, chart, chart_of_face));
  };
  if (seams_.self_mirrored(chart, chart_of_face)) result.push_back(seams_.cut_along_axis(faces));
  constexpr std::size_t most_parts = 4;
  for (std::size_t i = 0; i < std::min(parts.size(), most_parts); ++i) {
    std::vector<int> others;
    for (std::size_t j = 0; j < parts.size(); ++j) {
      if (j != i) others.insert(others.end(), parts[j].begin(), parts[j].end());
    }
    if (!others.empty()) cut_apart(parts[i], others);
    // One part can cover itself: its ends are farthest apart.
    const int one = farthest_face(faces, parts[i], parts[i].front());
    const int two = farthest_face(faces, parts[i], one);
    if (one != two) cut_apart({one}, {two});
  }
  return result;
}

SeamEdges PieceCutter::cut_between_overlaps(double longest, const Progress& progress) {
  const Overlaps before(charts_);
  if (before.area < negligible_overlap * quality_.area) return {};
  const std::vector<int> of_face = chart_of_face();
  Trial best;
  double best_gain = 0;
  for (std::size_t i = 0; i < charts_.size(); ++i) {
    const int chart = static_cast<int>(i);
    if (before.faces[i].empty() || seams_.mirrored_chart(chart, of_face) < chart) continue;
    for (SeamEdges& cut : cuts_between(chart, before.faces[i], of_face)) {
      if (cut.empty() || seams_.length(cut) > longest) continue;
      Trial trial = attempt(std::move(cut), progress);
      const double highest = distortion_for_overlap * quality_.distortion();
      if (!trial.quality.solved || trial.quality.distortion() > highest) continue;
      const double removed = before.area - Overlaps(trial.charts).area;
      const double gain = removed / price(trial);
      if (removed < least_overlap_gain * before.area || gain <= best_gain) continue;
      best_gain = gain;
      best = std::move(trial);
    }
  }
  return best_gain > 0 ? accept(std::move(best)) : SeamEdges{};
}

/// Where there is no map to tell: from the vertex of an unsolved chart that is farthest from all cuts.
SeamEdges PieceCutter::blind_cut() {
  if (++blind_cuts_ > most_blind_cuts) return {};
  const std::vector<int> of_face = chart_of_face();
  std::vector<int> cut_vertices;
  for (const auto& edge : seams_.graph().edges()) {
    if (edge.cut) cut_vertices.insert(cut_vertices.end(), edge.vertices.begin(), edge.vertices.end());
  }
  const std::vector<double> distance = seams_.graph().distances(cut_vertices, [](int) { return true; });
  int vertex = -1;
  int chart = -1;
  for (std::size_t i = 0; i < charts_.size(); ++i) {
    if (charts_[i]->solved) continue;
    for (const int v : charts_[i]->chart.vertices) {
      if (!(distance[v] > 0) || !std::isfinite(distance[v])) continue;
      if (vertex >= 0 && distance[v] <= distance[vertex]) continue;
      vertex = v;
      chart = static_cast<int>(i);
    }
  }
  if (vertex < 0) return {};
  if (seams_.self_mirrored(chart, of_face)) vertex = seams_.on_positive_side(vertex);
  SeamEdges cut = seams_.cut_to(vertex, false, chart, of_face);
  seams_.add(cut);
  return cut;
}

}  // namespace spectral_conformal
