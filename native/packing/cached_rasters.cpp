#include "packing/cached_rasters.h"

namespace spectral_conformal {
namespace {

std::vector<std::size_t> first_turns(const std::vector<std::vector<Complex>>& turns) {
  std::vector<std::size_t> first(1, 0);
  for (const auto& of_island : turns) first.push_back(first.back() + of_island.size());
  return first;
}

}  // namespace

CachedRasters::CachedRasters(const std::vector<IslandOutline>& islands, const std::vector<std::vector<Complex>>& turns,
                             double scale, double border)
    : islands_(islands),
      turns_(turns),
      scale_(scale),
      border_(border),
      first_(first_turns(turns)),
      rasters_(first_.back()) {}

CachedRasters::~CachedRasters() {
  for (const auto& raster : rasters_) std::unique_ptr<const IslandRaster>(raster.load());
}

const IslandRaster& CachedRasters::at(int island, int turn) const {
  const auto i = static_cast<std::size_t>(island);
  const auto k = static_cast<std::size_t>(turn);
  std::atomic<const IslandRaster*>& slot = rasters_[first_[i] + k];
  if (const IslandRaster* const raster = slot.load(std::memory_order_acquire)) return *raster;
  auto made = std::make_unique<const IslandRaster>(IslandRaster::of(islands_[i], scale_ * turns_[i][k], border_));
  // Another thread may have made it in the meantime.
  const IslandRaster* expected = nullptr;
  if (!slot.compare_exchange_strong(expected, made.get(), std::memory_order_acq_rel)) return *expected;
  return *made.release();
}

}  // namespace spectral_conformal
