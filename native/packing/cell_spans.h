#pragma once

#include <vector>

#include "layout/island_outline.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Cells of a row, from `begin` to `end` - 1; a cell is a square of side 1.
struct CellSpan {
  int row = 0;
  int begin = 0;
  int end = 0;
  bool operator==(const CellSpan& other) const { return row == other.row && begin == other.begin && end == other.end; }
};

/// All cells that an outline and a border of this width around it touch, after z -> factor z + origin: two outlines
/// whose spans share no cell are at least twice that width apart. Sorted by row, then from left to right; spans do not
/// touch each other. Only rows 0 to n_rows - 1; columns are not bounded. border: in cells, nonnegative.
std::vector<CellSpan> cell_spans(const std::vector<OutlineEdge>& edges, Complex factor, Complex origin, double border,
                                 int n_rows);

}  // namespace spectral_conformal
