#include "rebake/border_sides.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "graph/grouped.h"

namespace spectral_conformal {
namespace {

/// The other corner of a side, and the number of the side.
using Side = std::pair<int, int>;

}  // namespace

std::vector<int> border_sides(const int* triangles, int n_triangles) {
  const std::size_t n_sides = 3 * static_cast<std::size_t>(n_triangles);
  const int n_corners = n_sides == 0 ? 0 : *std::max_element(triangles, triangles + n_sides) + 1;
  Grouped<Side> sides(n_corners, [&](const auto& visit) {
    for (int number = 0; number < 3 * n_triangles; ++number) {
      const auto [low, high] = std::minmax({triangles[number], triangles[number % 3 == 2 ? number - 2 : number + 1]});
      visit(low, Side{high, number});
    }
  });
  std::vector<int> found;
  for (int corner = 0; corner < n_corners; ++corner) {
    const auto own = sides[corner];
    std::sort(own.begin(), own.end());
    for (const Side* side = own.begin(); side != own.end();) {
      const Side* const next = std::find_if(side, static_cast<const Side*>(own.end()),
                                            [&](const Side& other) { return other.first != side->first; });
      if (next - side == 1) found.push_back(side->second);
      side = next;
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace spectral_conformal
