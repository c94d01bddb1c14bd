#pragma once

#include <cstddef>
#include <vector>

#include "spectral_conformal/island_packing.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The number of steps of a full turn in a coarse search, a multiple of 4 so that rectangles stay along the axes.
int number_of_turns(std::size_t n_islands);

/// The turns to try for an island, as factors of length 1: none, quarter turns, or n steps of a full turn; the first
/// step lays the smallest rectangle around the hull along the axes. n: a multiple of 4, to include its quarter turns.
std::vector<Complex> turns_of(const std::vector<Complex>& hull, PackingTurns turns, int n);

}  // namespace spectral_conformal
