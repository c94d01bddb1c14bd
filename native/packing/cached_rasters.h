#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <vector>

#include "layout/island_outline.h"
#include "packing/island_raster.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The rasters of islands at one scale, one per turn, each made when it is first used. Threads may share it.
class CachedRasters {
 public:
  /// turns: of each island, factors of length 1. scale: cells per unit of the outlines. Both must outlive the object.
  CachedRasters(const std::vector<IslandOutline>& islands, const std::vector<std::vector<Complex>>& turns, double scale,
                double border);
  ~CachedRasters();
  CachedRasters(const CachedRasters&) = delete;
  CachedRasters& operator=(const CachedRasters&) = delete;

  double scale() const { return scale_; }
  const IslandRaster& at(int island, int turn) const;

 private:
  const std::vector<IslandOutline>& islands_;
  const std::vector<std::vector<Complex>>& turns_;
  double scale_;
  double border_;
  std::vector<std::size_t> first_;  ///< of each island's rasters
  mutable std::vector<std::atomic<const IslandRaster*>> rasters_;
};

}  // namespace spectral_conformal
