#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "parameterization/chart_solver.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// The work on each chart i.
struct ChartWork {
  std::function<ChartSolution(int i, const Progress& progress)> solve;
  std::function<ChartSolution(int i)> give_up;  ///< replaces a solve for which memory is too small
  std::function<void(ChartSolution&& solution)> write;
};

/// Solves all charts, small ones in parallel, large ones one after another, and writes their solutions in the order of
/// the charts. A chart that runs out of memory beside others is solved again alone before it is given up. n_faces: of
/// each chart, which measures its work. Throws std::bad_alloc if every chart is given up.
void solve_charts(const std::vector<std::size_t>& n_faces, const Progress& progress, const ChartWork& work);

}  // namespace spectral_conformal
