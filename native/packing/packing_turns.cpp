#include "packing/packing_turns.h"

#include "geometry/bounding_rectangles.h"

namespace spectral_conformal {

int number_of_turns(std::size_t n_islands) {
  // The time of a trial grows with islands times turns; many small islands fill gaps anyway.
  if (n_islands <= 200) return 16;
  return n_islands <= 2000 ? 8 : 4;
}

std::vector<Complex> turns_of(const std::vector<Complex>& hull, PackingTurns turns, int n) {
  if (turns == PackingTurns::none) return {1};
  if (turns == PackingTurns::quarters) return {1, Complex(0, 1), -1, Complex(0, -1)};
  const std::vector<Rectangle> rectangles = smallest_rectangles(hull, 0);
  const Complex along = std::conj(rectangles.front().direction);
  std::vector<Complex> result;
  for (int k = 0; k < n; ++k) {
    // Quarter turns exactly.
    constexpr Complex quarter[] = {1, {0, 1}, -1, {0, -1}};
    result.push_back(along * quarter[4 * k / n] * std::polar(1.0, 2 * pi * (k % (n / 4)) / n));
  }
  return result;
}

}  // namespace spectral_conformal
