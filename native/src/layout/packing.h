#pragma once

#include <cstddef>
#include <vector>

#include "layout/island_outline.h"
#include "spectral_conformal/island_packing.h"
#include "spectral_conformal/plane_motion.h"

namespace spectral_conformal {

/// The islands to pack, each into its region.
struct PackingProblem {
  std::vector<IslandOutline> islands;
  std::vector<int> region;  ///< of each island, -1 for any
  IslandOutline obstacles;
  std::vector<bool> keeps_turn = {};  ///< of each island; empty if all may turn

  PackingTurns turns_of(std::size_t island, PackingTurns turns) const {
    return !keeps_turn.empty() && keeps_turn[island] ? PackingTurns::none : turns;
  }
};

struct Packing {
  double scale = 0;                  ///< 0 for none
  std::vector<PlaneMotion> motions;  ///< of each island
  std::vector<bool> has_room;
};

/// How many islands have room.
std::size_t n_with_room(const Packing& packing);
/// Whether islands that have room at this scale are points, which have room at any.
bool are_points(double scale);

}  // namespace spectral_conformal
