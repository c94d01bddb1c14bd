#include "seams/cutter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "seams/defect_parting.h"
#include "seams/seam_settling.h"

namespace spectral_conformal {
namespace {

/// Extrema of the scale with at least this fraction of the largest volume get a joint cut, for one solve instead of
/// many: the limbs of a body, but not the fingers. Cuts against one kind of distortion, of scale or of angles, are
/// tried first if it is this fraction of the whole.
constexpr double considerable = 0.2;
/// Seams are straightened and taken back until this many vertices are solved: about as long as the search before.
constexpr std::int64_t settling_vertices = 200000;
/// With the seams of its coarse copy, a piece is searched until this many vertices are solved for it: on rough surfaces
/// of a million faces, the rest took minutes and gained 1 % of energy.
constexpr std::int64_t growth_vertices = 500000;
/// Seams are shortened within the limits until this many vertices are solved at each level.
constexpr std::int64_t shortening_vertices = 300000;
/// Where the shortest seams are wanted, cuts go on until the distortion is this share of what is allowed: of more seams
/// than needed, those that matter least can be taken back.
constexpr double share_before_shortening = 0.4;
/// Maps of trials are kept up to about this many vertices, 0.2 kilobytes each.
constexpr std::int64_t tried_vertices = 200000;
}  // namespace

Cutter::Cutter(PieceSeams seams, const SeamSuggestionOptions& options, const Stage& stage)
    : options_(&options), piece_(std::move(seams), options, stage.mesh_area), stage_(stage), changed_(!stage.refined) {}

SeamEdges Cutter::cut(double longest, const Progress& progress) {
  SeamEdges accepted;
  if (!quality().solved) {
    // Fallbacks are only for charts that cannot be halved: on isosurfaces of 3,000 faces with handles they took half a
    // minute, for charts that were then cut anyway.
    accepted = halve_unsolved(longest, progress);
    if (!accepted.empty()) {
      changed_ = true;
      return accepted;
    }
    if (!piece_.has_fallbacks()) piece_.allow_fallbacks(progress);
  }
  const bool is_growing = grows();
  if (is_growing) accepted = grow(longest, progress);
  exhausted_ = is_growing && accepted.empty();
  if (accepted.empty()) {
    accepted = part_defects(longest, progress);
    exhausted_ = exhausted_ && accepted.empty();  // new charts have new cuts
  }
  changed_ = changed_ || !accepted.empty();
  finished_ = accepted.empty();
  return accepted;
}

void Cutter::conclude(double longest, const Progress& progress) {
  if (!quality().solved) return;
  if (changed_ || options_->shortest) take_back(progress);
  part_strips(longest, progress);
}

void Cutter::settle(const Progress& progress) {
  while (!part_defects(infinity, progress).empty()) continue;
  take_back(progress);
  part_strips(infinity, progress);
}

void Cutter::take_back(const Progress& progress) {
  settle_seams(piece_, settling_vertices, progress);
  if (seams().graph().least_turn() < stage_.least_turn && quality().solved) {
    piece_.rate_turns(stage_.least_turn);
    // The price of turns counts from here on, and changes that failed may pay after others.
    settle_seams(piece_, settling_vertices, progress);
  }
  if (options_->shortest) shorten_seams(piece_, shortening_vertices, progress);
}

void Cutter::complete_rings(const Progress& progress) {
  if (quality().solved) spectral_conformal::complete_rings(piece_, settling_vertices, progress);
}

bool Cutter::exceeds(const SeamSuggestionOptions& limits) const {
  return quality().solved && SeamFunctional(limits).exceeds_limits(map_quality(charts(), limits.scale_limit));
}

void Cutter::set_options(const SeamSuggestionOptions& options) {
  options_ = &options;
  piece_.rate_by(options);
  futile_.clear();
  exhausted_ = false;
  first_ = piece_.solved_vertices();
}

bool Cutter::is_sound() const {
  return std::all_of(charts().begin(), charts().end(), [&](const auto& mapped) {
    return mapped->solved && (piece_.is_known_sound(mapped) || defective_faces(*mapped).empty());
  });
}

double Cutter::rating() const {
  if (!is_sound()) return infinity;
  return options_->shortest ? piece_.seams_value() + piece_.functional().beyond_limits(quality()) : piece_.value();
}

/// Whether to search for cuts against distortion: no more than the limits need. The copies of a large piece are cut
/// further while that pays, since the piece itself, whose maps take long, may need more than they.
bool Cutter::grows() const {
  const double share = options_->shortest ? share_before_shortening : 1;
  if (!(is_copy() && stage_.is_large) && !piece_.functional().exceeds_limits(quality(), share)) return false;
  return quality().solved && !exhausted_ &&
         (!stage_.refined || piece_.solved_vertices() - first_ - seams().graph().n_vertices() <= growth_vertices);
}

SeamEdges Cutter::accept(SeamTrial&& trial) {
  SeamEdges cut = trial.added;
  piece_.apply(std::move(trial));
  return cut;
}

/// The next cuts that lower the functional, if there are any.
SeamEdges Cutter::grow(double longest, const Progress& progress) {
  const CutCandidates candidates(piece_);
  SeamEdges accepted = cut_to_all(candidates, longest, progress);
  if (accepted.empty()) accepted = best_cut(candidates, longest, progress);
  if (accepted.empty()) accepted = split_in_half(candidates, longest, progress);
  return accepted;
}

/// A joint cut to all regions that matter: one solve instead of many.
SeamEdges Cutter::cut_to_all(const CutCandidates& candidates, double longest, const Progress& progress) {
  const std::vector<CutCandidates::Region>& where = candidates.regions(CutCandidates::Kind::scale);
  if (where.size() < 2) return {};
  PieceSeams later = seams();
  SeamEdges all;
  for (const auto& region : where) {
    if (region.volume < considerable * where.front().volume) break;
    report(progress, 0, "seams");
    const SeamEdges cut = candidates.cut_to(region, later);
    later.add(cut);
    all.insert(all.end(), cut.begin(), cut.end());
  }
  if (all.empty() || seams().length(all) > longest) return {};
  SeamTrial trial = piece_.attempt(std::move(all), {}, tried_, progress);
  remember(trial);
  if (!(trial.value < piece_.value()) || piece_.makes_islands(trial)) return {};
  return accept(std::move(trial));
}

/// Later steps propose most of the cuts again that were not made.
void Cutter::remember(const SeamTrial& trial) {
  for (const auto& mapped : trial.charts) {
    if (piece_.is_current(mapped)) continue;
    if (n_tried_ > tried_vertices) {
      tried_.clear();
      n_tried_ = 0;
    }
    if (tried_.insert(mapped).second) n_tried_ += mapped->chart.n_vertices();
  }
}

bool Cutter::is_tried(const Proposal& proposal) const {
  return proposal.chart >= 0 && std::any_of(futile_.begin(), futile_.end(), [&](const Futile& futile) {
           return futile.first == charts()[proposal.chart] && futile.second == proposal.cut;
         });
}

/// Solves each proposal. Returns the trials that gain.
std::vector<SeamTrial> Cutter::gaining(std::vector<Proposal> proposals, double longest, const Progress& progress) {
  std::vector<Proposal> worthy;
  std::vector<std::array<SeamEdges, 2>> changes;
  for (Proposal& proposal : proposals) {
    const SeamEdges& cut = proposal.cut;
    if (cut.empty() || seams().length(cut) > longest || is_tried(proposal)) continue;
    // Not even if its charts lost all of their distortion.
    if (!gains(piece_.least_value(cut, {}))) continue;
    if (std::any_of(worthy.begin(), worthy.end(), [&](const auto& other) { return other.cut == cut; })) continue;
    changes.push_back({cut, {}});
    worthy.push_back(std::move(proposal));
  }
  std::vector<SeamTrial> trials = piece_.attempt_all(changes, tried_, progress);
  for (const SeamTrial& trial : trials) remember(trial);
  std::vector<SeamTrial> result;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    if (gains(trials[i].value) && (worthy[i].may_part || !piece_.makes_islands(trials[i]))) {
      result.push_back(std::move(trials[i]));
    } else if (worthy[i].chart >= 0) {
      futile_.emplace_back(charts()[static_cast<std::size_t>(worthy[i].chart)], std::move(worthy[i].cut));
    }
  }
  return result;
}

/// Makes the cuts to the most distorted regions, or around them, that gain most. Tries the few worst regions of the
/// prevailing kinds of distortion first, then more of both kinds.
SeamEdges Cutter::best_cut(const CutCandidates& candidates, double longest, const Progress& progress) {
  constexpr std::array kinds{CutCandidates::Kind::scale, CutCandidates::Kind::angle};
  const double shear = quality().shear / quality().distortion();
  const std::array<bool, 2> matters{shear<1 - considerable, shear> considerable};
  // Every trial solves a chart, so large pieces get fewer.
  const auto few = static_cast<std::size_t>(std::clamp(4 * small_piece / std::max(1, stage_.n_vertices), 2, 4));
  const auto many = static_cast<std::size_t>(std::clamp(5 * small_piece / std::max(1, stage_.n_vertices), 8, 15));
  std::array<std::size_t, 2> first{0, 0};
  for (const bool all : {false, true}) {
    if (all && skips_optional_trials()) break;
    try_in_parallel(
        kinds.size(),
        [&](int kind, const Progress&) {
          if (all || matters[kind]) candidates.regions(kinds[kind]);
        },
        progress);
    for (std::size_t round = 0; round < (all ? many / few : 1); ++round) {
      enum class How { to, around, along_first_loop, along_second_loop };
      std::vector<std::pair<const CutCandidates::Region*, How>> wanted;
      for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
        if (!all && !matters[kind]) continue;
        const auto& list = candidates.regions(kinds[kind]);
        const std::size_t last = std::min(first[kind] + few, list.size());
        for (std::size_t i = first[kind]; i < last; ++i) wanted.emplace_back(&list[i], How::to);
        if (first[kind] < last) {
          wanted.emplace_back(&list[first[kind]], How::around);
          if (stage_.whole_loops) {
            wanted.emplace_back(&list[first[kind]], How::along_first_loop);
            wanted.emplace_back(&list[first[kind]], How::along_second_loop);
          }
        }
        first[kind] = last;
      }
      std::vector<Proposal> proposals(wanted.size());
      try_in_parallel(
          wanted.size(),
          [&](int i, const Progress& own_progress) {
            report(own_progress, 0, "seams");
            const auto& [region, how] = wanted[i];
            SeamEdges cut = how == How::to ? candidates.cut_to(*region, seams())
                            : how == How::around
                                ? candidates.cut_around(*region)
                                : candidates.loop_through(*region, how == How::along_second_loop ? 1 : 0);
            proposals[i] = {std::move(cut), how != How::to, region->chart};
          },
          progress);
      std::vector<SeamTrial> trials = gaining(std::move(proposals), longest, progress);
      if (!trials.empty()) return accept_best(std::move(trials), longest, progress);
    }
  }
  return {};
}

/// Halves a chart with much distortion when no cut gains: its halves can then be cut on their own.
SeamEdges Cutter::split_in_half(const CutCandidates& candidates, double longest, const Progress& progress) {
  std::vector<int> charts = candidates.most_distorted();
  const double of_half = piece_.functional().price_of_island();
  const auto is_hopeless = [&](int chart) { return !gains(piece_.least_value(chart) + of_half); };
  charts.erase(std::remove_if(charts.begin(), charts.end(), is_hopeless), charts.end());
  return accept_lowest(gaining_halves(candidates, charts, longest, progress));
}

std::vector<SeamTrial> Cutter::gaining_halves(const CutCandidates& candidates, const std::vector<int>& charts,
                                              double longest, const Progress& progress) {
  std::vector<SeamEdges> cuts = candidates.halves(charts);
  std::vector<Proposal> proposals;
  for (std::size_t i = 0; i < cuts.size(); ++i) proposals.push_back({std::move(cuts[i]), true, charts[i]});
  return gaining(std::move(proposals), longest, progress);
}

SeamEdges Cutter::accept_lowest(std::vector<SeamTrial>&& trials) {
  if (trials.empty()) return {};
  return accept(std::move(
      *std::min_element(trials.begin(), trials.end(), [](const auto& a, const auto& b) { return a.value < b.value; })));
}

/// Halves charts whose maps are longer than the sheet, until none gains. Length counts from now on: while cuts are
/// made against distortion, it would prefer others to the one that unrolls a hose.
void Cutter::part_strips(double longest, const Progress& progress) {
  if (!quality().solved) return;
  piece_.rate_by(stage_.sheet_side);
  while (!halve_strips(longest, progress).empty()) take_back(progress);
}

SeamEdges Cutter::halve_strips(double longest, const Progress& progress) {
  const CutCandidates candidates(piece_);
  std::vector<int> strips;
  for (std::size_t i = 0; i < charts().size(); ++i) {
    const bool is_strip = piece_.functional().beyond_sheet({charts()[i]}) > 0 && charts()[i]->chart.faces.size() > 1;
    if (is_strip && candidates.is_first_of_mirrored(static_cast<int>(i))) strips.push_back(static_cast<int>(i));
  }
  std::vector<SeamTrial> trials = gaining_halves(candidates, strips, longest, progress);
  trials.erase(std::remove_if(trials.begin(), trials.end(), [&](const auto& trial) { return !piece_.is_sound(trial); }),
               trials.end());
  // All at once, if that is better still: what follows each time takes as long as the piece is large.
  if (trials.size() > 1) {
    SeamTrial joint = together(trials, {}, longest, progress);
    if (joint.value < infinity && piece_.is_sound(joint)) trials.push_back(std::move(joint));
  }
  return accept_lowest(std::move(trials));
}

/// All of several trials as one, of maps that are known; of infinite value if its seams are longer than `longest`.
SeamTrial Cutter::together(const std::vector<SeamTrial>& trials, KnownMaps known, double longest,
                           const Progress& progress) {
  SeamEdges all;
  for (const SeamTrial& trial : trials) {
    all.insert(all.end(), trial.added.begin(), trial.added.end());
    known.insert(trial.charts.begin(), trial.charts.end());
  }
  all = seams().with_images(all);
  SeamTrial joint;
  joint.value = infinity;
  if (seams().length(all) <= longest) joint = piece_.attempt(std::move(all), {}, known, progress);
  return joint;
}

/// Accepts the best of several trials or, if better still, all of them together, which saves solves.
SeamEdges Cutter::accept_best(std::vector<SeamTrial>&& trials, double longest, const Progress& progress) {
  std::stable_sort(trials.begin(), trials.end(), [](const auto& a, const auto& b) { return a.value < b.value; });
  if (piece_.makes_islands(trials.front())) return accept(std::move(trials.front()));
  trials.erase(std::remove_if(trials.begin(), trials.end(), [&](const auto& t) { return piece_.makes_islands(t); }),
               trials.end());
  if (trials.size() > 1) {
    SeamTrial joint = together(trials, tried_, longest, progress);
    remember(joint);
    if (joint.value < trials.front().value && !piece_.makes_islands(joint)) return accept(std::move(joint));
  }
  return accept(std::move(trials.front()));
}

SeamEdges Cutter::part_defects(double longest, const Progress& progress) {
  // In a large piece, trials choose the first cuts. Then large charts are halved, and with each step smaller ones, down
  // to a few hundred vertices: noise flips faces everywhere, and a cut chosen by trials removes only a few.
  const bool halves = skips_optional_trials() && partings_ > 0;
  const int max_chosen = halves ? small_piece >> std::min(partings_ - 1, 3) : small_piece;
  DefectParting parting = DefectParting::of(
      piece_, *options_, {longest, stage_.refined ? max_chosen : std::numeric_limits<int>::max(), halves}, progress);
  if (parting.is_sound()) return {};
  ++partings_;
  SeamTrial trial = parting.part(progress);
  return trial.added.empty() ? SeamEdges{} : accept(std::move(trial));
}

SeamEdges Cutter::halve_unsolved(double longest, const Progress& progress) {
  SeamEdges cut = CutCandidates(piece_).halve_unsolved();
  if (cut.empty() || seams().length(cut) > longest) return {};
  SeamTrial trial = piece_.attempt(std::move(cut), {}, {}, progress);
  return piece_.makes_islands(trial) ? accept(std::move(trial)) : SeamEdges{};
}

}  // namespace spectral_conformal
