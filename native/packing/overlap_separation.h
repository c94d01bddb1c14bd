#pragma once

#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "packing/cached_rasters.h"
#include "packing/island_raster.h"
#include "packing/overlap_map.h"
#include "packing/packing.h"
#include "packing/packing_grid.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The turn and position of an island on a grid.
struct IslandPose {
  int turn = 0;    ///< index into the island's turns
  Complex middle;  ///< of its bounding box before the turn, in cells
};

enum class MoveRange {
  anywhere,
  nearby  ///< by some cells
};

/// The search for positions and turns at which islands of one scale do not overlap.
///
/// Minimizes F = sum_ij w_ij |R_i n R_j|, the shared cells of the rasters R of islands i and j, with the obstacles as
/// one more island: an island that overlaps moves to the least F among positions and turns near its own and anywhere;
/// after each pass, w_ij grows for pairs that overlap and falls toward 1 for the others (guided local search for
/// packing: Egeblad, Nielsen, Odgaard 2007; Umetani et al. 2009; samples instead of axis-wise minima and the weights of
/// Gardeyn, Vanden Berghe, Wauters 2025). Not from the paper.
class OverlapSeparation {
 public:
  /// turns: of each island, none, quarters or a multiple of 16. by_quarters: the islands that, if they move anywhere,
  /// turn by quarters from the first of their turns. All but by_quarters must outlive the object.
  OverlapSeparation(const PackingProblem& problem, const PackingGrid& grid,
                    const std::vector<std::vector<Complex>>& turns, std::vector<bool> by_quarters, MoveRange range,
                    std::uint32_t seed);

  /// Starts from the poses, with all weights 1. Returns whether every island's raster is within its region.
  bool start(std::shared_ptr<const CachedRasters> rasters, const std::vector<IslandPose>& poses);
  /// Two islands of about the same area change places.
  void swap_two();
  /// Each overlapping island moves once. Returns whether no two overlap.
  bool pass();

  int n_overlapping_cells() const { return n_overlapping_cells_; }
  std::vector<IslandPose> poses() const;
  /// The middle of an island's bounding box before scale and turn.
  Complex middle_before(int island) const { return middles_[static_cast<std::size_t>(island)]; }
  const IslandRaster& raster(int island) const;
  CellPosition position(int island) const { return spots_[static_cast<std::size_t>(island)].at; }

 private:
  struct Spot {
    int turn = 0;
    CellPosition at;
  };
  struct Pair {
    int other = 0;  ///< an island, or the number of islands for obstacles
    double weight = 1;
    int cells = 0;  ///< that overlap
  };
  struct Candidate {
    std::int64_t cost = 0;
    Spot spot;
  };

  Complex middle(int island, const Spot& spot) const;
  Spot spot_at(int island, const IslandPose& pose) const;
  CellWindow region_of(int island) const;
  /// Moves the raster into the window, if it is not larger.
  static bool clamp(const IslandRaster& raster, const CellWindow& window, CellPosition& at);
  int shared_cells(int i, int j) const;
  int taken_cells(int island) const;
  void measure_pairs();
  void reweigh();
  void draw_map(int island, const CellWindow& window);
  std::int64_t present_cost(int island) const;
  std::int32_t weight_of(int island, int other) const;
  void move(int island);
  /// The window that a move sees.
  CellWindow window_about(int island);
  Candidate refined(int island, Candidate from) const;
  int below(int n) { return static_cast<int>(chance_() % static_cast<std::uint32_t>(n)); }
  double uniform();

  const PackingProblem& problem_;
  const PackingGrid& grid_;
  const std::vector<std::vector<Complex>>& turns_;
  std::vector<int> by_area_;     ///< the islands by rising area
  std::vector<int> turn_units_;  ///< of each island: it uses every turn_units_-th of its turns
  MoveRange range_;
  int n_;
  double max_weight_;  ///< and the unit of weights on the map
  std::mt19937 chance_;
  std::vector<Complex> middles_;  ///< of each island's bounding box
  std::vector<CellSpan> taken_;   ///< by obstacles
  std::shared_ptr<const CachedRasters> rasters_;
  std::vector<Spot> spots_;
  std::vector<std::vector<Pair>> pairs_;  ///< of each island: those that overlap or have a weight above 1, by `other`
  OverlapMap map_;
  int n_overlapping_cells_ = 0;
};

}  // namespace spectral_conformal
