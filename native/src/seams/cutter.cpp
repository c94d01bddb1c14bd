#include "seams/cutter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "quality/overlap.h"

namespace spectral_conformal {
namespace {

/// Fraction of the area within SeamSuggestionOptions::scale_limit, as documented there.
constexpr double enough_area = 0.95;
/// While the scale is beyond its limit, extrema with at least this fraction of the volume of the largest are cut to
/// together, for one solve instead of many: the limbs of a body, but not their fingers.
constexpr double together = 0.2;
/// A cut must lower the distortion by at least this fraction; less is not seen in a texture.
constexpr double min_gain = 0.002;
/// Overlaps of less than this fraction of the area are left to the user: each cut against them costs several solves.
constexpr double negligible_overlap = 0.005;
/// A cut against overlaps must remove at least this fraction of them, so that five suffice, and may raise the
/// distortion by this factor, about as much as one of the last cuts gains.
constexpr double min_overlap_gain = 0.2;
constexpr double distortion_for_overlap = 1.05;
/// What a cut gains counts less by this factor where it makes an island: artists prefer few.
constexpr double island_penalty = 0.4;
/// A cut is priced at its length and this fraction of the root of the area, what any cut costs: without it the gain for
/// a length favours ever shorter cuts.
constexpr double base_price = 0.25;
/// Of larger pieces, which have fine edges, no cut shorter than this fraction of the root of the area is tried: it
/// costs a solve and gains little.
constexpr double min_length = 0.05;
/// Cuts with this fraction of the best one's gain are made together with it; a trial of all of them confirms it.
constexpr double nearly_as_good = 0.4;
/// Of pieces up to this number of vertices every region is tried before giving up, of larger ones a few groups of them.
/// None and twice as many vertices both gave 4 % longer seams on 12 meshes.
constexpr int small_piece = 3000;
constexpr std::size_t all_groups = 50;  // of six regions each, as trial_vertices allows: a bound
constexpr std::size_t few_groups = 4;   // trials of as many vertices as trial_vertices each
/// Vertices that a round of trials solves for, which is 2 to 6 trials.
constexpr int trial_vertices = 40000;
/// A piece whose map fails is given up after this number of cuts.
constexpr int max_blind_cuts = 30;

/// The faces of each chart whose images cover others, as indices into the chart's faces, and their area.
struct Overlaps {
  std::vector<std::vector<int>> faces;
  double area = 0;

  explicit Overlaps(const TrialMaps& charts) {
    for (const auto& mapped : charts) {
      faces.push_back(mapped->solved ? overlapping_faces(mapped->chart, mapped->z) : std::vector<int>{});
      for (const int face : faces.back()) area += mapped->area[face];
    }
  }
};

}  // namespace

Cutter::Cutter(PieceSeams seams, const SeamSuggestionOptions& options) : seams_(std::move(seams)), options_(options) {}

void Cutter::solve(const Progress& progress) {
  charts_ = map_charts({}, progress);
  quality_ = map_quality(charts_, options_.scale_limit);
}

SeamEdges Cutter::step(double longest, const Progress& progress) {
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

bool Cutter::good_enough() const {
  return quality_.within_limit >= enough_area && quality_.mean_qc <= options_.qc_limit;
}

TrialMaps Cutter::map_charts(const SeamEdges& more, const Progress& progress) const {
  PolygonMesh mesh = seams_.piece().view();
  const std::vector<std::array<int, 2>> seams = seams_.with(more);
  mesh.seam_edges = seams.data();
  mesh.n_seam_edges = static_cast<int>(seams.size());
  ChartDecomposition decomposition = build_charts(mesh);
  TrialMaps result;
  for (Chart& chart : decomposition.charts) {
    // Every cut makes copies of vertices or loops: a chart with as many of both is the same.
    const auto known = std::find_if(charts_.begin(), charts_.end(), [&](const auto& old) {
      return old->chart.faces == chart.faces && old->chart.vertices == chart.vertices &&
             old->chart.boundary_loops.size() == chart.boundary_loops.size();
    });
    if (known != charts_.end()) {
      result.push_back(*known);
    } else {
      result.push_back(
          std::make_shared<const TrialMap>(solve_trial_map(mesh, std::move(chart), options_.map, progress)));
    }
  }
  return result;
}

Cutter::Trial Cutter::attempt(SeamEdges cut, const Progress& progress) const {
  Trial trial;
  trial.charts = map_charts(cut, progress);
  trial.quality = map_quality(trial.charts, options_.scale_limit);
  trial.cut = std::move(cut);
  return trial;
}

bool Cutter::is_small() const { return seams_.graph().n_vertices() <= small_piece; }

bool Cutter::makes_islands(const Trial& trial) const { return trial.charts.size() > charts_.size(); }

double Cutter::price(const Trial& trial) const {
  return seams_.length(trial.cut) + base_price * std::sqrt(quality_.area);
}

SeamEdges Cutter::accept(Trial&& trial) {
  seams_.add(trial.cut);
  charts_ = std::move(trial.charts);
  quality_ = trial.quality;
  return std::move(trial.cut);
}

/// To all the regions that matter at once: one solve instead of many.
SeamEdges Cutter::cut_to_all(double longest, const Progress& progress) {
  const CutCandidates candidates = this->candidates();
  const std::vector<CutCandidates::Region> where = candidates.regions(CutCandidates::Kind::scale);
  if (where.size() < 2) return {};
  PieceSeams later = seams_;
  SeamEdges all;
  for (const auto& region : where) {
    if (region.volume < together * where.front().volume) break;
    const SeamEdges cut = candidates.cut_to(region, later);
    later.add(cut);
    all.insert(all.end(), cut.begin(), cut.end());
  }
  if (all.empty() || seams_.length(all) > longest) return {};
  Trial trial = attempt(std::move(all), progress);
  return gain(trial) > 0 && !makes_islands(trial) ? accept(std::move(trial)) : SeamEdges{};
}

double Cutter::gain(const Trial& trial) const {
  if (!trial.quality.solved) return 0;
  const double less = quality_.distortion() - trial.quality.distortion();
  if (less < min_gain * quality_.distortion()) return 0;
  return (makes_islands(trial) ? island_penalty : 1) * less / price(trial);
}

/// Of the cuts to the most distorted regions, and around them, the one that gains most for its length.
SeamEdges Cutter::best_cut(double longest, const Progress& progress) {
  const CutCandidates candidates = this->candidates();
  std::vector<std::vector<CutCandidates::Region>> wanted;
  if (quality_.within_limit < enough_area) wanted.push_back(candidates.regions(CutCandidates::Kind::scale));
  if (quality_.mean_qc > options_.qc_limit) wanted.push_back(candidates.regions(CutCandidates::Kind::angle));
  // Every trial solves a chart, so large pieces get fewer; the less distorted regions only if the first do not help.
  const int n_vertices = seams_.graph().n_vertices();
  const auto most = static_cast<std::size_t>(std::clamp(trial_vertices / std::max(1, n_vertices), 2, 6));
  const std::size_t groups = is_small() ? all_groups : few_groups;
  for (std::size_t group = 0; group < groups; ++group) {
    std::vector<Trial> trials;
    for (const auto& list : wanted) {
      for (std::size_t i = group * most; i < std::min((group + 1) * most, list.size()); ++i) {
        try_cut(candidates.cut_to(list[i], seams_), false, longest, progress, trials);
      }
      if (group < list.size()) try_cut(candidates.cut_around(list[group]), true, longest, progress, trials);
    }
    if (!trials.empty()) return accept_best(std::move(trials), longest, progress);
  }
  std::vector<Trial> trials;
  for (SeamEdges& cut : candidates.halves()) try_cut(std::move(cut), true, longest, progress, trials);
  return trials.empty() ? SeamEdges{} : accept_best(std::move(trials), longest, progress);
}

/// Solves with a cut, and adds it to the trials if that lowers the distortion.
void Cutter::try_cut(SeamEdges cut, bool islands_allowed, double longest, const Progress& progress,
                     std::vector<Trial>& trials) const {
  const double least = is_small() ? 0 : min_length * std::sqrt(quality_.area);
  if (cut.empty() || seams_.length(cut) > longest || seams_.length(cut) < least) return;
  Trial trial = attempt(std::move(cut), progress);
  if (gain(trial) > 0 && (islands_allowed || !makes_islands(trial))) trials.push_back(std::move(trial));
}

/// The best of several trials; of a large piece all that are nearly as good together, which saves solves.
SeamEdges Cutter::accept_best(std::vector<Trial>&& trials, double longest, const Progress& progress) {
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

SeamEdges Cutter::cut_between_overlaps(double longest, const Progress& progress) {
  const Overlaps before(charts_);
  if (before.area < negligible_overlap * quality_.area) return {};
  const CutCandidates candidates = this->candidates();
  Trial best;
  double best_gain = 0;
  for (std::size_t i = 0; i < charts_.size(); ++i) {
    const int chart = static_cast<int>(i);
    if (before.faces[i].empty() || !candidates.is_first_of_mirrored(chart)) continue;
    for (SeamEdges& cut : candidates.cuts_between(chart, before.faces[i])) {
      if (cut.empty() || seams_.length(cut) > longest) continue;
      Trial trial = attempt(std::move(cut), progress);
      const double highest = distortion_for_overlap * quality_.distortion();
      if (!trial.quality.solved || trial.quality.distortion() > highest) continue;
      const double removed = before.area - Overlaps(trial.charts).area;
      const double gain = removed / price(trial);
      if (removed < min_overlap_gain * before.area || gain <= best_gain) continue;
      best_gain = gain;
      best = std::move(trial);
    }
  }
  return best_gain > 0 ? accept(std::move(best)) : SeamEdges{};
}

/// Where there is no map to tell what to cut.
SeamEdges Cutter::blind_cut() {
  if (++blind_cuts_ > max_blind_cuts) return {};
  SeamEdges cut = candidates().blind_cut();
  seams_.add(cut);
  return cut;
}

}  // namespace spectral_conformal
