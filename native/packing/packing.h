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
  std::vector<PackingTurns> turns = {};  ///< of each island: none, quarters or free; empty for those of the options

  PackingTurns turns_of(std::size_t island, PackingTurns otherwise) const {
    return turns.empty() ? otherwise : turns[island];
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
