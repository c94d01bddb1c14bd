#pragma once

#include <optional>
#include <vector>

#include "layout/island_outline.h"
#include "spectral_conformal/plane_motion.h"

namespace spectral_conformal {

enum class Congruence {
  in_place,  ///< they coincide as they are
  moved,     ///< after a turn and a move
  mirrored   ///< also after a reflection
};

/// An island of a stack.
struct StackedIsland {
  int representative = 0;  ///< of its stack; itself if it lies alone
  PlaneMotion onto;        ///< moves it onto the representative
};

/// Whether all ends of the island's edges, after the motion, lie on the other outline up to the tolerance.
bool lies_on(const IslandOutline& island, const PlaneMotion& motion, const IslandOutline& other, double tolerance);

/// The islands with the same outline: no point of one is farther from the other than `tolerance` times the larger
/// diameter. The meshes inside the outlines may differ.
std::vector<StackedIsland> congruent_islands(const std::vector<IslandOutline>& islands, Congruence congruence,
                                             double tolerance);

}  // namespace spectral_conformal
