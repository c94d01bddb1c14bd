#include "packing/overlap_map.h"

#include <algorithm>

namespace spectral_conformal {

void OverlapMap::begin(const CellWindow& window) {
  window_ = window;
  height_ = static_cast<std::size_t>(window.y_end - window.y_begin);
  // Before the first cell, and a change after the last.
  const std::size_t columns = static_cast<std::size_t>(window.x_end - window.x_begin) + 2;
  sums_.assign(columns * height_, 0);
}

void OverlapMap::add(const std::vector<CellSpan>& spans, CellPosition at, std::int32_t weight) {
  const int width = window_.x_end - window_.x_begin;
  const int left = at.x - window_.x_begin;
  const int bottom = at.y - window_.y_begin;
  auto span =
      std::lower_bound(spans.begin(), spans.end(), -bottom, [](const CellSpan& s, int row) { return s.row < row; });
  const int rows = window_.y_end - window_.y_begin;
  for (; span != spans.end() && bottom + span->row < rows; ++span) {
    const int begin = std::max(0, left + span->begin);
    const int end = std::min(width, left + span->end);
    if (begin >= end) continue;
    std::int32_t* const first = sums_.data() + height_ + static_cast<std::size_t>(bottom + span->row);
    first[static_cast<std::size_t>(begin) * height_] += weight;
    first[static_cast<std::size_t>(end) * height_] -= weight;
  }
}

void OverlapMap::sum_rows() {
  weights_.assign(height_, 0);
  std::int32_t* const weight = weights_.data();
  for (std::size_t first = height_; first < sums_.size(); first += height_) {
    std::int32_t* const column = sums_.data() + first;
    const std::int32_t* const before = column - height_;
    for (std::size_t y = 0; y < height_; ++y) {
      weight[y] += column[y];
      column[y] = before[y] + weight[y];
    }
  }
}

std::int64_t OverlapMap::under(const IslandRaster& raster, CellPosition at, std::int64_t limit) const {
  const std::int32_t* const corner = sums_.data() + static_cast<std::size_t>(at.x - window_.x_begin) * height_ +
                                     static_cast<std::size_t>(at.y - window_.y_begin);
  std::int64_t sum = 0;
  for (const CoveredSpan& span : raster.longest_first()) {
    const std::int32_t* const row = corner + span.row;
    sum += row[static_cast<std::size_t>(span.second + (1 << span.level)) * height_] -
           row[static_cast<std::size_t>(span.first) * height_];
    if (sum >= limit) break;
  }
  return sum;
}

}  // namespace spectral_conformal
