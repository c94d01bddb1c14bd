#include "mesh/welded_corners.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <tuple>

#include "concurrency/cancellation_scope.h"
#include "concurrency/work_counter.h"
#include "graph/grouped.h"

namespace spectral_conformal {
namespace {

/// Orders all numbers, also those that are NaN.
std::uint64_t bits_of(double x) {
  // Both zeros are one number.
  const double value = x + 0.0;
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

}  // namespace

WeldedCorners welded_corners(const int* vertices, const int* islands, const Complex* uv, int n_corners,
                             int n_vertices) {
  WeldedCorners welded;
  welded.point.resize(static_cast<std::size_t>(n_corners));
  count_steps(n_corners);
  Grouped<int> at_vertex(n_vertices, [&](const auto& visit) {
    for (int c = 0; c < n_corners; ++c) visit(vertices[c], c);
  });
  const auto key = [&](int c) { return std::tuple(islands[c], bits_of(uv[c].real()), bits_of(uv[c].imag())); };
  const auto before = [&](int a, int b) { return key(a) < key(b); };
  for_each_polled(n_vertices, [&](int vertex) {
    const auto corners = at_vertex[vertex];
    // At most vertices, all corners have one point.
    const auto other = [&](int corner) { return key(corner) != key(*corners.begin()); };
    if (std::any_of(corners.begin(), corners.end(), other)) std::sort(corners.begin(), corners.end(), before);
    int previous = -1;
    for (const int corner : corners) {
      if (previous < 0 || key(corner) != key(previous)) welded.first_corner.push_back(corner);
      welded.point[static_cast<std::size_t>(corner)] = static_cast<int>(welded.first_corner.size()) - 1;
      previous = corner;
    }
  });
  return welded;
}

}  // namespace spectral_conformal
