#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "packing/island_raster.h"
#include "packing/packing.h"
#include "packing/packing_grid.h"
#include "packing/settling.h"
#include "spectral_conformal/island_packing.h"

namespace spectral_conformal {

/// The search for the order in which islands are put into the grid, and for their scale (IslandPacking).
class PackingSearch {
 public:
  /// fineness: cells per cell of a first packing, along a side.
  PackingSearch(const PackingProblem& problem, const PackingOptions& options, double fineness = 1);

  /// The first packing. Returns whether all islands found room.
  bool begin();
  /// The first packing, larger than `least_scale`, within about as many looks at words of the grid, each 2 ns. Returns
  /// whether there is one.
  bool begin_within(double looks, double least_scale);
  /// How many looks it takes at least.
  static double least_looks(const PackingProblem& problem, const PackingOptions& options);
  /// Tries one more scale, at first `first_scale`, in search of the largest. Returns whether the largest is found or
  /// lies below `least_scale`.
  bool narrow(double first_scale, double least_scale);
  /// At a given scale: tries `tries_at_once` more orders. Returns whether one of them has room for all islands.
  bool advance();
  /// Whether another order may be better.
  bool may_improve() const;

  /// The best packing, after all islands have settled.
  const Packing& settled();
  /// The best packing on the cells of the grid.
  Packing unsettled() const;

  const PackingGrid& grid() const { return grid_; }
  const PackingGrid& fine_grid();

 private:
  using Order = std::vector<int>;
  /// The different rasters of each island, one per turn.
  using TurnedRasters = std::vector<std::vector<IslandRaster>>;
  struct Spot {
    int turn = -1;  ///< index into the island's rasters; -1 if it found no room
    CellPosition at;
  };
  struct Trial {
    std::vector<Spot> spots;
    std::vector<int> without_room;
    double looks = 0;
  };

  TurnedRasters rasters(double scale) const;
  GridLayout layout() const;
  /// Puts the islands into the grid one by one. is_quick: stops at the first without room and, with many islands, skips
  /// gaps below.
  Trial put_in(const Order& order, const TurnedRasters& rasters, bool is_quick) const;
  /// Returns whether one of the orders has room for all islands; the first such order becomes the best.
  bool try_orders(const std::vector<Order>& orders, double scale, bool is_quick);
  /// 0 if no region has a whole cell.
  double first_scale() const;
  void reorder(int chain);

  const PackingProblem& problem_;
  const PackingOptions& options_;
  double fineness_;
  std::vector<std::vector<Complex>> hulls_;  ///< of each island
  std::vector<std::vector<Complex>> turns_;  ///< of each island
  PackingGrid grid_;
  std::optional<PackingGrid> fine_;  ///< made when it is needed
  std::vector<Order> first_orders_;  ///< of a first packing
  std::vector<Order> chains_;
  std::vector<std::mt19937> chances_;
  std::vector<Trial> trials_;  ///< of the last orders tried
  TurnedRasters rasters_;      ///< at rasters_scale_
  double rasters_scale_ = 0;
  double trial_scale_ = 0;  ///< the next to try; 0 before the first
  double high_ = infinity;  ///< the smallest scale without room for all
  double factor_ = 1;       ///< from one scale to the next while an end of the interval is open
  double scale_ = 0;
  Trial best_;
  TurnedRasters best_rasters_;  ///< those of the best trial
  bool is_settled_ = false;
  double looks_ = 0;  ///< of all trials
  Packing packing_;
};

}  // namespace spectral_conformal
