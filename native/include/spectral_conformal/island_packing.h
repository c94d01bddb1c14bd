#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "spectral_conformal/plane_motion.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

enum class PackingTurns {
  none,
  quarters,
  upright,  ///< islands get straight (straight_turn), then turn by quarters
  square,   ///< rectilinear islands as with `upright`, the others freely
  free      ///< in steps, one of which lays the island's smallest bounding rectangle along the axes
};

/// Which islands are stacked, besides those that coincide or overlap from the start.
enum class PackingStacks {
  none,
  equal,    ///< congruent ones
  mirrored  ///< congruent ones and mirror images, which get mirrored
};

/// A rectangle to fill, its sides along the axes.
struct PackingRegion {
  Complex low;
  Complex high;
};

/// All lengths are in pixels of the texture.
struct PackingOptions {
  std::vector<PackingRegion> regions;  ///< not empty; filled in this order
  /// Least distance of an island from other islands, from obstacles and from the border of its region.
  double margin = 4;
  PackingTurns turns = PackingTurns::free;
  PackingStacks stacks = PackingStacks::none;
  bool keeps_stacks = true;  ///< whether islands that coincide from the start stay stacked
  /// Whether islands that overlap from the start move as one, whatever their shapes.
  bool keeps_overlaps = false;
  /// Largest distance between the outlines of stacked islands, as a fraction of their diameter.
  double stack_tolerance = 0.01;
  /// Islands whose smallest bounding rectangle has shorter sides than this are enlarged, until the longer one is as
  /// long.
  double min_size = 0;
  bool scales = true;  ///< whether all islands are scaled by a common factor, the largest found; otherwise by 1
  std::uint32_t seed = 0;
  /// Whether the first packing does what takes a small part of the time in which the map was made; the first steps then
  /// do the rest. The work is counted, so the result does not depend on the machine.
  bool is_quick = false;
};

/// A map's islands; each moves as a whole.
struct PackingIslands {
  ComplexVector points;             ///< (V,) in pixels; finite where a face uses them
  std::vector<int> face_offsets;    ///< (F + 1,) the first corner of each face
  std::vector<int> corners;         ///< (C,) the point of each corner
  std::vector<int> island_of_face;  ///< (F,) from 0 on; -1 for faces that stay where they are, as obstacles
  std::vector<int> region;          ///< (n,) the region of each island, -1 for any
  std::vector<bool> keeps_turn;     ///< (n,) or empty: islands that turn only by a half, onto equal ones
  /// In the given layout, the islands lie at this multiple of their points. If that layout meets the options, the
  /// packing is at least as dense.
  double unit = 1;
};

/// Packs islands by their shapes: none overlaps another, and one may lie in a hole of another.
///
/// The raster of an island has every cell that the island, grown by half the margin, touches (cell_spans.h): rasters
/// without a common cell keep the margin. The first packing puts one island after the other at the position and turn
/// with the lowest top, leftmost among these (Jylanki 2010 for boxes; FreeSpace for rasters), finds the scale by
/// bisection, and lets all islands settle toward the lower left corner on a finer grid. Many islands are packed again
/// on smaller cells. Then all islands grow by small steps, and those that overlap are separated (PackingGrowth,
/// OverlapSeparation), unless there are too many. If the scale is given, other orders are tried instead: islands
/// without room go to the front. Islands below the least size are enlarged for the scale that a first packing has
/// found, which is then made again, at a lower scale, until they are large enough. A quick first packing tries fewer
/// boxes, and shapes only where counted work in proportion to the corners of the map suffices, without settling. The
/// result depends only on the input and the seed. Not from the paper.
class IslandPacking {
 public:
  /// Makes the first packing, at least as dense as by bounding boxes and, unless it is quick, as given. Throws
  /// Cancelled.
  static IslandPacking begin(const PackingIslands& islands, PackingOptions options, const Progress& progress = {});
  ~IslandPacking();
  IslandPacking(IslandPacking&&) noexcept;

  /// Tries n times to find a denser packing, four times at once; tries left over add to those of the next call. Returns
  /// whether more tries may help. Stops after `seconds`. Throws Cancelled; the packing is then the best so far.
  bool advance(int n, double seconds, const Progress& progress = {});

  const std::vector<PlaneMotion>& motions() const;  ///< of each island
  const std::vector<bool>& has_room() const;        ///< of each island; if not, it stays
  /// The representative of each island's stack, itself if it lies alone.
  const std::vector<int>& stack() const;
  double scale() const;
  double fill() const;  ///< area of the islands with room, each stack once, over that of the regions
  int steps() const;    ///< tries so far

 private:
  struct State;
  explicit IslandPacking(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace spectral_conformal
