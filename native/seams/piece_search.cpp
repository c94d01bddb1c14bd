#include "seams/piece_search.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <utility>

#include "concurrency/parallel_calls.h"
#include "seams/carried_seams.h"
#include "seams/cut_surface.h"
#include "seams/loop_grid.h"
#include "seams/relative_grid.h"
#include "seams/rigid_unfolding.h"
#include "seams/seam_style.h"

namespace spectral_conformal {
namespace {

/// Ratio of the vertices of successive copies; the coarsest has small_piece / 2.
constexpr int level_ratio = 4;
/// Of two proposals of seams, the one whose value is larger by this factor is not settled: settling lowered none of 970
/// pieces of machines and robots as much, but one unfolding of a curved surface.
constexpr double hopeless = 4;
/// A search is given up once its seams alone cost this many times the value of its rival. Settling rarely takes half of
/// them back: of those pieces, two would have got better seams, of 17 and 89 vertices.
constexpr double beaten = 2;
/// Vertices of the largest piece that is searched a second time, for whole loops, and not on copies, which have none:
/// of larger pieces, two of five got a better functional, for twice the time.
constexpr int largest_with_loops = 5 * small_piece;
/// Of the loops of one family of a grid that are cut together.
constexpr int most_of_family = 3;
/// Numbers of loops of both families with which other places are tried, too, on a piece that is not tiny.
constexpr std::size_t shifted_choices = 3;

}  // namespace

SearchedMesh::SearchedMesh(const SeamSuggestionOptions& options, const MirroredPieces& parts,
                           const std::vector<int>& given_vertices)
    : options(options),
      parts(parts),
      given_vertices(given_vertices),
      preferences(options, parts.symmetry, given_vertices) {
  for (const Piece& piece : parts.pieces) {
    const double piece_area = piece.area();
    if (std::isfinite(piece_area)) area += piece_area;
  }
  if (area > 0 && !options.shortest) sheet_side = options.longest_side * std::sqrt(area);
}

PieceSearch::PieceSearch(const SearchedMesh& mesh, int index)
    : mesh_(mesh),
      index_(index),
      stages_(mesh.options, n_vertices() > small_piece),
      first_options_(stages_.limits()),
      coarse_options_(stages_.limits_of_copies()) {}

const PieceMirror& PieceSearch::mirror() const { return mesh_.parts.mirrors[index_]; }

int PieceSearch::n_vertices() const { return static_cast<int>(given().vertices.size()); }

bool PieceSearch::is_large() const { return n_vertices() > large_piece; }

void PieceSearch::begin(const Progress& progress) {
  call_while_polling(steps_per_face * given().n_faces(), [&] {
    piece_ = given();
    const RelativeGrid grid = RelativeGrid::over(piece_.positions);
    piece_.given = std::move(piece_.positions);
    piece_.positions = grid.coordinates(piece_.given);
    unit_ = grid.unit();
  });
  unfold();  // before there are copies, which have other limits
  if (n_vertices() > small_piece) make_levels(progress);
  open(progress);
}

void PieceSearch::step(double longest, const Progress& progress) {
  if (extends_) return extend(progress);
  cutter_->cut(longest, progress);
  if (is_unfolded(progress)) {
    unfolded_->settle(progress);
    cutter_ = std::move(unfolded_);
    bonus_ = unfolding_bonus();
    levels_.clear();
    drop_fill();
  } else {
    if (!cutter_->finished()) return;
    cutter_->conclude(longest, progress);
    if (!levels_.empty()) return refine(progress);
    take_unfolded(progress);
  }
  take_loops(longest, progress);
  // Large pieces are scans.
  if (!std::isfinite(longest) && !is_large()) cutter_->complete_rings(progress);
  extends_ = cutter_->exceeds(mesh_.options) && enters_stage();
  if (!extends_) finish();
}

/// Adds the next cuts toward the limits asked for. What is added does not depend on them; they only end it.
void PieceSearch::extend(const Progress& progress) {
  if (!cutter_->part_defects(infinity, progress).empty()) return;
  if (cutter_->exceeds(mesh_.options) && (!cutter_->extend(progress).empty() || enters_stage())) return;
  finish();
}

/// Goes on to the next stage if the limits asked for are stricter. Otherwise returns false.
bool PieceSearch::enters_stage() {
  if (!stages_.advance()) return false;
  stage_options_ = stages_.limits();
  cutter_->set_options(stage_options_);
  return true;
}

double PieceSearch::urgency() const {
  const MapQuality& quality = cutter_->quality();
  if (!quality.solved) return quality.distortion();
  return static_cast<float>(quality.distortion() * quality.area * unit_ * unit_);
}

/// Makes copies of a large piece, each with fewer vertices than the one before.
void PieceSearch::make_levels(const Progress& progress) {
  // Coarse seams are shorter than the fine seams they become, so a length limit could not be kept.
  if (std::isfinite(mesh_.options.max_length)) return;
  const bool is_own_image = mirror().image == index_;
  const Piece* finer = &piece_;
  const PieceMirror* finer_mirror = &mirror();
  call_while_polling(steps_per_face * piece_.n_faces(), [&] { filled_ = fill_small_holes(piece_, index_, mirror()); });
  if (filled_) {
    finer = &filled_->piece;
    finer_mirror = &filled_->mirror;
  }
  int n = n_vertices();
  while (n > small_piece / 2) {
    n = n / level_ratio > small_piece ? n / level_ratio : small_piece / 2;
    std::vector<signed char> side;
    std::vector<double> preference;
    for (const int v : finer->vertices) {
      if (is_own_image) side.push_back(mesh_.parts.symmetry.side[v]);
      if (mesh_.preferences.has_wanted()) preference.push_back(mesh_.preferences.wanted_at(v));
    }
    levels_.push_back(
        std::make_unique<CoarsePiece>(coarse_piece(*finer, index_, *finer_mirror, side, preference, n, progress)));
    finer = &levels_.back()->piece;
    finer_mirror = &levels_.back()->mirror;
  }
}

/// Starts with the coarsest copy.
void PieceSearch::open(const Progress& progress) {
  report(progress, 0, "seams");
  PieceSeams seams = unseamed();
  seams.open();
  cutter_ = cutter(std::move(seams), false);
  cutter_->solve(progress);
}

std::unique_ptr<Cutter> PieceSearch::cutter(PieceSeams&& seams, bool refined, bool whole_loops) const {
  // A large mesh can have many pieces, each taking a second or two.
  const bool is_one_of_many =
      mesh_.given_vertices.size() > std::size_t{tries_at_once} * large_piece && n_vertices() > small_piece;
  // In single precision, so that rounding does not decide.
  const auto in_units = [&](double size, int power) { return static_cast<float>(size / std::pow(unit_, power)); };
  return std::make_unique<Cutter>(
      std::move(seams), levels_.empty() ? first_options_ : coarse_options_,
      Cutter::Stage{n_vertices(), refined, is_large() || is_one_of_many, in_units(mesh_.area, 2), whole_loops,
                    in_units(mesh_.sheet_side, 1), least_turn()});
}

double PieceSearch::unfolding_bonus() const {
  return mesh_.options.shortest ? 1 : weights_of(mesh_.options.style).unfolding;
}

/// See SeamGraph::set_least_turn; in single precision, as all sizes of a stage.
double PieceSearch::least_turn() const {
  if (mesh_.options.shortest) return 0;
  return static_cast<float>(weights_of(mesh_.options.style).least_turn * std::sqrt(mesh_.area) / unit_);
}

/// The coarsest level left, without new seams.
PieceSeams PieceSearch::unseamed() const {
  return levels_.empty() ? priced(piece_, mirror()) : priced(levels_.back()->piece, levels_.back()->mirror);
}

/// The same, with small holes filled.
PieceSeams PieceSearch::unseamed_filled() const {
  return levels_.empty() && filled_ ? priced(filled_->piece, filled_->mirror) : unseamed();
}

/// The graph of a piece with its costs scaled, without new seams.
PieceSeams PieceSearch::priced(const Piece& piece, const PieceMirror& mirror) const {
  std::unique_ptr<PieceSeams> made;
  call_while_polling(steps_per_face * piece.corner_vertices.size(),
                     [&] { made = std::make_unique<PieceSeams>(piece, index_, mirror, mesh_.parts.symmetry); });
  PieceSeams seams = std::move(*made);
  // Filled pieces have all vertices of the piece; only coarse copies have fewer.
  const bool is_coarse = piece.vertices.size() < piece_.vertices.size();
  seams.scale_costs(mesh_.preferences.cost_factors(seams.graph(), piece, is_coarse));
  seams.scale_turns(mesh_.options.shortest ? 0 : weights_of(mesh_.options.style).turn);
  return seams;
}

/// Moves on to the next finer level, with the seams of the one before.
void PieceSearch::refine(const Progress& progress) {
  const std::unique_ptr<CoarsePiece> coarse = std::move(levels_.back());
  levels_.pop_back();
  PieceSeams seams = unseamed_filled();
  carry_seams(*coarse, cutter_->seams(), seams);
  if (levels_.empty() && filled_) {
    seams = with_holes(seams);
    drop_fill();
  }
  cutter_ = cutter(std::move(seams), true);
  cutter_->solve(progress);
}

void PieceSearch::drop_fill() {
  if (n_vertices() > largest_with_loops) filled_.reset();
}

/// The seams of a filled piece on the piece itself, whose edges have the same indices. Edges around holes, already cut,
/// are left out.
PieceSeams PieceSearch::with_holes(const PieceSeams& filled) const {
  PieceSeams seams = unseamed();
  if (!filled.is_symmetric()) seams.forget_symmetry();
  for (const int edge : filled.edges()) {
    if (!seams.graph().edges()[edge].cut) seams.add({edge});
  }
  return seams;
}

/// Finds the seams of a rigid unfolding. Under a length limit, cuts come one by one. Large pieces are scans, not worth
/// a second graph.
void PieceSearch::unfold() {
  if (std::isfinite(mesh_.options.max_length) || is_large()) return;
  PieceSeams seams = priced(piece_, mirror());
  seams.forget_symmetry();
  seams.set_least_turn(least_turn());
  SeamEdges edges;
  call_while_polling(steps_per_face * piece_.corner_vertices.size(),
                     [&] { edges = rigid_unfolding_seams(piece_, seams.graph()); });
  if (edges.empty()) return;
  seams.add(edges);
  unfolded_ = cutter(std::move(seams), true);
  least_of_unfolding_ = unfolded_->seams().cost(edges) / std::sqrt(piece_.area());
}

/// Whether a search is not worth going on with or settling beside a rival with this value of the functional.
bool PieceSearch::is_beaten(const Cutter& search, double rival) const {
  if (mesh_.options.shortest) return false;
  return search.finished() ? search.value() > hopeless * rival : search.seams_value() > beaten * rival;
}

/// Whether the unfolding beats the seams found so far.
bool PieceSearch::is_unfolded(const Progress& progress) {
  if (!unfolded_ || !is_beaten(*cutter_, least_of_unfolding_)) return false;
  if (unfolded_->charts().empty()) unfolded_->solve(progress);
  return is_beaten(*cutter_, unfolded_->value()) && unfolded_->is_sound();
}

/// Takes the seams of the unfolding if they are better than those found.
void PieceSearch::take_unfolded(const Progress& progress) {
  if (!unfolded_) return;
  std::unique_ptr<Cutter> unfolded = std::move(unfolded_);
  const double found = cutter_->rating();
  if (least_of_unfolding_ > hopeless * found) return;
  if (unfolded->charts().empty()) unfolded->solve(progress);
  if (unfolded->value() > hopeless * found) return;
  unfolded->settle(progress);
  take_if_better(std::move(unfolded), unfolding_bonus());
}

/// The seams of a search of the filled piece, if there is one, settled on the piece itself.
std::unique_ptr<Cutter> PieceSearch::without_fill(std::unique_ptr<Cutter> found, const Progress& progress) const {
  if (!filled_) return found;
  std::unique_ptr<Cutter> cutter = this->cutter(with_holes(found->seams()), true);
  cutter->solve(progress);
  cutter->settle(progress);
  return cutter;
}

/// Takes the seams of a search that proposes whole edge loops, too, if they are better than those found. A loop lowers
/// the functional fast at first, so such a search alone would end with more loops than most bodies need. Small holes do
/// not end a loop.
void PieceSearch::take_loops(double longest, const Progress& progress) {
  if (std::isfinite(longest) || mesh_.options.shortest || n_vertices() > largest_with_loops) return;
  PieceSeams seams = unseamed_filled();
  // Without any distortion a loop would cost this.
  double least = infinity;
  for (const SeamEdges& loop : seams.loops().loops) least = std::min(least, seams.cost(loop));
  if (!(least < cutter_->rating() * std::sqrt(piece_.area()))) return;
  take_grid(seams, progress);
  seams.open();
  std::unique_ptr<Cutter> cutter = this->cutter(std::move(seams), false, true);
  cutter->solve(progress);
  while (!cutter->finished()) {
    cutter->cut(infinity, progress);
    if (is_beaten(*cutter, cutter_->rating())) return;
  }
  cutter->conclude(infinity, progress);
  take_if_better(without_fill(std::move(cutter), progress));
}

/// Takes seams along a few loops of both families of a grid, evenly spaced, if they are better than those found. With
/// one loop less, they have much more distortion, so a search that cuts loop by loop misses them.
void PieceSearch::take_grid(const PieceSeams& uncut, const Progress& progress) {
  const EdgeLoops& loops = uncut.loops();
  std::vector<double> costs;
  costs.reserve(loops.loops.size());
  for (const SeamEdges& loop : loops.loops) costs.push_back(uncut.cost(loop));
  for (const LoopGrid& grid : LoopGrid::of(uncut.graph(), loops)) {
    std::unique_ptr<Cutter> best;
    // Returns the functional, infinity if it cannot be the lowest.
    const auto try_loops = [&](const std::vector<int>& some, const std::vector<int>& across) {
      SeamEdges edges;
      for (const auto* chosen : {&some, &across}) {
        for (const int loop : *chosen) edges.insert(edges.end(), loops.loops[loop].begin(), loops.loops[loop].end());
      }
      // Without any distortion they would cost this.
      const double least = uncut.cost(edges) / std::sqrt(piece_.area());
      if (!(least < std::min(cutter_->rating(), best ? best->value() : infinity))) return infinity;
      PieceSeams seams = uncut;
      seams.forget_symmetry();
      seams.add(edges);
      std::unique_ptr<Cutter> cutter = this->cutter(std::move(seams), true);
      cutter->solve(progress);
      const double value = cutter->value();
      if (!best || value < best->value()) best = std::move(cutter);
      return value;
    };
    const auto& [one, other] = grid.families;
    std::vector<std::tuple<double, int, int>> tried;  // value of the cheapest choice, numbers of loops
    for (int k = 1; k <= std::min(most_of_family, static_cast<int>(one.size())); ++k) {
      for (int l = 1; l <= std::min(most_of_family, static_cast<int>(other.size())); ++l) {
        tried.emplace_back(try_loops(evenly_spaced(one, k, costs)[0], evenly_spaced(other, l, costs)[0]), k, l);
      }
    }
    std::sort(tried.begin(), tried.end());
    // Where loops are few, each place matters, and maps cost little.
    const bool takes_all = n_vertices() <= small_piece / 2;
    for (std::size_t i = 0; i < (takes_all ? tried.size() : std::min(tried.size(), shifted_choices)); ++i) {
      const auto& [value, k, l] = tried[i];
      if (!std::isfinite(value)) break;
      const auto some = evenly_spaced(one, k, costs);
      const auto across = evenly_spaced(other, l, costs);
      for (std::size_t s = 0; s < some.size(); ++s) {
        for (std::size_t a = s == 0 ? 1 : 0; a < across.size(); ++a) {
          if (takes_all || s == 0 || a == 0) try_loops(some[s], across[a]);
        }
      }
    }
    if (!best) continue;
    best->settle(progress);
    take_if_better(without_fill(std::move(best), progress));
  }
}

/// Takes the seams of another search, with the bonus that it has over all others, if it rates them better than those
/// found.
void PieceSearch::take_if_better(std::unique_ptr<Cutter> other, double bonus) {
  if (!(other->rating() / bonus < cutter_->rating() / bonus_)) return;
  cutter_ = std::move(other);
  bonus_ = bonus;
}

/// Keeps the seams found, chain by chain, and frees the memory of the search.
void PieceSearch::finish() {
  const PieceSeams& seams = cutter_->seams();
  std::vector<std::pair<double, SeamEdges>> chains;  // minus the length, edges
  for (const SeamChain& chain : seams.chains()) {
    SeamEdges whole = seams.with_cut_images(chain.edges);
    const double length = seams.graph().length(whole);
    chains.emplace_back(-length, std::move(whole));
  }
  std::sort(chains.begin(), chains.end());
  const auto edges_of = [&](std::size_t begin, std::size_t end) {
    std::vector<std::array<int, 2>> edges;
    for (std::size_t k = begin; k < end; ++k) {
      for (const int e : chains[k].second) edges.push_back(seams.graph().edges()[e].vertices);
    }
    return edges;
  };
  const auto opens = [&](std::size_t n_chains) {
    std::vector<std::array<int, 2>> all = edges_of(0, n_chains);
    all.insert(all.end(), piece_.seams.begin(), piece_.seams.end());
    const std::vector<Chart> charts = build_charts(piece_.view(all)).charts;
    return std::all_of(charts.begin(), charts.end(),
                       [](const Chart& chart) { return !chart.boundary_loops.empty() && handle_curves(chart) == 0; });
  };
  // More cuts close nothing that is open, so bisection finds the first chains that suffice; usually none or few.
  std::size_t n_needed = 0;
  std::size_t end = 0;
  while (end < chains.size() && !opens(end)) {
    n_needed = end + 1;
    end = std::min(2 * end + 1, chains.size());
  }
  while (n_needed < end) {
    const std::size_t middle = n_needed + (end - n_needed) / 2;
    if (opens(middle)) {
      end = middle;
    } else {
      n_needed = middle + 1;
    }
  }
  if (n_needed > 0) cuts_.push_back({edges_of(0, n_needed), infinity});
  length_ = length();
  double left = length_;
  for (std::size_t k = 0; k < chains.size(); ++k) {
    if (k >= n_needed) cuts_.push_back({edges_of(k, k + 1), static_cast<float>(left)});
    left += unit_ * chains[k].first;
  }
  cutter_.reset();
  filled_.reset();
  piece_ = {};
}

}  // namespace spectral_conformal
