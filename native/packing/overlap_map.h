#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "packing/cell_spans.h"
#include "packing/free_space.h"
#include "packing/island_raster.h"

namespace spectral_conformal {

/// A window of a grid, without its ends.
struct CellWindow {
  int x_begin = 0;
  int x_end = 0;
  int y_begin = 0;
  int y_end = 0;
};

/// Weights of the cells of a window. Their sums along rows give the weight under a raster at any position from two
/// numbers per span.
class OverlapMap {
 public:
  /// Starts a map of this window, with weights 0.
  void begin(const CellWindow& window);
  /// Adds a weight to the cells of the moved spans; omits cells outside the window.
  void add(const std::vector<CellSpan>& spans, CellPosition at, std::int32_t weight);
  /// Call this after the last addition; the sum of a row must be below 2^31.
  void sum_rows();

  const CellWindow& window() const { return window_; }
  /// The sum of the weights under the raster, which must lie in the window; if it reaches the limit, any number that
  /// does.
  std::int64_t under(const IslandRaster& raster, CellPosition at, std::int64_t limit) const;

 private:
  CellWindow window_;
  std::size_t height_ = 0;
  /// Column by column, so that all rows are summed at once. For each row, the sums of the weights before each cell;
  /// before sum_rows, the changes of the weight, shifted by one.
  std::vector<std::int32_t> sums_;
  std::vector<std::int32_t> weights_;  ///< of a column
};

}  // namespace spectral_conformal
