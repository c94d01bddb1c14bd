#include "packing/growth_stage.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "concurrency/parallel_calls.h"
#include "packing/packing_turns.h"

namespace spectral_conformal {
namespace {

bool is_rectilinear_after(const IslandOutline& island, Complex turn) {
  double manhattan = 0;
  double euclidean = 0;
  for (const OutlineEdge& edge : island.edges) {
    const Complex step = turn * (edge.to - edge.from);
    manhattan += std::abs(step.real()) + std::abs(step.imag());
    euclidean += std::abs(step);
  }
  return is_rectilinear(manhattan, euclidean);
}

}  // namespace

GrowthStage::GrowthStage(const PackingProblem& problem, const PackingGrid& grid, const GrowthEffort& effort)
    : problem_(problem), grid_(grid), effort_(effort), step_(effort.first_step) {}

std::unique_ptr<GrowthStage> GrowthStage::begin(const PackingProblem& problem, const PackingOptions& options,
                                                const PackingGrid& grid, const GrowthEffort& effort,
                                                const Packing& packing) {
  std::unique_ptr<GrowthStage> stage(new GrowthStage(problem, grid, effort));
  stage->scale_ = effort.first_scale * packing.scale;
  for (std::size_t i = 0; i < problem.islands.size(); ++i) {
    stage->turns_.push_back(turns_of(hull_of(problem.islands[i]), problem.turns_of(i, options.turns), effort.n_turns));
  }
  // If islands move anywhere, rectilinear ones lie along the axes in some of the searches, in proportion to their share
  // of the area, but never in all: some fit only askew.
  std::vector<bool> upright(problem.islands.size(), false);
  double upright_area = 0;
  double area = 0;
  for (std::size_t i = 0; i < upright.size(); ++i) {
    upright[i] =
        effort.range == MoveRange::anywhere && is_rectilinear_after(problem.islands[i], stage->turns_[i].front());
    area += problem.islands[i].area;
    if (upright[i]) upright_area += problem.islands[i].area;
  }
  const std::uint32_t n_upright = static_cast<std::uint32_t>(
      std::min(tries_at_once - 1L, area > 0 ? std::lround(tries_at_once * upright_area / area) : 0));
  const std::vector<bool> none(problem.islands.size(), false);
  for (std::uint32_t k = 0; k < tries_at_once; ++k) {
    const std::vector<bool>& by_quarters = k + n_upright < tries_at_once ? none : upright;
    stage->chains_.push_back(
        {OverlapSeparation(problem, grid, stage->turns_, by_quarters, effort.range, tries_at_once * options.seed + k),
         0, 0, false});
  }
  for (std::size_t i = 0; i < problem.islands.size(); ++i) {
    const PlaneMotion& motion = packing.motions[i];
    const auto& turns = stage->turns_[i];
    const auto nearest = std::max_element(turns.begin(), turns.end(), [&](Complex a, Complex b) {
      return (std::conj(a) * motion.factor).real() < (std::conj(b) * motion.factor).real();
    });
    const Complex middle = motion(stage->chains_.front().separation.middle_before(static_cast<int>(i)));
    stage->poses_.push_back({static_cast<int>(nearest - turns.begin()), grid.cells(middle)});
  }
  stage->start_all();
  return stage;
}

void GrowthStage::start_all() {
  trial_rasters_ = std::make_shared<CachedRasters>(problem_.islands, turns_, scale_ * step_ * grid_.cells_per_pixel(),
                                                   grid_.border());
  for (Chain& chain : chains_) start(chain);
}

void GrowthStage::start(Chain& chain) {
  chain.is_apart = false;
  chain.passes_since = 0;
  chain.least_cells = std::numeric_limits<int>::max();
  // If an island is larger than its region, there is nothing to separate, and the search fails at once.
  if (!chain.separation.start(trial_rasters_, poses_)) chain.passes_since = effort_.patience;
}

void GrowthStage::adopt(const Chain& chain) {
  scale_ *= step_;
  poses_ = chain.separation.poses();
  best_rasters_ = trial_rasters_;
  positions_.clear();
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    positions_.push_back(chain.separation.position(static_cast<int>(i)));
  }
}

void GrowthStage::fail() {
  failures_ = 0;
  if (!best_rasters_) {
    scale_ /= step_;
  } else if (step_ > effort_.last_step) {
    step_ = std::max(effort_.last_step, std::sqrt(step_));
  } else {
    is_exhausted_ = true;
  }
  start_all();
}

bool GrowthStage::advance() {
  run_in_parallel(
      static_cast<int>(chains_.size()),
      [&](int k, const Progress&) {
        Chain& chain = chains_[static_cast<std::size_t>(k)];
        // Each counts as one step of a packing.
        for (int p = 0; p < tries_at_once && chain.passes_since < effort_.patience && !chain.is_apart; ++p) {
          chain.is_apart = chain.separation.pass();
          const int cells = chain.separation.n_overlapping_cells();
          chain.passes_since = cells < chain.least_cells ? 0 : chain.passes_since + 1;
          chain.least_cells = std::min(chain.least_cells, cells);
        }
      },
      {}, "packing");
  const auto apart = std::find_if(chains_.begin(), chains_.end(), [](const Chain& chain) { return chain.is_apart; });
  if (apart != chains_.end()) {
    passes_since_ = 0;
    adopt(*apart);
    start_all();
    return true;
  }
  passes_since_ += tries_at_once;
  for (Chain& chain : chains_) {
    if (chain.passes_since < effort_.patience) continue;
    // Each search has failed about once.
    if (++failures_ == tries_at_once) {
      fail();
      return false;
    }
    start(chain);
    if (effort_.range == MoveRange::anywhere) chain.separation.swap_two();
  }
  return false;
}

Packing GrowthStage::packing() const {
  Packing packing;
  packing.scale = scale();
  if (packing.scale == 0) return packing;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const IslandRaster& raster = best_rasters_->at(static_cast<int>(i), poses_[i].turn);
    const Complex at(positions_[i].x, positions_[i].y);
    const Complex offset = grid_.pixels(raster.origin() + at, grid_.band_of_row(positions_[i].y));
    packing.motions.push_back({raster.factor() / grid_.cells_per_pixel(), false, offset});
  }
  packing.has_room.assign(poses_.size(), true);
  return packing;
}

}  // namespace spectral_conformal
