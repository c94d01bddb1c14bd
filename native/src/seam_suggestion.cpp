#include "spectral_conformal/seam_suggestion.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <utility>

#include "spectral_conformal/boundary_loops.h"
#include "spectral_conformal/cut_graph.h"
#include "spectral_conformal/errors.h"
#include "spectral_conformal/field_extrema.h"
#include "spectral_conformal/mapped_chart.h"
#include "spectral_conformal/mirror_symmetry.h"
#include "spectral_conformal/seam_graph.h"
#include "spectral_conformal/seam_piece.h"
#include "spectral_conformal/separating_cut.h"

namespace spectral_conformal {
namespace {

constexpr double enough_area = 0.95;
/// Extrema of the scale that are less prominent than this, as log2, are left alone.
constexpr double least_prominence = 0.25;
/// In the first rounds, extrema with at least this part of the volume of the largest are cut to together.
constexpr double together = 0.2;
/// A cut must lower the distortion by at least this part.
constexpr double least_gain = 0.002;
/// Overlaps of less than this part of the area are left to the user.
constexpr double negligible_overlap = 0.005;
/// A cut against overlaps must remove at least this part of them, and may raise the distortion by this factor.
constexpr double least_overlap_gain = 0.2;
constexpr double distortion_for_overlap = 1.05;
/// No island gets less than this part of the area of the chart that it is cut from.
constexpr double least_island = 0.02;
/// What a cut gains counts less by this factor where it makes an island.
constexpr double island_penalty = 0.4;
/// Edges of the mirror plane are where artists look for seams first.
constexpr double axis_discount = 0.7;
/// Cuts shorter than this part of the root of the area gain as if they were as long.
constexpr double short_cut = 0.25;
constexpr int most_steps = 200;
constexpr int most_blind_cuts = 30;

using Edges = std::vector<int>;
using MappedCharts = std::vector<std::shared_ptr<const MappedChart>>;

/// A place to cut to: a vertex of the piece in one of its charts.
struct Place {
  int vertex;
  int chart;
  bool on_loop;  ///< of a hole, which is then joined to another loop
  double volume;
};

/// Proposes the cuts of one piece, and with it of its mirror image.
class PieceCutter {
 public:
  PieceCutter(const SeamPiece& piece, PieceMirror mirror, bool own_image, const MirrorSymmetry& symmetry,
              const SeamSuggestionOptions& options)
      : piece_(piece), graph_(piece.view()), mirror_(std::move(mirror)), own_image_(own_image), options_(options) {
    side_.resize(piece.vertices.size(), 0);
    if (!own_image_) return;
    for (std::size_t v = 0; v < side_.size(); ++v) side_[v] = symmetry.side[piece.vertices[v]];
    for (int e = 0; e < n_edges(); ++e) {
      if (on_axis(graph_.edges()[e].vertices[0]) && on_axis(graph_.edges()[e].vertices[1])) {
        graph_.scale_cost(e, axis_discount);
      }
    }
  }

  /// Cuts that make every chart a disk with or without holes.
  std::vector<Edges> open() {
    std::vector<Edges> cuts = handle_cuts(piece_.view(), graph_, [&](int edge) { return mirror_edge(edge); });
    for (const Edges& cut : cuts) mark(cut);
    if (std::none_of(graph_.edges().begin(), graph_.edges().end(), [](const auto& edge) { return edge.cut; })) {
      cuts.push_back(first_slit());
      mark(cuts.back());
    }
    const Edges bridge = symmetric_outer_loop();
    if (!bridge.empty()) {
      cuts.push_back(bridge);
      mark(bridge);
    }
    return cuts;
  }

  void solve(const Progress& progress) {
    charts_ = map_charts(cut_edges_, progress);
    quality_ = map_quality(charts_, options_.scale_limit);
  }

  bool finished() const { return finished_; }
  bool solved() const { return quality_.solved; }
  /// What is to be gained here, for choosing the next piece.
  double urgency() const { return quality_.solved ? quality_.distortion() * quality_.area : 1e300; }

  /// The next cut that lowers the distortion, or overlaps, and is not longer than `longest`; empty, and finished(),
  /// where there is none.
  Edges step(double longest, const Progress& progress) {
    Edges accepted;
    if (!quality_.solved) {
      accepted = blind_cut();
      if (!accepted.empty()) solve(progress);
    } else {
      if (quality_.within_limit < enough_area) accepted = cut_to_all(longest, progress);
      if (accepted.empty()) accepted = cut_between_overlaps(longest, progress);
      if (accepted.empty() && !good_enough(quality_)) accepted = best_cut(longest, progress);
    }
    if (accepted.empty()) finished_ = true;
    return accepted;
  }

  double length(const Edges& edges) const {
    double sum = 0;
    for (const int edge : edges) sum += graph_.edges()[edge].length;
    return sum;
  }
  const SeamGraph& graph() const { return graph_; }

 private:
  int n_edges() const { return static_cast<int>(graph_.edges().size()); }
  bool good_enough(const MapQuality& quality) const {
    return quality.solved && quality.within_limit >= enough_area && quality.mean_qc <= options_.qc_limit;
  }
  bool on_axis(int vertex) const { return own_image_ && mirror_.vertex[vertex] == vertex; }
  int mirror_edge(int edge) const {
    if (!own_image_) return -1;
    const auto [a, b] = graph_.edges()[edge].vertices;
    return graph_.find_edge(mirror_.vertex[a], mirror_.vertex[b]);
  }
  /// The edges that are not cut yet, with their images, in the order of the path.
  Edges with_images(const Edges& path) const {
    Edges result;
    std::set<int> known;
    for (const int edge : path) {
      if (!graph_.edges()[edge].cut && known.insert(edge).second) result.push_back(edge);
    }
    if (!own_image_) return result;
    const std::size_t n = result.size();
    for (std::size_t i = 0; i < n; ++i) {
      const int image = mirror_edge(result[i]);
      if (image >= 0 && known.insert(image).second) result.push_back(image);
    }
    return result;
  }
  void mark(const Edges& cut) {
    for (const int edge : cut) {
      graph_.cut(edge);
      cut_edges_.push_back(edge);
    }
  }

  /// The slit that opens a surface without boundary: between vertices far apart, on the mirror plane if there is one.
  Edges first_slit() {
    const auto everywhere = [](int) { return true; };
    const auto axis_only = [&](int edge) {
      return on_axis(graph_.edges()[edge].vertices[0]) && on_axis(graph_.edges()[edge].vertices[1]);
    };
    bool along_axis = false;
    for (int e = 0; e < n_edges() && !along_axis; ++e) along_axis = axis_only(e);
    if (!along_axis) own_image_ = false;
    const auto farthest_from = [&](int source) {
      const std::vector<double> distance =
          along_axis ? graph_.distances({source}, axis_only) : graph_.distances({source}, everywhere);
      int farthest = source;
      for (int v = 0; v < graph_.n_vertices(); ++v) {
        if (std::isfinite(distance[v]) && distance[v] > distance[farthest]) farthest = v;
      }
      return farthest;
    };
    int start = graph_.edges().front().vertices[0];
    for (int e = 0; along_axis && e < n_edges(); ++e) {
      if (axis_only(e)) start = graph_.edges()[e].vertices[0];
    }
    const int one = farthest_from(start);
    std::vector<char> target(static_cast<std::size_t>(graph_.n_vertices()), 0);
    target[farthest_from(one)] = 1;
    return graph_.path(one, target, [&](int edge, int) { return !along_axis || axis_only(edge); });
  }

  /// Where the longest loop is one of a mirrored pair, the map of a symmetric surface is not symmetric: joins the two.
  Edges symmetric_outer_loop() const {
    if (!own_image_) return {};
    PolygonMesh mesh = piece_.view();
    const std::vector<std::array<int, 2>> seams = seams_with(cut_edges_);
    mesh.seam_edges = seams.data();
    mesh.n_seam_edges = static_cast<int>(seams.size());
    const ChartDecomposition decomposition = build_charts(mesh);
    const Chart& chart = decomposition.charts.front();
    if (chart.boundary_loops.size() < 2) return {};
    const int outer = outer_loop(chart.boundary_loops, chart.positions(mesh));
    std::set<int> loop;
    for (const int v : chart.boundary_loops[static_cast<std::size_t>(outer)]) loop.insert(chart.vertices[v]);
    int start = *loop.begin();
    if (loop.count(mirror_.vertex[start]) > 0) return {};
    if (side_[start] < 0) start = mirror_.vertex[start];
    std::vector<char> axis(static_cast<std::size_t>(graph_.n_vertices()), 0);
    for (int v = 0; v < graph_.n_vertices(); ++v) axis[v] = on_axis(v) ? 1 : 0;
    return with_images(graph_.path(start, axis, [&](int e, int from) {
      const auto& ends = graph_.edges()[e].vertices;
      return side_[ends[0] == from ? ends[1] : ends[0]] >= 0;
    }));
  }

  std::vector<std::array<int, 2>> seams_with(const Edges& cuts) const {
    std::vector<std::array<int, 2>> seams = piece_.seams;
    for (const int edge : cuts) seams.push_back(graph_.edges()[edge].vertices);
    return seams;
  }

  MappedCharts map_charts(const Edges& cuts, const Progress& progress) const {
    PolygonMesh mesh = piece_.view();
    const std::vector<std::array<int, 2>> seams = seams_with(cuts);
    mesh.seam_edges = seams.data();
    mesh.n_seam_edges = static_cast<int>(seams.size());
    ChartDecomposition decomposition = build_charts(mesh);
    MappedCharts result;
    for (Chart& chart : decomposition.charts) {
      const auto known = std::find_if(charts_.begin(), charts_.end(), [&](const auto& old) {
        return old->chart.n_vertices() == chart.n_vertices() && old->chart.faces == chart.faces &&
               old->chart.boundary_loops.size() == chart.boundary_loops.size();
      });
      result.push_back(known != charts_.end() ? *known
                                              : std::make_shared<const MappedChart>(
                                                    map_chart(mesh, std::move(chart), options_.map, progress)));
    }
    return result;
  }

  /// Per face of the piece, the index of its chart.
  std::vector<int> chart_of_face() const {
    std::vector<int> result(static_cast<std::size_t>(piece_.n_faces()), -1);
    for (std::size_t i = 0; i < charts_.size(); ++i) {
      for (const int face : charts_[i]->chart.faces) result[face] = static_cast<int>(i);
    }
    return result;
  }

  /// Per vertex of a chart: 0 inside, 1 on the outer loop, 2 on another.
  std::vector<char> loop_of_vertex(const Chart& chart) const {
    std::vector<char> result(chart.vertices.size(), 0);
    const int outer = outer_loop(chart.boundary_loops, chart.positions(piece_.view()));
    for (std::size_t i = 0; i < chart.boundary_loops.size(); ++i) {
      for (const int v : chart.boundary_loops[i]) result[v] = static_cast<int>(i) == outer ? 1 : 2;
    }
    return result;
  }

  void scale_places(int index, std::vector<Place>& places) const {
    const MappedChart& mapped = *charts_[index];
    const Chart& chart = mapped.chart;
    std::vector<double> area(chart.vertices.size(), 0);
    std::vector<double> field(chart.vertices.size(), 0);
    for (std::size_t t = 0; t < chart.triangles.size(); ++t) {
      const int face = chart.triangle_face[t];
      const double share = chart.coverage[t] * mapped.area[face] + 1e-300;
      for (const int v : chart.triangles[t]) {
        area[v] += share;
        field[v] += share * mapped.log2_scale[face];
      }
    }
    for (std::size_t v = 0; v < field.size(); ++v) {
      field[v] = area[v] > 0 ? field[v] / area[v] - quality_.median_log2_scale : 0;
    }
    const std::vector<char> loop = loop_of_vertex(chart);
    for (const double sign : {1.0, -1.0}) {
      std::vector<double> signed_field = field;
      for (double& value : signed_field) value *= sign;
      for (const FieldMinimum& minimum : prominent_minima(signed_field, area, chart.triangles, 0, least_prominence)) {
        if (loop[minimum.vertex] == 1 || (loop[minimum.vertex] == 2 && sign < 0)) continue;
        places.push_back({chart.vertices[minimum.vertex], index, loop[minimum.vertex] == 2, minimum.volume});
      }
    }
  }

  /// Vertices whose faces have more QC in excess than those of their neighbours.
  void angle_places(int index, std::vector<Place>& places) const {
    const MappedChart& mapped = *charts_[index];
    const Chart& chart = mapped.chart;
    std::vector<double> excess(chart.vertices.size(), 0);
    for (std::size_t t = 0; t < chart.triangles.size(); ++t) {
      const int face = chart.triangle_face[t];
      for (const int v : chart.triangles[t]) excess[v] += chart.coverage[t] * mapped.area[face] * (mapped.qc[face] - 1);
    }
    std::vector<char> highest(chart.vertices.size(), 1);
    for (const auto& triangle : chart.triangles) {
      for (int k = 0; k < 3; ++k) {
        const int a = triangle[k];
        const int b = triangle[(k + 1) % 3];
        highest[excess[a] < excess[b] || (excess[a] == excess[b] && a > b) ? a : b] = 0;
      }
    }
    const std::vector<char> loop = loop_of_vertex(chart);
    for (int v = 0; v < chart.n_vertices(); ++v) {
      if (highest[v] != 0 && loop[v] != 1) places.push_back({chart.vertices[v], index, loop[v] == 2, excess[v]});
    }
  }

  /// Sorted by falling volume, of mirrored pairs the one on the positive side.
  void tidy(std::vector<Place>& places, const std::vector<int>& chart_of_face) const {
    for (Place& place : places) {
      if (own_image_ && side_[place.vertex] < 0 && self_mirrored(place.chart, chart_of_face)) {
        place.vertex = mirror_.vertex[place.vertex];
      }
    }
    std::stable_sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.volume > b.volume; });
    std::set<int> known;
    places.erase(std::remove_if(places.begin(), places.end(),
                                [&](const Place& place) { return !known.insert(place.vertex).second; }),
                 places.end());
  }

  bool self_mirrored(int chart, const std::vector<int>& chart_of_face) const {
    const int face = charts_[chart]->chart.faces.front();
    return own_image_ && chart_of_face[mirror_.face[face]] == chart;
  }

  /// The cut from a place to the nearest cut, or from a hole's loop to the nearest other one; with its mirror image.
  Edges cut_to(const Place& place, const std::vector<int>& chart_of_face) const {
    const bool halved = self_mirrored(place.chart, chart_of_face);
    std::vector<char> target(static_cast<std::size_t>(graph_.n_vertices()), 0);
    for (const auto& edge : graph_.edges()) {
      if (edge.cut) target[edge.vertices[0]] = target[edge.vertices[1]] = 1;
    }
    std::vector<char> own_loop(target.size(), 0);
    if (place.on_loop) {
      Edges reached;
      const std::vector<double> along =
          graph_.distances({place.vertex}, [&](int edge) { return graph_.edges()[edge].cut; });
      for (std::size_t v = 0; v < along.size(); ++v) {
        if (std::isfinite(along[v])) {
          own_loop[v] = 1;
          target[v] = 0;
        }
      }
    }
    const bool own_loop_halved = halved && place.on_loop && own_loop[mirror_.vertex[place.vertex]] != 0;
    const auto allowed = [&](int e, int from) {
      const auto& edge = graph_.edges()[e];
      const bool inside = std::any_of(edge.faces.begin(), edge.faces.end(),
                                      [&](int face) { return face >= 0 && chart_of_face[face] == place.chart; });
      if (!inside) return false;
      if (!halved || edge.cut) return true;
      const int to = edge.vertices[0] == from ? edge.vertices[1] : edge.vertices[0];
      // A path that leaves the mirror plane, or its own loop beside it, would enclose an island with its image.
      if (side_[to] < 0 || (on_axis(from) && !on_axis(to))) return false;
      return !(own_loop_halved && own_loop[from] != 0 && !on_axis(from));
    };
    return with_images(graph_.path(place.vertex, target, allowed));
  }

  /// Places in the charts that are solved; of two mirrored charts the first.
  std::vector<Place> places(bool of_scale, const std::vector<int>& chart_of_face) const {
    std::vector<Place> result;
    for (std::size_t i = 0; i < charts_.size(); ++i) {
      const MappedChart& mapped = *charts_[i];
      if (!mapped.solved) continue;
      if (own_image_ && chart_of_face[mirror_.face[mapped.chart.faces.front()]] < static_cast<int>(i)) continue;
      if (of_scale) {
        scale_places(static_cast<int>(i), result);
      } else {
        angle_places(static_cast<int>(i), result);
      }
    }
    tidy(result, chart_of_face);
    return result;
  }

  struct Trial {
    Edges cut;
    MappedCharts charts;
    MapQuality quality;
  };
  Trial attempt(Edges cut, const Progress& progress) const {
    Edges all = cut_edges_;
    all.insert(all.end(), cut.begin(), cut.end());
    Trial trial;
    trial.cut = std::move(cut);
    trial.charts = map_charts(all, progress);
    trial.quality = map_quality(trial.charts, options_.scale_limit);
    return trial;
  }
  bool improves(const Trial& trial) const {
    return trial.quality.solved && trial.quality.distortion() < (1 - least_gain) * quality_.distortion();
  }
  bool makes_islands(const Trial& trial) const { return trial.charts.size() > charts_.size(); }
  /// Relative to what a path across the whole surface would cost, so that a very short cut is not the best in any case.
  double price(const Trial& trial) const { return length(trial.cut) + short_cut * std::sqrt(quality_.area); }
  Edges accept(Trial&& trial) {
    mark(trial.cut);
    charts_ = std::move(trial.charts);
    quality_ = trial.quality;
    return std::move(trial.cut);
  }

  /// Cuts to all the places that matter at once.
  Edges cut_together(const std::vector<Place>& where, const std::vector<int>& chart_of_face) const {
    PieceCutter later(*this);
    Edges all;
    for (const Place& place : where) {
      if (place.volume < together * where.front().volume) break;
      const Edges cut = later.cut_to(place, chart_of_face);
      later.mark(cut);
      all.insert(all.end(), cut.begin(), cut.end());
    }
    return all;
  }

  Edges cut_to_all(double longest, const Progress& progress) {
    const std::vector<int> of_face = chart_of_face();
    const std::vector<Place> where = places(true, of_face);
    if (where.size() < 2) return {};
    const Edges all = cut_together(where, of_face);
    if (all.empty() || length(all) > longest) return {};
    Trial trial = attempt(all, progress);
    return improves(trial) && !makes_islands(trial) ? accept(std::move(trial)) : Edges{};
  }

  Edges best_cut(double longest, const Progress& progress) {
    const std::vector<int> of_face = chart_of_face();
    const std::vector<Place> by_scale = places(true, of_face);
    const std::vector<Place> by_angle = places(false, of_face);
    // Every trial solves a chart, so large pieces get fewer; the less distorted places only if the first do not help.
    const std::size_t most = static_cast<std::size_t>(std::clamp(40000 / std::max(1, graph_.n_vertices()), 2, 6));
    constexpr std::size_t groups = 4;
    for (std::size_t group = 0; group < groups; ++group) {
      Trial best;
      double best_gain = 0;
      const auto try_cut = [&](Edges cut, bool island) {
        if (cut.empty() || length(cut) > longest) return;
        Trial trial = attempt(std::move(cut), progress);
        if (!improves(trial) || makes_islands(trial) != island) return;
        const double gain =
            (island ? island_penalty : 1) * (quality_.distortion() - trial.quality.distortion()) / price(trial);
        if (gain <= best_gain) return;
        best_gain = gain;
        best = std::move(trial);
      };
      for (const auto* list : {&by_scale, &by_angle}) {
        for (std::size_t i = group * most; i < std::min((group + 1) * most, list->size()); ++i) {
          try_cut(cut_to((*list)[i], of_face), false);
        }
      }
      if (group < by_scale.size()) try_cut(cut_around(by_scale[group], of_face), true);
      if (best_gain > 0) return accept(std::move(best));
    }
    return {};
  }

  SeparableFaces separable(int chart) const {
    SeparableFaces faces;
    faces.graph = &graph_;
    const auto n = static_cast<std::size_t>(piece_.n_faces());
    faces.member.assign(n, 0);
    faces.area.assign(n, 0);
    faces.centre.assign(n, Eigen::Vector3d::Zero());
    const MappedChart& mapped = *charts_[chart];
    for (std::size_t i = 0; i < mapped.chart.faces.size(); ++i) {
      const int face = mapped.chart.faces[i];
      faces.member[face] = 1;
      faces.area[face] = mapped.area[i];
      const int first = piece_.face_offsets[face];
      const int last = piece_.face_offsets[face + 1];
      for (int c = first; c < last; ++c) {
        faces.centre[face] += piece_.positions.row(piece_.corner_vertices[c]).transpose() / (last - first);
      }
    }
    return faces;
  }

  /// A cut that parts the faces of a chart, with its mirror image; both islands keep clear of each other.
  Edges cut_apart(int chart, const SeparableFaces& faces, const std::vector<int>& sources,
                  const std::vector<int>& sinks, const std::vector<int>& chart_of_face) const {
    std::vector<char> side = separating_side(faces, sources, sinks, least_island);
    if (self_mirrored(chart, chart_of_face)) {
      double shared = 0;
      double own = 0;
      for (std::size_t f = 0; f < side.size(); ++f) {
        if (side[f] == 0) continue;
        own += faces.area[f];
        if (side[mirror_.face[f]] != 0) shared += faces.area[f];
      }
      const std::vector<char> whole = side;
      for (std::size_t f = 0; f < side.size(); ++f) {
        const bool both = whole[f] != 0 && whole[mirror_.face[f]] != 0;
        side[f] = 2 * shared > own ? both : whole[f] != 0 && !both;
      }
    }
    Edges cut;
    for (int e = 0; e < n_edges(); ++e) {
      const auto& edge = graph_.edges()[e];
      if (!edge.cut && faces.member[edge.faces[0]] != 0 && side[edge.faces[0]] != side[edge.faces[1]]) cut.push_back(e);
    }
    return with_images(cut);
  }

  /// Makes an island of the distorted surroundings of a place.
  Edges cut_around(const Place& place, const std::vector<int>& chart_of_face) const {
    const MappedChart& mapped = *charts_[place.chart];
    std::vector<int> sources;
    std::vector<int> sinks;
    double sign = 0;
    for (std::size_t i = 0; i < mapped.chart.faces.size(); ++i) {
      const int face = mapped.chart.faces[i];
      const auto first = piece_.corner_vertices.begin() + piece_.face_offsets[face];
      const auto last = piece_.corner_vertices.begin() + piece_.face_offsets[face + 1];
      if (std::find(first, last, place.vertex) == last) continue;
      sources.push_back(face);
      sign += mapped.log2_scale[i] - quality_.median_log2_scale;
    }
    const std::set<int> near(sources.begin(), sources.end());
    for (std::size_t i = 0; i < mapped.chart.faces.size(); ++i) {
      const double offset = mapped.log2_scale[i] - quality_.median_log2_scale;
      const int face = mapped.chart.faces[i];
      if (sign * offset <= 0 && near.count(face) == 0) sinks.push_back(face);
    }
    if (sources.empty() || sinks.empty()) return {};
    return cut_apart(place.chart, separable(place.chart), sources, sinks, chart_of_face);
  }

  /// The faces of the piece whose images cover others, chart by chart.
  static std::vector<std::vector<int>> overlaps(const MappedCharts& charts) {
    std::vector<std::vector<int>> result;
    for (const auto& mapped : charts) {
      result.push_back(overlapping_faces(*mapped));
    }
    return result;
  }
  static double overlapping_area(const MappedCharts& charts, const std::vector<std::vector<int>>& overlapping) {
    double area = 0;
    for (std::size_t i = 0; i < charts.size(); ++i) {
      for (const int face : overlapping[i]) area += charts[i]->area[face];
    }
    return area;
  }

  /// The connected parts of the overlapping faces of a chart, the largest first, as faces of the piece.
  std::vector<std::vector<int>> overlapping_parts(const SeparableFaces& faces, const MappedChart& mapped,
                                                  const std::vector<int>& overlapping) const {
    SeparableFaces only = faces;
    std::fill(only.member.begin(), only.member.end(), 0);
    for (const int face : overlapping) only.member[mapped.chart.faces[face]] = 1;
    std::vector<std::pair<double, std::vector<int>>> parts;
    for (const int index : overlapping) {
      const int seed = mapped.chart.faces[index];
      if (only.member[seed] == 0) continue;
      const std::vector<double> distance = face_distances(only, {seed});
      parts.emplace_back();
      for (std::size_t f = 0; f < distance.size(); ++f) {
        if (!std::isfinite(distance[f])) continue;
        parts.back().first -= faces.area[f];
        parts.back().second.push_back(static_cast<int>(f));
        only.member[f] = 0;
      }
    }
    std::sort(parts.begin(), parts.end());
    std::vector<std::vector<int>> result;
    for (auto& part : parts) result.push_back(std::move(part.second));
    return result;
  }

  /// Cuts that may part the sheets of a map that lie on each other.
  std::vector<Edges> cuts_between(int chart, const std::vector<int>& overlapping,
                                  const std::vector<int>& chart_of_face) const {
    std::vector<Edges> result;
    const SeparableFaces faces = separable(chart);
    if (self_mirrored(chart, chart_of_face)) {
      Edges axis;
      for (int e = 0; e < n_edges(); ++e) {
        const auto& edge = graph_.edges()[e];
        if (!edge.cut && on_axis(edge.vertices[0]) && on_axis(edge.vertices[1]) && faces.member[edge.faces[0]] != 0) {
          axis.push_back(e);
        }
      }
      result.push_back(std::move(axis));
    }
    const auto parts = overlapping_parts(faces, *charts_[chart], overlapping);
    constexpr std::size_t most_parts = 4;
    for (std::size_t i = 0; i < std::min(parts.size(), most_parts); ++i) {
      std::vector<int> others;
      for (std::size_t j = 0; j < parts.size(); ++j) {
        if (j != i) others.insert(others.end(), parts[j].begin(), parts[j].end());
      }
      if (!others.empty()) result.push_back(cut_apart(chart, faces, parts[i], others, chart_of_face));
      // One part can cover itself: its ends are farthest apart.
      const int one = farthest_face(faces, parts[i], parts[i].front());
      const int two = farthest_face(faces, parts[i], one);
      if (one != two) result.push_back(cut_apart(chart, faces, {one}, {two}, chart_of_face));
    }
    return result;
  }
  static int farthest_face(const SeparableFaces& faces, const std::vector<int>& among, int from) {
    const std::vector<double> distance = face_distances(faces, {from});
    return *std::max_element(among.begin(), among.end(), [&](int a, int b) { return distance[a] < distance[b]; });
  }

  Edges cut_between_overlaps(double longest, const Progress& progress) {
    const auto overlapping = overlaps(charts_);
    const double before = overlapping_area(charts_, overlapping);
    if (before < negligible_overlap * quality_.area) return {};
    const std::vector<int> of_face = chart_of_face();
    Trial best;
    double best_gain = 0;
    for (std::size_t i = 0; i < charts_.size(); ++i) {
      if (overlapping[i].empty()) continue;
      if (own_image_ && of_face[mirror_.face[charts_[i]->chart.faces.front()]] < static_cast<int>(i)) continue;
      for (Edges& cut : cuts_between(static_cast<int>(i), overlapping[i], of_face)) {
        if (cut.empty() || length(cut) > longest) continue;
        Trial trial = attempt(std::move(cut), progress);
        if (!trial.quality.solved || trial.quality.distortion() > distortion_for_overlap * quality_.distortion())
          continue;
        const double left = overlapping_area(trial.charts, overlaps(trial.charts));
        const double gain = (before - left) / price(trial);
        if (before - left < least_overlap_gain * before || gain <= best_gain) continue;
        best_gain = gain;
        best = std::move(trial);
      }
    }
    return best_gain > 0 ? accept(std::move(best)) : Edges{};
  }

  /// Where there is no map to tell: from the vertex of an unsolved chart that is farthest from its cuts.
  Edges blind_cut() {
    if (++blind_cuts_ > most_blind_cuts) return {};
    const std::vector<int> of_face = chart_of_face();
    std::vector<int> cut_vertices;
    for (const auto& edge : graph_.edges()) {
      if (edge.cut) cut_vertices.insert(cut_vertices.end(), edge.vertices.begin(), edge.vertices.end());
    }
    const std::vector<double> distance = graph_.distances(cut_vertices, [](int) { return true; });
    std::vector<Place> farthest;
    for (std::size_t i = 0; i < charts_.size(); ++i) {
      if (charts_[i]->solved) continue;
      for (const int v : charts_[i]->chart.vertices) {
        if (distance[v] > 0 && std::isfinite(distance[v]) &&
            (farthest.empty() || distance[v] > farthest.front().volume)) {
          farthest = {{v, static_cast<int>(i), false, distance[v]}};
        }
      }
    }
    if (farthest.empty()) return {};
    tidy(farthest, of_face);
    Edges cut = cut_to(farthest.front(), of_face);
    mark(cut);
    return cut;
  }

  const SeamPiece& piece_;
  SeamGraph graph_;
  PieceMirror mirror_;
  bool own_image_;  ///< cuts are made symmetric
  const SeamSuggestionOptions& options_;
  std::vector<signed char> side_;
  Edges cut_edges_;
  MappedCharts charts_;
  MapQuality quality_;
  bool finished_ = false;
  int blind_cuts_ = 0;
};

bool has_area(const SeamPiece& piece) {
  if (!piece.positions.allFinite() || piece.positions.rows() == 0) return false;
  const Eigen::RowVector3d low = piece.positions.colwise().minCoeff();
  const double extent = (piece.positions.colwise().maxCoeff() - low).maxCoeff();
  return extent > 0 && std::isfinite(extent);
}

/// The whole mesh: its pieces, the seams found so far, and what is left of the length that they may have.
class SeamFinder {
 public:
  SeamFinder(const PolygonMesh& mesh, const SeamSuggestionOptions& options, const Progress& progress)
      : options_(options), progress_(progress), length_left_(options.max_length) {
    report(progress, 0.0, "charts");
    const ChartDecomposition decomposition = build_charts(mesh);
    pieces_ = seam_pieces(mesh, decomposition);
    symmetry_ = find_mirror_symmetry(mesh);
    mirrors_ = mirror_pieces(mesh, decomposition, pieces_, symmetry_);
    cutters_.resize(pieces_.size());
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const int image = mirrors_[i].image;
      // The first of two mirrored pieces does the work for both.
      if (!has_area(pieces_[i]) || (image >= 0 && image < static_cast<int>(i))) continue;
      cutters_[i] =
          std::make_unique<PieceCutter>(pieces_[i], mirrors_[i], image == static_cast<int>(i), symmetry_, options_);
    }
  }

  SeamSuggestion run() {
    for (std::size_t i = 0; i < cutters_.size(); ++i) {
      if (!cutters_[i]) continue;
      report(progress_, 0.02, "seams");
      for (const Edges& cut : cutters_[i]->open()) add(i, cut);
    }
    for (auto& cutter : cutters_) {
      if (cutter) cutter->solve(quiet());
    }
    for (steps_ = 1; steps_ <= most_steps; ++steps_) {
      const int next = most_urgent();
      if (next < 0) break;
      const auto i = static_cast<std::size_t>(next);
      add(i, cutters_[i]->step(length_left_ / copies(i), quiet()));
    }
    report(progress_, 1.0, "done");
    return std::move(result_);
  }

 private:
  /// Solves report that they go on, not how far they are; the fraction done only rises.
  Progress quiet() const {
    return [this](double, const char*) { return !progress_ || progress_(1 - 0.95 / (1 + 0.1 * steps_), "seams"); };
  }
  double copies(std::size_t piece) const {
    return mirrors_[piece].image >= 0 && mirrors_[piece].image != static_cast<int>(piece) ? 2 : 1;
  }
  int most_urgent() const {
    int best = -1;
    for (std::size_t i = 0; i < cutters_.size(); ++i) {
      if (!cutters_[i] || cutters_[i]->finished()) continue;
      if (best < 0 || cutters_[i]->urgency() > cutters_[best]->urgency()) best = static_cast<int>(i);
    }
    return best;
  }
  void add(std::size_t piece, const Edges& cut) {
    if (cut.empty()) return;
    const auto add_edge = [&](int a, int b) { result_.edges.push_back({std::min(a, b), std::max(a, b)}); };
    for (const int e : cut) {
      const auto [a, b] = cutters_[piece]->graph().edges()[e].vertices;
      add_edge(pieces_[piece].vertices[a], pieces_[piece].vertices[b]);
    }
    if (copies(piece) > 1) {
      for (const int e : cut) {
        const auto [a, b] = cutters_[piece]->graph().edges()[e].vertices;
        add_edge(symmetry_.vertex[pieces_[piece].vertices[a]], symmetry_.vertex[pieces_[piece].vertices[b]]);
      }
    }
    result_.cut_offsets.push_back(static_cast<int>(result_.edges.size()));
    length_left_ -= copies(piece) * cutters_[piece]->length(cut);
  }

  const SeamSuggestionOptions& options_;
  const Progress& progress_;
  double length_left_;
  int steps_ = 0;
  std::vector<SeamPiece> pieces_;
  MirrorSymmetry symmetry_;
  std::vector<PieceMirror> mirrors_;
  std::vector<std::unique_ptr<PieceCutter>> cutters_;
  SeamSuggestion result_;
};

}  // namespace

SeamSuggestion suggest_seams(const PolygonMesh& mesh, const SeamSuggestionOptions& options, const Progress& progress) {
  return SeamFinder(mesh, options, progress).run();
}

}  // namespace spectral_conformal
