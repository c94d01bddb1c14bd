#include "packing/packing_growth.h"

namespace spectral_conformal {
namespace {

// The coarse grid has room for this fraction of the scale of a packing that settled on fine cells.
constexpr double loss_to_cells = 0.98;

GrowthEffort coarse_effort() {
  GrowthEffort effort;
  effort.range = MoveRange::anywhere;
  // Less than 3 degrees: a cell at the end of an island of 40 cells.
  effort.n_turns = 128;
  effort.first_scale = loss_to_cells;
  effort.first_step = 1.005;
  effort.last_step = 1.0005;
  effort.patience = 100;
  return effort;
}

GrowthEffort fine_effort() {
  GrowthEffort effort;
  effort.range = MoveRange::nearby;
  // A cell at the end of an island of 330 cells.
  effort.n_turns = 1024;
  effort.first_step = 1.002;
  effort.last_step = 1.0003;
  effort.patience = 10;
  return effort;
}

}  // namespace

PackingGrowth PackingGrowth::begin(const PackingProblem& problem, const PackingOptions& options,
                                   const PackingGrid& grid, const PackingGrid& fine_grid, const Packing& packing,
                                   bool is_fine) {
  PackingGrowth growth(problem, options, fine_grid);
  growth.coarse_ = GrowthStage::begin(problem, options, grid, coarse_effort(), packing);
  if (is_fine) growth.fine_ = GrowthStage::begin(problem, options, fine_grid, fine_effort(), packing);
  return growth;
}

void PackingGrowth::accept(const GrowthStage& stage) {
  if (stage.scale() > best_.scale) best_ = stage.packing();
}

void PackingGrowth::advance() {
  if (fine_) {
    if (fine_->advance()) accept(*fine_);
    if (fine_->is_exhausted()) fine_.reset();
    return;
  }
  if (coarse_->advance()) accept(*coarse_);
  if (coarse_->passes_since() >= coarse_effort().patience && coarse_->scale() > refined_scale_) {
    refined_scale_ = coarse_->scale();
    fine_ = GrowthStage::begin(problem_, options_, fine_grid_, fine_effort(), coarse_->packing());
  }
}

}  // namespace spectral_conformal
