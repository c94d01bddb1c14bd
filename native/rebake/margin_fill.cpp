#include "spectral_conformal/margin_fill.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "concurrency/parallel_calls.h"

namespace spectral_conformal {
namespace {

using Row = std::uint16_t;
constexpr Row no_row = std::numeric_limits<Row>::max();
static_assert(max_image_side <= no_row);

/// The covered texel of each column that is nearest to each texel of it, (height, width): its row, or no_row.
std::vector<Row> nearest_in_columns(const TargetImage& image) {
  const auto width = static_cast<std::size_t>(image.width);
  const auto height = static_cast<std::size_t>(image.height);
  std::vector<Row> nearest(width * height, no_row);
  run_blocks_in_parallel(width, std::max(std::size_t{1}, 500'000 / height), [&](std::size_t begin, std::size_t end) {
    std::vector<Row> last(end - begin, no_row);
    for (std::size_t y = 0; y < height; ++y) {
      for (std::size_t x = begin; x < end; ++x) {
        if (image.coverage[y * width + x] != 0) last[x - begin] = static_cast<Row>(y);
        nearest[y * width + x] = last[x - begin];
      }
    }
    last.assign(end - begin, no_row);
    for (std::size_t y = height; y-- > 0;) {
      for (std::size_t x = begin; x < end; ++x) {
        if (image.coverage[y * width + x] != 0) last[x - begin] = static_cast<Row>(y);
        const Row below = last[x - begin];
        Row& above = nearest[y * width + x];
        if (below != no_row && (above == no_row || below - y < y - above)) above = below;
      }
    }
  });
  return nearest;
}

/// The columns whose texel is the nearest one for some texel of a row, from left to right: the lower envelope of the
/// parabolas (x - column)^2 + distance(column)^2 (Felzenszwalb and Huttenlocher, "Distance Transforms of Sampled
/// Functions", 2012).
struct Envelope {
  std::vector<int> columns;
  std::vector<double> begins;  ///< of the part of the row where each is lowest

  void fill(const Row* nearest, int width, int y) {
    columns.clear();
    begins.clear();
    const auto height_of = [&](int x) {
      const double distance = static_cast<double>(nearest[x]) - y;
      return distance * distance + static_cast<double>(x) * x;
    };
    for (int x = 0; x < width; ++x) {
      if (nearest[x] == no_row) continue;
      double begin = -std::numeric_limits<double>::infinity();
      while (!columns.empty()) {
        const int before = columns.back();
        begin = (height_of(x) - height_of(before)) / (2.0 * (x - before));
        if (begin > begins.back()) break;
        columns.pop_back();
        begins.pop_back();
        begin = -std::numeric_limits<double>::infinity();
      }
      columns.push_back(x);
      begins.push_back(begin);
    }
  }
};

}  // namespace

void fill_margin(const TargetImage& image) {
  const std::vector<Row> nearest = nearest_in_columns(image);
  const auto width = static_cast<std::size_t>(image.width);
  const std::size_t channel = image.type == PixelType::uint8 ? 1 : image.type == PixelType::uint16 ? 2 : 4;
  const std::size_t size = channel * static_cast<std::size_t>(image.n_channels);
  auto* const pixels = static_cast<unsigned char*>(image.pixels);
  run_blocks_in_parallel(image.height, std::max(1, 100'000 / image.width), [&](int begin, int end) {
    Envelope envelope;
    for (int y = begin; y < end; ++y) {
      const std::size_t row = static_cast<std::size_t>(y) * width;
      if (std::memchr(image.coverage + row, 0, width) == nullptr) continue;
      envelope.fill(nearest.data() + row, image.width, y);
      if (envelope.columns.empty()) continue;
      std::size_t k = 0;
      for (int x = 0; x < image.width; ++x) {
        while (k + 1 < envelope.columns.size() && envelope.begins[k + 1] < x) ++k;
        const std::size_t here = row + static_cast<std::size_t>(x);
        if (image.coverage[here] != 0) continue;
        const auto column = static_cast<std::size_t>(envelope.columns[k]);
        const std::size_t there = nearest[row + column] * width + column;
        std::memcpy(pixels + here * size, pixels + there * size, size);
      }
    }
  });
}

}  // namespace spectral_conformal
