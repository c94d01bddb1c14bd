#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "packing/max_treap.h"
#include "spectral_conformal/box_packing.h"

namespace spectral_conformal {

/// The upper border of the boxes packed from below in a strip [0, width] (Jylanki, "A Thousand Ways to Pack the Bin",
/// 2010, section 4). Each box goes to the position with the lowest top, and among these to the leftmost.
///
/// The level run of a segment is the longest piece of the border around it that is nowhere higher. The lowest position
/// of a box is at the start of a run, since elsewhere the box could move left: the run of the lowest segment whose run
/// is wide enough. Runs only shrink, so the width of a run last found too narrow bounds it from above. A search over
/// the segments by height, with these bounds, takes O(log n), and so does finding the ends of a run. The total is O(n
/// log n) if few runs shrink between two searches that try them.
class Skyline {
 public:
  explicit Skyline(double width);

  /// Sets the box's x and y.
  void put(PackedBox& box);

 private:
  struct Segment {
    double x = 0;
    double y = 0;
    double end = 0;
    int before = MaxTreap::none;
    int behind = MaxTreap::none;
  };

  const Segment& segment(int i) const { return segments_[static_cast<std::size_t>(i)]; }
  Segment& segment(int i) { return segments_[static_cast<std::size_t>(i)]; }
  struct Run {
    int first = MaxTreap::none;  ///< segment
    double y = 0;
  };
  /// The lowest run that is wide enough; the leftmost of equally low ones.
  Run lowest_run(double width);
  void insert_before(int at, double x, double y, double end);
  void erase(int i);
  void raise(int first, const PackedBox& box);

  static constexpr int left_end = 0;   ///< infinitely high, like the right end
  static constexpr int right_end = 1;  ///< begins at the strip's width
  std::vector<Segment> segments_;      ///< including removed ones
  MaxTreap along_;                     ///< from left to right; values: heights
  MaxTreap by_height_;  ///< from low to high, then from left to right; values: bounds of the runs' widths
};

}  // namespace spectral_conformal
