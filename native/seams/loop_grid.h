#pragma once

#include <array>
#include <vector>

#include "seams/edge_flow.h"
#include "seams/seam_graph.h"

namespace spectral_conformal {

/// Two families of closed edge loops (EdgeLoops), each of which crosses every loop of the other family once: those of a
/// torus of quads, or of a pipe with walls and rims.
struct LoopGrid {
  /// All grids among some loops.
  static std::vector<LoopGrid> of(const SeamGraph& graph, const EdgeLoops& loops);

  std::array<std::vector<int>, 2> families;  ///< loops, as indices into EdgeLoops::loops, each in order around
};

/// Choices of `count` loops of a family, evenly spaced: the cheapest, and this one shifted by quarters of its period.
/// Only one if all loops cost the same, which are then taken to be alike. costs: of every loop. Precondition: 0 < count
/// <= the family's size.
std::vector<std::vector<int>> evenly_spaced(const std::vector<int>& family, int count,
                                            const std::vector<double>& costs);

}  // namespace spectral_conformal
