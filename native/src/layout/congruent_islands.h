#pragma once

#include <optional>
#include <vector>

#include "layout/island_outline.h"
#include "spectral_conformal/plane_motion.h"

namespace spectral_conformal {

enum class Congruence {
  in_place,  ///< one lies on the other as it is
  moved,     ///< after a turn and a move
  mirrored   ///< also after a reflection
};

/// An island of a stack.
struct StackedIsland {
  int representative = 0;  ///< of its stack; itself if it lies alone
  PlaneMotion onto;        ///< moves it onto the representative
};

/// Which islands have the same outline: no point of one is farther from the other than `tolerance` times the
/// larger diameter. Meshes inside of the outlines may differ.
std::vector<StackedIsland> congruent_islands(const std::vector<IslandOutline>& islands, Congruence congruence,
                                             double tolerance);

}  // namespace spectral_conformal
