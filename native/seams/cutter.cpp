#include "seams/cutter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <numeric>
#include <set>
#include <unordered_set>
#include <utility>

#include "concurrency/parallel_calls.h"

namespace spectral_conformal {
namespace {

/// Fraction of the area within SeamSuggestionOptions::scale_limit, as documented there.
constexpr double enough_area = 0.95;
/// While the scale is beyond its limit, extrema with at least this fraction of the volume of the largest are cut to
/// together, for one solve instead of many: the limbs of a body, but not their fingers.
constexpr double together = 0.2;
/// Such cuts are not tried any more when so many steps in a row have gained nothing by them. Of nine bodies with 12 to
/// 20 limbs one was tried in 57 steps more, and got 51 islands instead of 9; the others have the same seams from 4 on.
constexpr int max_losses_together = 4;
/// A cut must lower the distortion by at least this fraction; less is not seen in a texture.
constexpr double min_gain = 0.002;
/// A mean QC that is beyond its limit by 0.05 counts like a scale that deviates by a fifth.
constexpr double qc_weight = 5;
/// Of several cuts that part a chart's defects those are preferred that remove at least this fraction of them and raise
/// the distortion by no more than this factor.
constexpr double min_removed = 0.5;
/// Where none does, the cuts that remove less are made together if these remove at least this fraction.
constexpr double min_removed_together = 0.25;
constexpr double distortion_for_parting = 1.05;
/// Cuts that may part a chart's defects are tried in fours, the shortest first.
constexpr std::size_t parted_at_once = 4;
/// What a cut gains counts less by this factor where it makes an island: artists prefer few.
constexpr double island_penalty = 0.4;
/// A cut is priced at its length and this fraction of the root of the area, what any cut costs: without it the gain for
/// a length favors ever shorter cuts.
constexpr double base_price = 0.25;
/// Of larger pieces, which have fine edges, no cut shorter than this fraction of the root of the area is tried: it
/// costs a solve and gains little.
constexpr double min_length = 0.05;
/// Cuts with this fraction of the best one's gain are made together with it; a trial of all of them confirms it.
constexpr double nearly_as_good = 0.25;
/// Vertices of the maps that are kept for later trials: some hundred megabytes.
constexpr std::int64_t remembered_vertices = 400000;
/// Only of larger pieces are short cuts left out.
constexpr int small_piece = 3000;
/// Vertices that a round of trials solves for, for 2 to 4 regions, and all rounds before giving up, for 8 to 24.
constexpr int few_vertices = 12000;
constexpr int many_vertices = 30000;
/// Charts of a piece that are parted although that does not lower the distortion.
constexpr int max_losing_splits = 12;
/// Where cuts are priced by their gain in QC, a chart is halved for nothing if what it has beyond the limit is this
/// multiple of the price.
constexpr double later_gain = 1.5;
/// No more than so many in a row without a cut of another kind that gains: noise is in every face, even of small
/// charts.
constexpr int max_losing_splits_in_a_row = 30;
/// Cuts against one kind of distortion, of scale or of angles, are tried where it has this fraction of the whole.
constexpr double worth_trying = 0.15;
/// Seams that are tried to be sewn up are solved for at once in fours, of which the one that saves most for what it
/// costs is sewn up, and altogether until this number of vertices was solved for: the time of the search before.
constexpr std::size_t sewn_at_once = 4;
constexpr std::int64_t sewing_vertices = 80000;
/// Of a large piece whose coarse copy has its seams already, more cuts against distortion are looked for until so many
/// times its vertices were solved for, the map with these seams included; then only those are left that part defects. A
/// copy has cut as far as that pays; what is left on a rough surface of a million faces took minutes and gained 1 % of
/// energy. For the same reason only the few worst regions are cut to.
constexpr std::int64_t refined_patience = 2;
/// Flaps of a few faces are cut out of its large charts. Where there is more that overlaps, charts with more than
/// `few_vertices` are halved after so many steps that part defects, after the next those with half as many, and so on:
/// noise flips faces all over, of which cuts chosen by trials remove a few.
constexpr int max_chosen_partings = 1;
constexpr int min_halved = 300;
/// The least cost of sewing, as a fraction of the distortion that is allowed: what costs less is free.
constexpr double least_loss = 0.02;
/// A piece that no map serves after this number of blind cuts has its charts halved until all have a map: at once where
/// a coarse copy was solved already, with all the cuts that topology needs. Only what cannot be halved gets the map
/// that fallbacks make, which took half a minute on isosurfaces of 3,000 faces with handles, for charts that were cut
/// up all the same.
constexpr int max_blind_cuts = 30;
constexpr int max_blind_cuts_refined = 0;

/// The area of a face, with a little of the whole, so that slivers count.
double extent_of(const TrialMap& mapped, int face, double whole) {
  return mapped.area[static_cast<std::size_t>(face)] + 1e-9 * whole;
}

/// Some faces of a mesh, on its vertices and with its seams: their charts are built without a look at the others.
class FaceSubset {
 public:
  /// The faces ascending. The mesh's vertices and seams must outlive this object.
  FaceSubset(const PolygonMesh& mesh, std::vector<int> faces) : mesh_(mesh), faces_(std::move(faces)) {
    for (const int face : faces_) {
      corner_vertices_.insert(corner_vertices_.end(), mesh.corner_vertices + mesh.face_offsets[face],
                              mesh.corner_vertices + mesh.face_offsets[face + 1]);
      face_offsets_.push_back(static_cast<int>(corner_vertices_.size()));
    }
  }

  PolygonMesh view() const {
    PolygonMesh mesh = mesh_;
    mesh.n_faces = static_cast<int>(faces_.size());
    mesh.face_offsets = face_offsets_.data();
    mesh.corner_vertices = corner_vertices_.data();
    return mesh;
  }
  void number_as_in_mesh(Chart& chart) const {
    for (std::vector<int>* numbers : {&chart.faces, &chart.duplicates}) {
      for (int& face : *numbers) face = faces_[static_cast<std::size_t>(face)];
    }
  }

 private:
  PolygonMesh mesh_;
  std::vector<int> faces_;
  std::vector<int> face_offsets_{0};
  std::vector<int> corner_vertices_;
};

void try_in_parallel(std::size_t n, const std::function<void(int, const Progress&)>& work, const Progress& progress) {
  run_in_parallel(static_cast<int>(n), work, progress, "seams", Cutter::max_threads);
}

/// The edges of some cuts, each once, in the order in which they come.
class JoinedCuts {
 public:
  explicit JoinedCuts(const PieceSeams& seams) : seams_(seams) {}
  void add(const SeamEdges& cut) {
    for (const int edge : cut) {
      if (!known_.insert(edge).second) continue;
      edges_.push_back(edge);
      length_ += seams_.graph().edges()[static_cast<std::size_t>(edge)].length;
    }
  }
  SeamEdges& edges() { return edges_; }
  double length() const { return length_; }

 private:
  const PieceSeams& seams_;
  SeamEdges edges_;
  std::unordered_set<int> known_;
  double length_ = 0;
};

}  // namespace

Cutter::Cutter(PieceSeams seams, const SeamSuggestionOptions& options)
    : seams_(std::move(seams)), options_(options), stage_{seams_.graph().n_vertices()}, changed_(true) {}

Cutter::Cutter(PieceSeams seams, const SeamSuggestionOptions& options, const Stage& stage)
    : seams_(std::move(seams)), options_(options), stage_(stage), changed_(!stage.refined), cones_tried_(hurries()) {}

void Cutter::solve(const Progress& progress) { solve({}, progress); }

void Cutter::solve(const KnownMaps& known, const Progress& progress) {
  TrialMaps charts = map_charts(seams_.with({}), {}, known, progress);
  const MapQuality quality = map_quality(charts, options_.scale_limit);
  take_maps(std::move(charts), quality);
}

SeamEdges Cutter::step(double longest, const Progress& progress) {
  recent_ = std::exchange(fresh_, {});
  SeamEdges accepted;
  if (!quality_.solved && blind_cuts_ >= max_blind()) {
    accepted = halve_unsolved(longest, progress);
    if (!accepted.empty()) {
      changed_ = true;
      return accepted;
    }
    if (!fallbacks_) allow_fallbacks(progress);
  }
  const bool wanted = quality_.solved && !exhausted_ && !good_enough() && !is_patience_spent();
  if (wanted) accepted = cut_distortion(longest, progress);
  if (accepted.empty() && quality_.hopeless()) accepted = blind_cut(longest, progress);
  if (wanted && accepted.empty()) accepted = split_in_half(longest, progress);
  if (wanted && accepted.empty() && price_by_qc()) {
    accepted = cut_distortion(longest, progress);
    if (accepted.empty()) accepted = split_in_half(longest, progress);
  }
  if (wanted) exhausted_ = accepted.empty();
  if (accepted.empty()) {
    accepted = part_defects(longest, progress);
    exhausted_ = exhausted_ && accepted.empty();  // of new charts there are new cuts
  }
  if (accepted.empty() && changed_) sew(progress);
  changed_ = changed_ || !accepted.empty();
  finished_ = accepted.empty();
  return accepted;
}

/// The cut that lowers the distortion most for its price.
SeamEdges Cutter::cut_distortion(double longest, const Progress& progress) {
  const bool is_priced = only_qc_counts();
  SeamEdges accepted;
  if (losses_together_ < max_losses_together && (stage_.refined || quality_.within_limit < enough_area)) {
    accepted = cut_to_all(longest, progress);
    losses_together_ = accepted.empty() ? losses_together_ + 1 : 0;
  }
  if (accepted.empty()) accepted = best_cut(longest, progress);
  if (is_priced && !accepted.empty()) losing_splits_ = 0;
  return accepted;
}

/// Where no cut is left that lowers the energy, which noise keeps beyond its limit, those are left that lower the mean
/// QC by their price. Returns whether that is new.
bool Cutter::price_by_qc() {
  if (!(options_.qc_gain > 0) || !quality_.solved || only_qc_counts() || quality_.mean_qc <= options_.qc_limit) {
    return false;
  }
  is_energy_given_up_ = true;
  futile_.clear();  // as long as the energy counted
  losing_splits_ = 0;
  return true;
}

/// Charts that no cut makes easy to map get the map that `unwrap` would give them, which tells where to cut.
void Cutter::allow_fallbacks(const Progress& progress) {
  fallbacks_ = true;
  KnownMaps solved;
  for (const auto& old : charts_) {
    if (old->solved) solved.add(old);
  }
  charts_.clear();
  current_ = {};
  recent_ = {};
  fresh_ = {};
  solve(solved, progress);
}

bool Cutter::good_enough() const { return good_enough_but_for_qc() && quality_.mean_qc <= options_.qc_limit; }

bool Cutter::good_enough_but_for_qc() const {
  return is_energy_given_up_ || (quality_.within_limit >= enough_area && quality_.energy <= options_.energy_limit);
}

/// Only charts beside the changed edges are built anew, and of these only those solved that are not known.
TrialMaps Cutter::map_charts(const std::vector<std::array<int, 2>>& seams, const SeamEdges& changed,
                             const KnownMaps& known, const Progress& progress) const {
  PolygonMesh mesh = seams_.piece().view();
  mesh.seam_edges = seams.data();
  mesh.n_seam_edges = static_cast<int>(seams.size());
  TrialMaps result;
  std::vector<int> faces;
  if (charts_.empty()) {
    faces.resize(static_cast<std::size_t>(mesh.n_faces));
    std::iota(faces.begin(), faces.end(), 0);
  } else {
    std::vector<char> is_changed(charts_.size(), 0);
    for (const int edge : changed) {
      for (const int face : seams_.graph().edges()[edge].faces) {
        if (face >= 0 && chart_of_face_[face] >= 0) is_changed[chart_of_face_[face]] = 1;
      }
    }
    for (std::size_t i = 0; i < charts_.size(); ++i) {
      if (is_changed[i] == 0) {
        result.push_back(charts_[i]);
      } else {
        faces.insert(faces.end(), charts_[i]->chart.faces.begin(), charts_[i]->chart.faces.end());
      }
    }
    std::sort(faces.begin(), faces.end());
  }
  const FaceSubset changed_faces(mesh, std::move(faces));
  ChartDecomposition decomposition = build_charts(changed_faces.view());
  std::vector<Chart> unknown;
  for (Chart& chart : decomposition.charts) {
    changed_faces.number_as_in_mesh(chart);
    std::shared_ptr<const TrialMap> same;
    for (const KnownMaps* maps : {&current_, &known, &recent_, &fresh_}) {
      if (!same) same = maps->find(chart);
    }
    if (same) {
      result.push_back(std::move(same));
    } else {
      solved_vertices_ += chart.n_vertices();
      unknown.push_back(std::move(chart));
    }
  }
  const std::size_t first = result.size();
  result.resize(first + unknown.size());
  try_in_parallel(
      unknown.size(),
      [&](int i, const Progress& going_on) {
        const auto k = static_cast<std::size_t>(i);
        result[first + k] = std::make_shared<const TrialMap>(
            solve_trial_map(mesh, std::move(unknown[k]), options_.map, fallbacks_, going_on));
      },
      progress);
  std::sort(result.begin(), result.end(),
            [](const auto& a, const auto& b) { return a->chart.faces.front() < b->chart.faces.front(); });
  return result;
}

void Cutter::take_maps(TrialMaps&& charts, const MapQuality& quality) {
  charts_ = std::move(charts);
  current_ = KnownMaps(charts_);
  quality_ = quality;
  chart_of_face_.assign(static_cast<std::size_t>(seams_.piece().n_faces()), -1);
  for (std::size_t i = 0; i < charts_.size(); ++i) {
    for (const int face : charts_[i]->chart.faces) chart_of_face_[face] = static_cast<int>(i);
  }
}

/// The same cut of a chart is often tried again after another chart was cut.
void Cutter::remember(const TrialMaps& tried) {
  for (const auto& mapped : tried) {
    if (fresh_.n_vertices() > remembered_vertices) return;
    if (!current_.contains(mapped) && !fresh_.contains(mapped)) fresh_.add(mapped);
  }
}

void Cutter::remember(const std::vector<Trial>& trials) {
  for (const Trial& trial : trials) remember(trial.charts);
}

Cutter::Trial Cutter::attempt(SeamEdges cut, const KnownMaps& known, const Progress& progress) const {
  Trial trial;
  trial.charts = map_charts(seams_.with(cut), cut, known, progress);
  trial.quality = map_quality(trial.charts, options_.scale_limit);
  trial.cut = std::move(cut);
  return trial;
}

/// In parallel; in the order of the proposals.
std::vector<Cutter::Trial> Cutter::attempt_all(const std::vector<Proposal>& proposals, const Progress& progress) {
  std::vector<Trial> trials(proposals.size());
  try_in_parallel(
      proposals.size(),
      [&](int i, const Progress& going_on) {
        trials[static_cast<std::size_t>(i)] = attempt(proposals[static_cast<std::size_t>(i)].cut, {}, going_on);
      },
      progress);
  remember(trials);
  return trials;
}

bool Cutter::is_small() const { return stage_.n_vertices <= small_piece; }

bool Cutter::hurries() const { return stage_.refined && stage_.is_large; }

bool Cutter::makes_islands(const Trial& trial) const { return trial.charts.size() > charts_.size(); }

double Cutter::price(const SeamEdges& cut) const { return seams_.length(cut) + base_price * std::sqrt(quality_.area); }

SeamEdges Cutter::accept(Trial&& trial) {
  seams_.add(trial.cut);
  take_maps(std::move(trial.charts), trial.quality);
  return std::move(trial.cut);
}

/// What is to be lowered: the distortion, and the mean QC where it is beyond its limit.
double Cutter::excess(const MapQuality& quality) const {
  return quality.distortion() + qc_weight * std::max(0.0, quality.mean_qc - options_.qc_limit);
}

/// Whether cuts are priced by options_.qc_gain.
bool Cutter::only_qc_counts() const { return options_.qc_gain > 0 && quality_.solved && good_enough_but_for_qc(); }

/// What seams of this length have to lower the mean QC of the piece by; 0 where there is no such price.
double Cutter::least_qc_gain(const SeamEdges& cut) const {
  if (!(options_.qc_gain > 0)) return 0;
  const double mesh_area = stage_.mesh_area > 0 ? stage_.mesh_area : quality_.area;
  return options_.qc_gain * seams_.length(cut) * std::sqrt(mesh_area) / quality_.area;
}

double Cutter::gain(const Trial& trial) const {
  if (!trial.quality.solved) return 0;
  const double less = excess(quality_) - excess(trial.quality);
  if (only_qc_counts()) {
    if (!(less > 0) || quality_.mean_qc - trial.quality.mean_qc < least_qc_gain(trial.cut)) return 0;
  } else if (less < min_gain * excess(quality_)) {
    return 0;
  }
  return (makes_islands(trial) ? island_penalty : 1) * less / price(trial.cut);
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
    report(progress, 0, "seams");
    const SeamEdges cut = candidates.cut_to(region, later);
    later.add(cut);
    all.insert(all.end(), cut.begin(), cut.end());
  }
  if (all.empty() || seams_.length(all) > longest) return {};
  Trial trial = attempt(std::move(all), {}, progress);
  return gain(trial) > 0 && !makes_islands(trial) ? accept(std::move(trial)) : SeamEdges{};
}

bool Cutter::is_tried(const Proposal& proposal) const {
  return proposal.chart >= 0 && std::any_of(futile_.begin(), futile_.end(), [&](const Futile& futile) {
           return futile.first == charts_[static_cast<std::size_t>(proposal.chart)] && futile.second == proposal.cut;
         });
}

/// Solves with each of the cuts; those that lower the distortion.
std::vector<Cutter::Trial> Cutter::gaining(std::vector<Proposal> proposals, double longest, const Progress& progress) {
  const double least = is_small() ? 0 : min_length * std::sqrt(quality_.area);
  std::vector<Proposal> worthy;
  for (Proposal& proposal : proposals) {
    const double length = seams_.length(proposal.cut);
    if (proposal.cut.empty() || length > longest || length < least || is_tried(proposal)) continue;
    if (std::any_of(worthy.begin(), worthy.end(), [&](const auto& other) { return other.cut == proposal.cut; }))
      continue;
    worthy.push_back(std::move(proposal));
  }
  std::vector<Trial> trials = attempt_all(worthy, progress);
  std::vector<Trial> result;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    if (gain(trials[i]) > 0 && (worthy[i].may_part || !makes_islands(trials[i]))) {
      result.push_back(std::move(trials[i]));
    } else if (worthy[i].chart >= 0) {
      futile_.emplace_back(charts_[static_cast<std::size_t>(worthy[i].chart)], std::move(worthy[i].cut));
    }
  }
  return result;
}

/// Of the cuts to the most distorted regions, and around them, those that gain most for their length. First to the few
/// worst of the kind of distortion that there is, then to more of either kind.
SeamEdges Cutter::best_cut(double longest, const Progress& progress) {
  const CutCandidates candidates = this->candidates();
  const double shear = quality_.shear / quality_.distortion();
  std::array<std::vector<CutCandidates::Region>, 2> regions;
  try_in_parallel(
      regions.size(),
      [&](int i, const Progress&) {
        regions[static_cast<std::size_t>(i)] =
            candidates.regions(i == 0 ? CutCandidates::Kind::scale : CutCandidates::Kind::angle);
      },
      progress);
  const std::array<bool, 2> matters{shear<1 - worth_trying, shear> worth_trying};
  // Every trial solves a chart, so large pieces get fewer.
  const auto few = static_cast<std::size_t>(std::clamp(few_vertices / std::max(1, stage_.n_vertices), 2, 4));
  const auto many = static_cast<std::size_t>(std::clamp(many_vertices / std::max(1, stage_.n_vertices), 2 * 4, 24));
  std::array<std::size_t, 2> first{0, 0};
  for (const bool all : {false, true}) {
    if (all && hurries()) break;
    for (std::size_t round = 0; round < (all ? many / few : 1); ++round) {
      std::vector<Proposal> proposals;
      if (!std::exchange(cones_tried_, true)) {
        for (SeamEdges& cut : candidates.cuts_to_cones()) proposals.push_back({std::move(cut), false, -1});
      }
      std::vector<std::pair<const CutCandidates::Region*, bool>> wanted;  // and whether to cut around it
      for (std::size_t kind = 0; kind < 2; ++kind) {
        if (!all && !matters[kind]) continue;
        const auto& list = regions[kind];
        const std::size_t last = std::min(first[kind] + few, list.size());
        for (std::size_t i = first[kind]; i < last; ++i) wanted.emplace_back(&list[i], false);
        if (first[kind] < last) wanted.emplace_back(&list[first[kind]], true);
        first[kind] = last;
      }
      const std::size_t to_cones = proposals.size();
      proposals.resize(to_cones + wanted.size());
      try_in_parallel(
          wanted.size(),
          [&](int i, const Progress& going_on) {
            report(going_on, 0, "seams");
            const auto& [region, around] = wanted[static_cast<std::size_t>(i)];
            SeamEdges cut = around ? candidates.cut_around(*region) : candidates.cut_to(*region, seams_);
            proposals[to_cones + static_cast<std::size_t>(i)] = {std::move(cut), around, region->chart};
          },
          progress);
      std::vector<Trial> trials = gaining(std::move(proposals), longest, progress);
      if (!trials.empty()) return accept_best(std::move(trials), longest, progress);
    }
  }
  return {};
}

/// Parts the chart with most distortion where no cut gains: its parts can then be cut on their own. A few times even if
/// that raises the distortion at first, as it may on coarse meshes.
SeamEdges Cutter::split_in_half(double longest, const Progress& progress) {
  std::vector<Proposal> proposals;
  for (SeamEdges& cut : candidates().halves()) {
    if (!cut.empty() && seams_.length(cut) <= longest) proposals.push_back({std::move(cut), true, -1});
  }
  std::vector<Trial> trials = attempt_all(proposals, progress);
  trials.erase(std::remove_if(trials.begin(), trials.end(),
                              [&](const Trial& trial) { return !trial.quality.solved || !makes_islands(trial); }),
               trials.end());
  if (trials.empty()) return {};
  // Where none gains that is the first, of the worst chart: others lose less, but cut off crumbs.
  const auto best =
      std::max_element(trials.begin(), trials.end(), [&](const Trial& a, const Trial& b) { return gain(a) < gain(b); });
  if (!(gain(*best) > 0)) {
    ++losing_splits_;
    if (!may_gain_later(*best)) return {};
  }
  return accept(std::move(*best));
}

/// Whether a cut that gains nothing now is made for those that its parts may have.
bool Cutter::may_gain_later(const Trial& halved) const {
  if (!only_qc_counts()) return losing_splits_ <= max_losing_splits;
  if (losing_splits_ > max_losing_splits_in_a_row) return false;
  const KnownMaps left(halved.charts);
  double beyond = 0;
  for (const auto& mapped : charts_) {
    if (!left.contains(mapped)) beyond += mapped->sums.qc() - options_.qc_limit * mapped->sums.area();
  }
  return beyond >= later_gain * quality_.area * least_qc_gain(halved.cut);
}

/// The best of several trials, and all that are nearly as good together, which saves solves, but no more than needed.
SeamEdges Cutter::accept_best(std::vector<Trial>&& trials, double longest, const Progress& progress) {
  std::stable_sort(trials.begin(), trials.end(), [&](const Trial& a, const Trial& b) { return gain(a) > gain(b); });
  Trial& best = trials.front();
  if (makes_islands(best)) return accept(std::move(best));
  const double excess = quality_.energy - options_.energy_limit;
  double gained = 0;
  JoinedCuts all(seams_);
  KnownMaps known;
  for (const Trial& trial : trials) {
    if (makes_islands(trial) || gain(trial) < nearly_as_good * gain(best)) continue;
    if (excess > 0 && gained >= excess) break;
    gained += quality_.energy - trial.quality.energy;
    all.add(trial.cut);
    for (const auto& mapped : trial.charts) {
      if (!current_.contains(mapped)) known.add(mapped);
    }
  }
  if (all.edges().size() > best.cut.size() && all.length() <= longest) {
    Trial trial = attempt(std::move(all.edges()), known, progress);
    if (!makes_islands(trial) && gain(trial) > nearly_as_good * gain(best)) return accept(std::move(trial));
  }
  return accept(std::move(best));
}

/// Parts every chart that covers itself or has flipped faces; each in its own way.
SeamEdges Cutter::part_defects(double longest, const Progress& progress) {
  const CutCandidates candidates = this->candidates();
  std::vector<std::vector<int>> defects(charts_.size());
  try_in_parallel(
      charts_.size(),
      [&](int i, const Progress&) {
        const auto chart = static_cast<std::size_t>(i);
        if (!sound_.contains(charts_[chart])) defects[chart] = defective_faces(*charts_[chart]);
      },
      progress);
  sound_ = {};
  std::vector<int> parted;
  for (std::size_t i = 0; i < charts_.size(); ++i) {
    const int chart = static_cast<int>(i);
    if (defects[i].empty()) {
      sound_.add(charts_[i]);
    } else if (candidates.is_first_of_mirrored(chart)) {
      parted.push_back(chart);
    }
  }
  // The largest first: smaller ones fill the time until it is parted.
  std::vector<std::size_t> order(parted.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return charts_[static_cast<std::size_t>(parted[a])]->chart.faces.size() >
           charts_[static_cast<std::size_t>(parted[b])]->chart.faces.size();
  });
  if (!parted.empty()) ++partings_;
  std::vector<Parting> partings(parted.size());
  try_in_parallel(
      parted.size(),
      [&](int i, const Progress& going_on) {
        const std::size_t k = order[static_cast<std::size_t>(i)];
        const std::int64_t remembered = remembered_vertices / static_cast<std::int64_t>(parted.size());
        partings[k] = part_chart(candidates, parted[k], defects[static_cast<std::size_t>(parted[k])], longest,
                                 remembered, going_on);
      },
      progress);
  JoinedCuts all(seams_);
  KnownMaps known;
  for (const Parting& parting : partings) {
    remember(parting.tried);
    // What does not fit any more is for the next step to shorten.
    if (all.length() + seams_.length(parting.cut) > longest) continue;
    all.add(parting.cut);
    for (const auto& mapped : parting.charts) known.add(mapped);
  }
  if (all.edges().empty()) return {};
  return accept(attempt(std::move(all.edges()), known, progress));
}

/// The cut that parts the defects of one chart: with the least distortion and length, or in any case. Maps of as many
/// vertices as are to be `remembered` are returned with it.
Cutter::Parting Cutter::part_chart(const CutCandidates& candidates, int chart, const std::vector<int>& faces,
                                   double longest, std::int64_t remembered, const Progress& progress) const {
  Parting result;
  result.room = remembered;
  result.cut = part_large_chart(candidates, chart, faces, longest);
  if (!result.cut.empty()) return result;
  const DefectiveChart defective = defective_chart(chart, faces, longest);
  for (const bool at_any_price : {false, true}) {
    std::vector<PartCut> some;
    Trial best = best_parting(
        defective, at_any_price ? candidates.cuts_apart(chart, faces) : candidates.cuts_between(chart, faces),
        at_any_price, some, result, progress);
    if (best.cut.empty() && some.size() > 1) best = part_together(defective, some, progress);
    if (best.cut.empty()) continue;
    result.cut = std::move(best.cut);
    std::copy_if(best.charts.begin(), best.charts.end(), std::back_inserter(result.charts),
                 [&](const auto& mapped) { return !current_.contains(mapped); });
    break;
  }
  return result;
}

/// Without trials, whose maps would take too long; nothing where these are to choose.
SeamEdges Cutter::part_large_chart(const CutCandidates& candidates, int chart, const std::vector<int>& faces,
                                   double longest) const {
  const int n_vertices = charts_[static_cast<std::size_t>(chart)]->chart.n_vertices();
  if (!stage_.refined || n_vertices <= std::min(small_piece, max_chosen_vertices())) return {};
  SeamEdges cut = candidates.cut_out(chart, faces);
  if (cut.empty() && n_vertices > max_chosen_vertices()) cut = candidates.halve(chart);
  return seams_.length(cut) <= longest ? cut : SeamEdges{};
}

Cutter::DefectiveChart Cutter::defective_chart(int chart, const std::vector<int>& faces, double longest) const {
  const TrialMap& map = *charts_[static_cast<std::size_t>(chart)];
  const double max_distortion = std::max(distortion_for_parting * quality_.distortion(), options_.energy_limit - 4);
  DefectiveChart result{{}, 0, max_distortion, longest};
  for (const int face : faces) {
    const double extent = extent_of(map, face, quality_.area);
    result.faces.push_back({map.chart.faces[static_cast<std::size_t>(face)], extent});
    result.extent += extent;
  }
  return result;
}

/// The trial of the cut that parts most of a chart's defects for its price. Those that are not good enough but remove
/// some are added to `some`, and the maps of all to the parting's, as far as there is room.
Cutter::Trial Cutter::best_parting(const DefectiveChart& chart, std::vector<SeamEdges>&& cuts, bool at_any_price,
                                   std::vector<PartCut>& some, Parting& parting, const Progress& progress) const {
  cuts.erase(std::remove_if(cuts.begin(), cuts.end(),
                            [&](const SeamEdges& cut) { return cut.empty() || seams_.length(cut) > chart.longest; }),
             cuts.end());
  // The shortest first: what is left cannot win once its price is higher than the best score allows.
  std::stable_sort(cuts.begin(), cuts.end(),
                   [&](const SeamEdges& a, const SeamEdges& b) { return seams_.length(a) < seams_.length(b); });
  Trial best;
  double best_score = 0;
  for (std::size_t first = 0; first < cuts.size(); first += parted_at_once) {
    if (best_score * price(cuts[first]) >= 1) break;
    std::vector<Trial> trials(std::min(parted_at_once, cuts.size() - first));
    std::vector<Defects> left(trials.size());
    try_in_parallel(
        trials.size(),
        [&](int i, const Progress& going_on) {
          const auto k = static_cast<std::size_t>(i);
          trials[k] = attempt(cuts[first + k], {}, going_on);
          left[k] = defects_left(trials[k], chart.extent);
        },
        progress);
    for (std::size_t k = 0; k < trials.size(); ++k) {
      Trial& trial = trials[k];
      for (const auto& mapped : trial.charts) {
        if (parting.room < 0 || current_.contains(mapped)) continue;
        parting.tried.push_back(mapped);
        parting.room -= mapped->chart.n_vertices();
      }
      const double removed = (chart.extent - left[k].extent) / chart.extent;
      const bool is_distorted = !(trial.quality.distortion() <= chart.max_distortion);
      const bool is_fine = removed >= min_removed && !is_distorted;
      if (!at_any_price && !is_fine) {
        if (removed > 0 && !is_distorted) some.push_back(part_cut(chart, trial.cut, left[k]));
        continue;
      }
      // What parts the chart always counts: a single face is neither flipped nor covers itself.
      const double score =
          (is_fine ? 1 : 1e-3) * std::max(removed, makes_islands(trial) ? 1e-3 : 0.0) / price(trial.cut);
      if (score <= best_score) continue;
      best_score = score;
      best = std::move(trial);
    }
  }
  return best;
}

Cutter::PartCut Cutter::part_cut(const DefectiveChart& chart, const SeamEdges& cut, const Defects& left) {
  PartCut result{cut, {}};
  std::copy_if(chart.faces.begin(), chart.faces.end(), std::back_inserter(result.removed),
               [&](const DefectiveFace& defect) {
                 return !std::binary_search(left.faces.begin(), left.faces.end(), defect.face);
               });
  return result;
}

/// The trial of several cuts at once, without a cut where they are no better.
Cutter::Trial Cutter::part_together(const DefectiveChart& chart, const std::vector<PartCut>& some,
                                    const Progress& progress) const {
  SeamEdges cut = cut_together(some);
  if (seams_.length(cut) > chart.longest) return {};
  Trial together = attempt(std::move(cut), {}, progress);
  const double removed = (chart.extent - defects_left(together, chart.extent).extent) / chart.extent;
  if (removed >= min_removed_together && together.quality.distortion() <= chart.max_distortion) return together;
  return {};
}

/// In the charts that a trial changes; one without a map counts as much as `unsolved`.
Cutter::Defects Cutter::defects_left(const Trial& trial, double unsolved) const {
  Defects result;
  for (const auto& mapped : trial.charts) {
    if (current_.contains(mapped)) continue;
    double extent = 0;
    for (const int face : defective_faces(*mapped)) {
      extent += extent_of(*mapped, face, quality_.area);
      result.faces.push_back(mapped->chart.faces[static_cast<std::size_t>(face)]);
    }
    result.extent += mapped->solved ? extent : unsolved;
  }
  std::sort(result.faces.begin(), result.faces.end());
  return result;
}

/// Each part of a chart's defects has a cut of its own: those that remove most for their price, until none removes
/// more.
SeamEdges Cutter::cut_together(const std::vector<PartCut>& cuts) const {
  JoinedCuts all(seams_);
  std::set<int> removed;
  while (true) {
    const PartCut* best = nullptr;
    double best_score = 0;
    for (const PartCut& cut : cuts) {
      double more = 0;
      for (const DefectiveFace& defect : cut.removed) {
        if (removed.count(defect.face) == 0) more += defect.extent;
      }
      const double score = more / price(cut.cut);
      if (!(score > best_score)) continue;  // not a number: a cut that costs nothing and removes no more
      best_score = score;
      best = &cut;
    }
    if (best == nullptr) return std::move(all.edges());
    for (const DefectiveFace& defect : best->removed) removed.insert(defect.face);
    all.add(best->cut);
  }
}

/// Where there is no map to tell what to cut. What cannot be unwrapped at all is cut whatever the length.
SeamEdges Cutter::blind_cut(double longest, const Progress& progress) {
  if (blind_cuts_ >= max_blind()) return {};
  ++blind_cuts_;
  SeamEdges cut = candidates().blind_cut();
  if (cut.empty() || (quality_.solved && seams_.length(cut) > longest)) return {};
  Trial trial = attempt(std::move(cut), {}, progress);
  return quality_.solved && !trial.quality.solved ? SeamEdges{} : accept(std::move(trial));
}

SeamEdges Cutter::halve_unsolved(double longest, const Progress& progress) {
  SeamEdges cut = candidates().halve_unsolved();
  if (cut.empty() || seams_.length(cut) > longest) return {};
  Trial trial = attempt(std::move(cut), {}, progress);
  return makes_islands(trial) ? accept(std::move(trial)) : SeamEdges{};
}

bool Cutter::is_patience_spent() const {
  return hurries() && solved_vertices_ > refined_patience * seams_.graph().n_vertices();
}

/// Of a chart whose defects are parted by cuts that trials choose.
int Cutter::max_chosen_vertices() const {
  const int more = partings_ - max_chosen_partings;
  if (!hurries() || more <= 0) return std::numeric_limits<int>::max();
  return std::max(min_halved, few_vertices >> std::min(more - 1, 16));
}

int Cutter::max_blind() const { return hurries() ? max_blind_cuts_refined : max_blind_cuts; }

bool Cutter::is_sewable(const Trial& trial) const {
  const MapQuality& quality = trial.quality;
  if (!quality.solved || quality.energy > std::max(options_.energy_limit, quality_.energy) ||
      quality.mean_qc > std::max(options_.qc_limit, quality_.mean_qc + least_qc_gain(trial.cut)) ||
      quality.within_limit < std::min(enough_area, quality_.within_limit)) {
    return false;
  }
  return std::all_of(trial.charts.begin(), trial.charts.end(),
                     [&](const auto& mapped) { return current_.contains(mapped) || defective_faces(*mapped).empty(); });
}

/// Of the charts beside some edges, together.
std::int64_t Cutter::vertices_beside(const SeamEdges& edges) const {
  std::set<int> charts;
  for (const int edge : edges) {
    for (const int face : seams_.graph().edges()[edge].faces) {
      if (face >= 0 && chart_of_face_[face] >= 0) charts.insert(chart_of_face_[face]);
    }
  }
  std::int64_t sum = 0;
  for (const int chart : charts) sum += charts_[static_cast<std::size_t>(chart)]->chart.n_vertices();
  return sum;
}

bool Cutter::is_sound() const {
  return std::all_of(charts_.begin(), charts_.end(), [&](const auto& mapped) {
    return mapped->solved && (sound_.contains(mapped) || defective_faces(*mapped).empty());
  });
}

void Cutter::settle(const SeamFunctional& functional, const Progress& progress) {
  constexpr double any_length = std::numeric_limits<double>::infinity();
  while (!part_defects(any_length, progress).empty()) recent_ = std::exchange(fresh_, {});
  double least = functional(seams_.edges(), charts_);
  std::set<SeamEdges> kept;
  std::int64_t solved_vertices = 0;
  while (solved_vertices < sewing_vertices) {
    std::vector<SeamEdges> chains = seams_.chains();
    chains.erase(std::remove_if(chains.begin(), chains.end(), [&](const auto& chain) { return kept.count(chain) > 0; }),
                 chains.end());
    if (chains.empty()) return;
    std::stable_sort(chains.begin(), chains.end(),
                     [&](const SeamEdges& a, const SeamEdges& b) { return functional.price(a) > functional.price(b); });
    chains.resize(std::min(chains.size(), sewn_at_once));
    std::vector<TrialMaps> maps(chains.size());
    std::vector<double> value(chains.size(), std::numeric_limits<double>::infinity());
    try_in_parallel(
        chains.size(),
        [&](int i, const Progress& going_on) {
          const auto k = static_cast<std::size_t>(i);
          maps[k] = map_charts(seams_.without(chains[k]), chains[k], {}, going_on);
          SeamEdges rest;
          std::set_difference(seams_.edges().begin(), seams_.edges().end(), chains[k].begin(), chains[k].end(),
                              std::back_inserter(rest));
          const double found = functional(rest, maps[k]);
          if (found < least && std::all_of(maps[k].begin(), maps[k].end(), [&](const auto& mapped) {
                return current_.contains(mapped) || defective_faces(*mapped).empty();
              })) {
            value[k] = found;
          }
        },
        progress);
    for (std::size_t k = 0; k < chains.size(); ++k) {
      remember(maps[k]);
      kept.insert(chains[k]);
      for (const auto& mapped : maps[k]) {
        if (!current_.contains(mapped)) solved_vertices += mapped->chart.n_vertices();
      }
    }
    const auto best = static_cast<std::size_t>(std::min_element(value.begin(), value.end()) - value.begin());
    if (!std::isfinite(value[best])) continue;
    least = value[best];
    // The others may be worth it still, beside what is taken back.
    for (std::size_t k = 0; k < chains.size(); ++k) {
      if (std::isfinite(value[k])) kept.erase(chains[k]);
    }
    seams_.remove(chains[best]);
    const MapQuality quality = map_quality(maps[best], options_.scale_limit);
    take_maps(std::move(maps[best]), quality);
  }
}

/// Longest first, as long as the maps stay good enough.
void Cutter::sew(const Progress& progress) {
  if (!quality_.solved) return;
  std::set<SeamEdges> kept;
  std::int64_t solved_vertices = 0;
  while (solved_vertices < sewing_vertices) {
    std::vector<Trial> trials;
    for (SeamEdges& chain : seams_.chains()) {
      if (kept.count(chain) > 0 || trials.size() == sewn_at_once) continue;
      // On its coarse copies it was tried already.
      if (hurries() && vertices_beside(chain) > sewing_vertices) continue;
      trials.emplace_back();
      trials.back().cut = std::move(chain);
    }
    if (trials.empty()) return;
    std::vector<char> sewable(trials.size(), 0);
    try_in_parallel(
        trials.size(),
        [&](int i, const Progress& going_on) {
          Trial& trial = trials[static_cast<std::size_t>(i)];
          trial.charts = map_charts(seams_.without(trial.cut), trial.cut, {}, going_on);
          trial.quality = map_quality(trial.charts, options_.scale_limit);
          sewable[static_cast<std::size_t>(i)] = is_sewable(trial) ? 1 : 0;
        },
        progress);
    remember(trials);
    std::size_t best = trials.size();
    double best_score = 0;
    for (std::size_t i = 0; i < trials.size(); ++i) {
      kept.insert(trials[i].cut);
      for (const auto& mapped : trials[i].charts) {
        if (!current_.contains(mapped)) solved_vertices += mapped->chart.n_vertices();
      }
      if (sewable[i] == 0) continue;
      const double lost = std::max(trials[i].quality.energy - quality_.energy, 0.0);
      const double score = seams_.length(trials[i].cut) / (lost + least_loss * (options_.energy_limit - 4));
      if (score <= best_score) continue;
      best_score = score;
      best = i;
    }
    if (best == trials.size()) continue;
    for (std::size_t i = 0; i < trials.size(); ++i) {
      if (sewable[i] != 0) kept.erase(trials[i].cut);
    }
    seams_.remove(trials[best].cut);
    take_maps(std::move(trials[best].charts), trials[best].quality);
  }
}

}  // namespace spectral_conformal
