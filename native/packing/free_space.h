#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "packing/cell_spans.h"
#include "packing/island_raster.h"

namespace spectral_conformal {

/// The position of a raster's lower left cell.
struct CellPosition {
  int x = 0;
  int y = 0;
};

/// The free cells of a grid, and the search for a position where a raster fits.
///
/// Each row is a bit set, 1 for taken, kept at all powers of two: bit x at level k tells whether any of the 2^k cells
/// from x on is taken. A span of any length is free if two bits, those of its first and last 2^k cells, are; each word
/// answers that for 64 positions at once.
class FreeSpace {
 public:
  FreeSpace(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }
  /// The taken cells.
  std::vector<CellSpan> taken() const;
  /// Occupies the cells of the spans, moved; clipped to the grid.
  void occupy(const std::vector<CellSpan>& spans, CellPosition at);

  /// The positions to search, ends included.
  struct Window {
    int x_begin = 0;
    int x_end = 0;
    int y_begin = 0;
    int y_end = 0;
  };
  /// All positions at which a raster lies inside the grid's rows `bottom` to `top` - 1.
  Window window(const IslandRaster& raster, int bottom, int top) const;
  /// The lowest position in the window at which the raster has only free cells, the leftmost of these.
  /// Adds the words that it reads to `looks`.
  std::optional<CellPosition> lowest(const IslandRaster& raster, const Window& window, double& looks) const;
  std::optional<CellPosition> lowest(const IslandRaster& raster, const Window& window) const {
    double looks = 0;
    return lowest(raster, window, looks);
  }

 private:
  using Word = std::uint64_t;
  static constexpr int bits = 64;

  std::size_t index(int row, int level) const {
    return (static_cast<std::size_t>(row) * static_cast<std::size_t>(n_levels_) + static_cast<std::size_t>(level)) *
           static_cast<std::size_t>(n_words_);
  }
  const Word* words(int row, int level) const { return words_.data() + index(row, level); }
  Word* words(int row, int level) { return words_.data() + index(row, level); }
  void update_levels(int row, int begin, int end);

  int width_;
  int height_;
  int n_words_;
  int n_levels_;
  std::vector<Word> words_;
  std::vector<int> highest_free_;  ///< of each row: the highest level with a free bit, -1 for none
};

}  // namespace spectral_conformal
