#include "seams/defect_parting.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <utility>

#include "concurrency/parallel_calls.h"

namespace spectral_conformal {
namespace {

double extent(const std::map<int, double>& defects) {
  return std::accumulate(defects.begin(), defects.end(), 0.0,
                         [](double sum, const auto& defect) { return sum + defect.second; });
}

}  // namespace

DefectParting::DefectParting(CutPiece& piece, const SeamSuggestionOptions& options, const Limits& limits)
    : piece_(piece), options_(options), limits_(limits), candidates_(piece), defects_(piece.charts().size()) {}

DefectParting DefectParting::of(CutPiece& piece, const SeamSuggestionOptions& options, const Limits& limits,
                                const Progress& progress) {
  DefectParting result(piece, options, limits);
  const TrialMaps& charts = piece.charts();
  try_in_parallel(
      charts.size(),
      [&](int i, const Progress&) {
        const auto chart = static_cast<std::size_t>(i);
        if (!piece.is_known_sound(charts[chart])) result.defects_[chart] = defective_faces(*charts[chart]);
      },
      progress);
  KnownMaps sound;
  for (std::size_t i = 0; i < charts.size(); ++i) {
    const int chart = static_cast<int>(i);
    if (result.defects_[i].empty()) {
      sound.insert(charts[i]);
    } else if (result.candidates_.is_first_of_mirrored(chart)) {
      result.parted_.push_back(chart);
    }
  }
  piece.set_sound(sound);
  return result;
}

SeamTrial DefectParting::part(const Progress& progress) {
  // Largest first: smaller ones fill the time until it is done.
  std::vector<std::size_t> order(parted_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto n_faces = [&](std::size_t k) { return piece_.charts()[parted_[k]]->chart.faces.size(); };
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return n_faces(a) > n_faces(b); });
  std::vector<Parting> partings(parted_.size());
  try_in_parallel(
      parted_.size(),
      [&](int i, const Progress& own_progress) {
        const std::size_t k = order[i];
        partings[k] = part_chart(parted_[k], own_progress);
      },
      progress);
  SeamEdges all;
  double length = 0;
  KnownMaps known;
  for (const Parting& parting : partings) {
    // A cut that no longer fits waits: the next step looks for a shorter one.
    const double longer = length + piece_.seams().length(parting.cut);
    if (longer > limits_.longest) continue;
    length = longer;
    all.insert(all.end(), parting.cut.begin(), parting.cut.end());
    known.insert(parting.charts.begin(), parting.charts.end());
  }
  if (all.empty()) return {};
  return piece_.attempt(piece_.seams().with_images(all), {}, known, progress);
}

/// The cut that parts the defects of one chart, preferably a short one with little distortion.
DefectParting::Parting DefectParting::part_chart(int chart, const Progress& progress) const {
  Parting result;
  result.cut = part_large_chart(chart);
  if (!result.cut.empty()) return result;
  const std::vector<int>& faces = defects_[chart];
  const Defects defects = defects_of(*piece_.charts()[chart], faces);
  for (const bool at_any_price : {false, true}) {
    std::vector<PartCut> some;
    SeamTrial best = best_parting(
        defects, at_any_price ? candidates_.cuts_apart(chart, faces) : candidates_.cuts_between(chart, faces),
        at_any_price, some, progress);
    if (best.added.empty() && some.size() > 1) best = part_together(defects, some, progress);
    if (best.added.empty()) continue;
    result.cut = std::move(best.added);
    result.charts = std::move(best.charts);
    break;
  }
  return result;
}

/// The cut without trials, whose maps would take too long; empty if trials are to choose.
SeamEdges DefectParting::part_large_chart(int chart) const {
  const int n_vertices = piece_.charts()[chart]->chart.n_vertices();
  if (n_vertices <= limits_.max_chosen_vertices) return {};
  SeamEdges cut = candidates_.cut_out(chart, defects_[chart]);
  if (cut.empty() && limits_.halves) cut = candidates_.halve(chart);
  return piece_.seams().length(cut) <= limits_.longest ? cut : SeamEdges{};
}

/// Each face gets a little of the whole area, so that slivers count.
DefectParting::Defects DefectParting::defects_of(const TrialMap& mapped, const std::vector<int>& faces) const {
  Defects result;
  for (const int face : faces) result[mapped.chart.faces[face]] = mapped.area[face] + 1e-9 * piece_.quality().area;
  return result;
}

/// The defects in the charts that a trial changes; all of `before` if one has no map.
DefectParting::Defects DefectParting::defects_left(const SeamTrial& trial, const Defects& before) const {
  Defects result;
  for (const auto& mapped : trial.charts) {
    if (piece_.is_current(mapped)) continue;
    if (!mapped->solved) return before;
    result.merge(defects_of(*mapped, defective_faces(*mapped)));
  }
  return result;
}

/// Includes the price of an island: otherwise the shortest cut would win.
double DefectParting::price(const SeamEdges& cut) const { return piece_.seams().cost(cut) + piece_.cost_of_island(); }

bool DefectParting::is_too_distorted(const SeamTrial& trial) const {
  // At the limit, such a rise costs as much as an island.
  const double allowed = std::max((1 + island_price) * piece_.quality().distortion(), options_.energy_limit - 4);
  return !(trial.quality.distortion() <= allowed);
}

/// The trial of the cut that removes the most of a chart's defects for its price. Adds cuts that remove too few of them
/// to `some`.
SeamTrial DefectParting::best_parting(const Defects& defects, std::vector<SeamEdges>&& cuts, bool at_any_price,
                                      std::vector<PartCut>& some, const Progress& progress) const {
  cuts.erase(
      std::remove_if(cuts.begin(), cuts.end(),
                     [&](const SeamEdges& cut) { return cut.empty() || piece_.seams().length(cut) > limits_.longest; }),
      cuts.end());
  // Cheapest first: once the price is higher than the best score allows, no other cut can win.
  std::stable_sort(cuts.begin(), cuts.end(),
                   [&](const SeamEdges& a, const SeamEdges& b) { return price(a) < price(b); });
  SeamTrial best;
  double best_score = 0;
  for (std::size_t first = 0; first < cuts.size(); first += tries_at_once) {
    if (best_score * price(cuts[first]) >= 1) break;
    std::vector<SeamTrial> trials(std::min<std::size_t>(tries_at_once, cuts.size() - first));
    std::vector<Defects> left(trials.size());
    try_in_parallel(
        trials.size(),
        [&](int i, const Progress& own_progress) {
          const auto k = static_cast<std::size_t>(i);
          trials[k] = piece_.attempt(cuts[first + k], {}, {}, own_progress);
          left[k] = defects_left(trials[k], defects);
        },
        progress);
    for (std::size_t k = 0; k < trials.size(); ++k) {
      SeamTrial& trial = trials[k];
      const double removed = 1 - extent(left[k]) / extent(defects);
      const bool is_distorted = is_too_distorted(trial);
      const bool is_fine = 2 * removed >= 1 && !is_distorted;
      if (!at_any_price && !is_fine) {
        if (!(removed > 0) || is_distorted) continue;
        some.push_back({trial.added, {}});
        std::copy_if(defects.begin(), defects.end(), std::inserter(some.back().removed, some.back().removed.end()),
                     [&](const auto& defect) { return left[k].count(defect.first) == 0; });
        continue;
      }
      // A cut that parts the chart always counts: in the end, a single face is neither flipped nor overlaps itself.
      const double score =
          (is_fine ? 1 : 1e-3) * std::max(removed, piece_.makes_islands(trial) ? 1e-3 : 0.0) / price(trial.added);
      if (score <= best_score) continue;
      best_score = score;
      best = std::move(trial);
    }
  }
  return best;
}

/// The trial of several cuts at once; empty if even together they remove too little.
SeamTrial DefectParting::part_together(const Defects& defects, const std::vector<PartCut>& some,
                                       const Progress& progress) const {
  SeamEdges cut = cut_together(some);
  if (piece_.seams().length(cut) > limits_.longest) return {};
  SeamTrial together = piece_.attempt(std::move(cut), {}, {}, progress);
  const bool removes_some = 4 * extent(defects_left(together, defects)) <= 3 * extent(defects);
  return removes_some && !is_too_distorted(together) ? together : SeamTrial{};
}

/// Joins cuts for different parts of a chart's defects, always the one that removes the most for its price, until none
/// removes more.
SeamEdges DefectParting::cut_together(const std::vector<PartCut>& cuts) const {
  SeamEdges all;
  Defects removed;
  while (true) {
    const PartCut* best = nullptr;
    double best_score = 0;
    for (const PartCut& cut : cuts) {
      double more = 0;
      for (const auto& [face, area] : cut.removed) more += removed.count(face) == 0 ? area : 0;
      const double score = more / price(cut.cut);
      if (!(score > best_score)) continue;  // NaN for a cut that costs nothing and removes no more
      best_score = score;
      best = &cut;
    }
    if (best == nullptr) return piece_.seams().with_images(all);
    removed.insert(best->removed.begin(), best->removed.end());
    all.insert(all.end(), best->cut.begin(), best->cut.end());
  }
}

}  // namespace spectral_conformal
