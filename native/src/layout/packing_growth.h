#pragma once

#include <optional>

#include "layout/growth_stage.h"

namespace spectral_conformal {

/// Lets a packing grow on a coarse grid, where islands move anywhere. Whenever it does not get on there, the packing
/// grows on a fine grid, where islands move a little, by what the coarse one's cells have lost. Where the packing given
/// is from finer cells than the coarse ones, the fine grid has the first turn.
class PackingGrowth {
 public:
  /// packing: all islands have room. All but the packing must outlive the object.
  PackingGrowth(const PackingProblem& problem, const PackingOptions& options, const PackingGrid& grid,
                const PackingGrid& fine_grid, const Packing& packing, bool is_fine);

  void advance();
  /// The best packing so far, scale 0 for none yet.
  const Packing& packing() const { return best_; }

 private:
  void take(const GrowthStage& stage);

  const PackingProblem& problem_;
  const PackingOptions& options_;
  const PackingGrid& fine_grid_;
  GrowthStage coarse_;
  std::optional<GrowthStage> fine_;
  double refined_scale_ = 0;  ///< the coarse packing's that the fine one began with
  Packing best_;
};

}  // namespace spectral_conformal
