#include "conformal/shifted_factor.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "geometry/tolerances.h"

namespace spectral_conformal {

ShiftedFactor factor_shifted(HermitianMatrix&& matrix, const Positions& positions, const BoundaryForm& form,
                             double relative_shift, FactorizationBackend backend, const Progress& progress,
                             std::unique_ptr<Factorization> analyzed) {
  ShiftedFactor result;
  if (form.vertices.empty()) return result;  // L alone is singular
  const auto diagonal = [&matrix](int v) -> Complex& { return matrix.valuePtr()[matrix.outerIndexPtr()[v]]; };
  for (int v = 0; v < matrix.outerSize(); ++v) result.max_diagonal = std::max(result.max_diagonal, diagonal(v).real());
  std::vector<Complex> unshifted;
  unshifted.reserve(form.vertices.size());
  for (const int v : form.vertices) unshifted.push_back(diagonal(v));
  // The median is robust against the huge entries of tiny triangles; a shift of their size would drown the small
  // eigenvalues.
  std::vector<double> ratios;
  ratios.reserve(form.vertices.size());
  for (std::size_t i = 0; i < form.vertices.size(); ++i) {
    ratios.push_back(unshifted[i].real() / form.mass[static_cast<Eigen::Index>(i)]);
  }
  const auto median = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), median, ratios.end());
  const double unit = *median;
  result.factorization = std::move(analyzed);
  if (!result.factorization) {
    result.factorization = make_factorization(backend, matrix.rows());
    report(progress, 0.0, "ordering");
    result.factorization->analyze(matrix, &positions);
  }
  // From none to a little more than the rounding of the diagonal.
  const auto raised = [](double shift) { return shift > 0 ? 100 * shift : 10 * epsilon; };
  for (; relative_shift < 0.5; relative_shift = raised(relative_shift)) {
    report(progress, 0.2, "factorization");
    result.shift = relative_shift * unit;
    for (std::size_t i = 0; i < form.vertices.size(); ++i) {
      // Section 3.4, with s M instead of epsilon I: L + s M.
      diagonal(form.vertices[i]) = unshifted[i] + result.shift * form.mass[static_cast<Eigen::Index>(i)];
    }
    if (result.factorization->factorize(matrix)) return result;
  }
  result.factorization.reset();
  return result;
}

}  // namespace spectral_conformal
