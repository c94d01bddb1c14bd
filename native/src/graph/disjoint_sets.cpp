#include "graph/disjoint_sets.h"

#include <cstddef>
#include <numeric>

namespace spectral_conformal {

DisjointSets::DisjointSets(int n) : parent_(static_cast<std::size_t>(n)) { separate(); }

void DisjointSets::separate() { std::iota(parent_.begin(), parent_.end(), 0); }

}  // namespace spectral_conformal
