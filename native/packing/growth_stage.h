#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "packing/cached_rasters.h"
#include "packing/overlap_separation.h"
#include "packing/packing.h"
#include "packing/packing_grid.h"
#include "spectral_conformal/island_packing.h"

namespace spectral_conformal {

/// The parameters of a GrowthStage.
struct GrowthEffort {
  MoveRange range = MoveRange::anywhere;
  int n_turns = 16;        ///< steps of a full turn for islands that turn freely, a multiple of 16
  double first_scale = 1;  ///< the factor with which growth begins
  double first_step = 1;   ///< the factor of a step of growth
  double last_step = 1;    ///< the smallest
  int patience = 1;        ///< passes without fewer overlapping cells after which a search fails
};

/// The growth of a packing on one grid: all islands grow by a small step, then several OverlapSeparations with
/// different seeds make room. The first to succeed yields the next packing. One that fails starts again from the best
/// packing, with two islands exchanged if islands move anywhere; after some failures the steps get smaller.
class GrowthStage {
 public:
  /// packing: all islands must have room. The other arguments must outlive the object.
  static std::unique_ptr<GrowthStage> begin(const PackingProblem& problem, const PackingOptions& options,
                                            const PackingGrid& grid, const GrowthEffort& effort,
                                            const Packing& packing);

  /// Some passes of each search. Returns whether the packing has grown.
  bool advance();
  /// Passes without growth.
  int passes_since() const { return passes_since_; }
  /// Whether the smallest steps have failed.
  bool is_exhausted() const { return is_exhausted_; }
  /// The scale of the last packing of this stage, 0 for none yet.
  double scale() const { return best_rasters_ ? scale_ : 0; }
  Packing packing() const;

 private:
  struct Chain {
    OverlapSeparation separation;
    int least_cells = 0;
    int passes_since = 0;  ///< since the fewest overlapping cells
    bool is_apart = false;
  };

  GrowthStage(const PackingProblem& problem, const PackingGrid& grid, const GrowthEffort& effort);

  void start_all();
  void start(Chain& chain);
  void adopt(const Chain& chain);
  void fail();

  const PackingProblem& problem_;
  const PackingGrid& grid_;
  GrowthEffort effort_;
  std::vector<std::vector<Complex>> turns_;  ///< of each island; the chains refer to it
  std::vector<Chain> chains_;
  double scale_ = 0;  ///< of the best packing
  double step_;
  int failures_ = 0;  ///< since the step changed
  int passes_since_ = 0;
  bool is_exhausted_ = false;
  std::vector<IslandPose> poses_;
  std::shared_ptr<const CachedRasters> trial_rasters_;
  std::shared_ptr<const CachedRasters> best_rasters_;  ///< null if nothing has grown yet
  std::vector<CellPosition> positions_;
};

}  // namespace spectral_conformal
