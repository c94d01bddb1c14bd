#pragma once

#include <vector>

#include "spectral_conformal/island_packing.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The turns to try for an island, as factors of length 1: none, quarter turns, or n steps of a full turn; the first
/// step lays the smallest rectangle around the hull along the axes. n: a multiple of 4, to include its quarter turns.
std::vector<Complex> turns_of(const std::vector<Complex>& hull, PackingTurns turns, int n);

}  // namespace spectral_conformal
