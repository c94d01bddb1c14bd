#include "packing/settling.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "concurrency/parallel_calls.h"

namespace spectral_conformal {

Packing on_cells(const PackingGrid& grid, const GridLayout& layout) {
  const std::size_t n = layout.rasters.size();
  Packing packing;
  packing.scale = layout.scale;
  packing.motions.assign(n, {});
  packing.has_room.assign(n, false);
  for (std::size_t i = 0; i < n; ++i) {
    const IslandRaster* const raster = layout.rasters[i];
    if (raster == nullptr) continue;
    const CellPosition at = layout.at[i];
    const Complex offset = grid.pixels(raster->origin() + Complex(at.x, at.y), grid.band_of_row(at.y));
    packing.motions[i] = {raster->factor() / grid.cells_per_pixel(), false, offset};
    packing.has_room[i] = true;
  }
  return packing;
}

Packing settled(const PackingProblem& problem, const PackingGrid& grid, const PackingGrid& fine,
                const GridLayout& layout, bool scales, double precision) {
  const std::size_t n = layout.rasters.size();
  std::vector<int> order;
  for (std::size_t i = 0; i < n; ++i) {
    if (layout.rasters[i] != nullptr) order.push_back(static_cast<int>(i));
  }
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    const CellPosition p = layout.at[static_cast<std::size_t>(a)];
    const CellPosition q = layout.at[static_cast<std::size_t>(b)];
    return std::pair(p.y, p.x) < std::pair(q.y, q.x);
  });
  const auto raster_of = [&](int i) -> const IslandRaster& { return *layout.rasters[static_cast<std::size_t>(i)]; };
  struct Settled {
    std::vector<Complex> offsets;  ///< in pixels
    bool fits = true;
  };
  const auto settled_at = [&](double growth) {
    Settled result;
    result.offsets.resize(n);
    FreeSpace space = fine.space();
    for (const int i : order) {
      const IslandRaster& coarse = raster_of(i);
      const CellPosition from = layout.at[static_cast<std::size_t>(i)];
      const IslandRaster raster =
          IslandRaster::of(problem.islands[static_cast<std::size_t>(i)],
                           static_cast<double>(refinement) * growth * coarse.factor(), fine.border());
      const int band = grid.band_of_row(from.y);
      const auto& rows = fine.bands()[static_cast<std::size_t>(band)];
      FreeSpace::Window window = space.window(raster, rows.bottom, rows.top);
      const int y = rows.bottom + refinement * (from.y - grid.bands()[static_cast<std::size_t>(band)].bottom);
      const int x = refinement * from.x;
      // An island moves by some cells of the coarse grid.
      const int reach = refinement * refinement;
      window.x_begin = std::max(window.x_begin, x - reach);
      window.x_end = std::min(window.x_end, x + reach);
      window.y_begin = std::max(window.y_begin, y - reach);
      window.y_end = std::min(window.y_end, y + reach);
      const auto found = space.lowest(raster, window);
      if (!found) {
        result.fits = false;
        return result;
      }
      space.occupy(raster.spans(), *found);
      result.offsets[static_cast<std::size_t>(i)] = fine.pixels(raster.origin() + Complex(found->x, found->y), band);
    }
    return result;
  };
  Packing packing = on_cells(grid, layout);
  const auto adopt = [&](double growth, const std::vector<Complex>& offsets) {
    packing.scale = growth * layout.scale;
    for (const int i : order) {
      const auto k = static_cast<std::size_t>(i);
      packing.motions[k] = {growth * raster_of(i).factor() / grid.cells_per_pixel(), false, offsets[k]};
    }
  };
  if (!scales) return packing;
  // Several scales at a time, between the largest that fits and the smallest that does not.
  double low = 1;
  double high = max_settled_growth;
  while (high - low > precision) {
    std::vector<Settled> trials(tries_at_once);
    const auto growth = [&](int k) { return low + (high - low) * (k + 1) / (tries_at_once + 1); };
    run_in_parallel(
        tries_at_once, [&](int k, const Progress&) { trials[static_cast<std::size_t>(k)] = settled_at(growth(k)); }, {},
        "packing");
    int largest = tries_at_once - 1;
    while (largest >= 0 && !trials[static_cast<std::size_t>(largest)].fits) --largest;
    const double next_high = largest + 1 < tries_at_once ? growth(largest + 1) : high;
    if (largest >= 0) {
      low = growth(largest);
      adopt(low, trials[static_cast<std::size_t>(largest)].offsets);
    }
    high = next_high;
  }
  return packing;
}

}  // namespace spectral_conformal
