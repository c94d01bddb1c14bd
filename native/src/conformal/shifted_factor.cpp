#include "conformal/shifted_factor.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace spectral_conformal {

ShiftedFactor factor_shifted(const HermitianMatrix& matrix, const Positions& positions, const BoundaryForm& form,
                             double relative_shift, FactorizationBackend backend, const Progress& progress) {
  ShiftedFactor result;
  HermitianMatrix shifted;  // Eigen 3.4's copy constructor leaks where memory runs out
  shifted = matrix;
  const auto diagonal = [&matrix](int v) { return matrix.valuePtr()[matrix.outerIndexPtr()[v]]; };
  // The median withstands the huge entries of tiny triangles, next to which a shift would drown the small eigenvalues.
  std::vector<double> ratios;
  ratios.reserve(form.vertices.size());
  for (std::size_t i = 0; i < form.vertices.size(); ++i) {
    ratios.push_back(diagonal(form.vertices[i]).real() / form.mass[static_cast<Eigen::Index>(i)]);
  }
  const auto median = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), median, ratios.end());
  const double unit = *median;
  result.factorization = make_factorization(backend, shifted.rows());
  report(progress, 0.0, "ordering");
  result.factorization->analyze(shifted, &positions);
  // To 1e8 times the given shift, from the first attempt's 1e-12 to 1e-4: beyond that the corrections no longer
  // converge in their bounded number.
  constexpr int max_raises = 4;
  constexpr double raise_factor = 100;
  for (int raise = 0; raise <= max_raises; ++raise) {
    report(progress, 0.2, "factorization");
    result.shift = relative_shift * std::pow(raise_factor, raise) * unit;
    for (std::size_t i = 0; i < form.vertices.size(); ++i) {
      const int v = form.vertices[i];
      // Section 3.4, with s M instead of epsilon I: L + s M.
      shifted.valuePtr()[shifted.outerIndexPtr()[v]] =
          diagonal(v) + result.shift * form.mass[static_cast<Eigen::Index>(i)];
    }
    if (result.factorization->factorize(shifted)) return result;
  }
  result.factorization.reset();
  return result;
}

}  // namespace spectral_conformal
