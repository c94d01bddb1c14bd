#pragma once

#include <memory>

#include "packing/growth_stage.h"

namespace spectral_conformal {

/// Lets a packing grow on a coarse grid, where islands move anywhere. Whenever it gets stuck there, it grows on a fine
/// grid, where islands move a little, by what the coarse cells have lost. If the given packing comes from finer cells
/// than the coarse ones, the fine grid comes first.
class PackingGrowth {
 public:
  /// packing: all islands must have room. The other arguments must outlive the object.
  static PackingGrowth begin(const PackingProblem& problem, const PackingOptions& options, const PackingGrid& grid,
                             const PackingGrid& fine_grid, const Packing& packing, bool is_fine);

  void advance();
  /// The best packing so far, scale 0 for none yet.
  const Packing& packing() const { return best_; }

 private:
  PackingGrowth(const PackingProblem& problem, const PackingOptions& options, const PackingGrid& fine_grid)
      : problem_(problem), options_(options), fine_grid_(fine_grid) {}

  void accept(const GrowthStage& stage);

  const PackingProblem& problem_;
  const PackingOptions& options_;
  const PackingGrid& fine_grid_;
  std::unique_ptr<GrowthStage> coarse_;
  std::unique_ptr<GrowthStage> fine_;  ///< or null
  double refined_scale_ = 0;           ///< of the coarse packing from which the fine one began
  Packing best_;
};

}  // namespace spectral_conformal
