#pragma once

#include <cstddef>
#include <vector>

#include "layout/island_outline.h"
#include "packing/cell_spans.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Cells across a region with few islands, or an outline: a step of a cell is then a few thousandths.
constexpr double cells_across = 512;
/// The width in cells of an island of mean size among many, which loses about one cell to its raster.
constexpr double cells_per_island = 28;

/// A span of cells, covered by two spans of 2^level cells.
struct CoveredSpan {
  int row = 0;
  int level = 0;
  int first = 0;   ///< the first cell of one
  int second = 0;  ///< the first cell of the other
};

/// The cells of an island and a border around it (cell_spans), at one scale and turn, moved to the corner of the plane.
class IslandRaster {
 public:
  /// The island after z -> factor z. border: in cells, nonnegative.
  static IslandRaster of(const IslandOutline& outline, Complex factor, double border);

  int width() const { return width_; }
  int height() const { return height_; }
  Complex factor() const { return factor_; }
  /// The island's point z lies at factor z + origin in the raster's cells.
  Complex origin() const { return origin_; }
  const std::vector<CellSpan>& spans() const { return spans_; }
  /// The spans from the longest to the shortest, which reveals unfit positions early.
  const std::vector<CoveredSpan>& longest_first() const { return longest_first_; }
  bool has_same_cells(const IslandRaster& other) const;

 private:
  int width_ = 0;
  int height_ = 0;
  Complex factor_ = 1;
  Complex origin_ = 0;
  std::vector<CellSpan> spans_;
  std::vector<CoveredSpan> longest_first_;
};

}  // namespace spectral_conformal
