#include "conformal/reduced_factor.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "geometry/tolerances.h"

namespace spectral_conformal {
namespace {

/// The diagonal, as a form.
BoundaryForm diagonal_of(const HermitianMatrix& matrix) {
  BoundaryForm result;
  std::vector<double> mass;
  for (int k = 0; k < matrix.rows(); ++k) {
    const double entry = matrix.valuePtr()[matrix.outerIndexPtr()[k]].real();
    if (!(entry > 0)) continue;
    result.vertices.push_back(k);
    mass.push_back(entry);
  }
  result.mass = Eigen::Map<const Eigen::VectorXd>(mass.data(), static_cast<Eigen::Index>(mass.size()));
  return result;
}

}  // namespace

bool Springs::match(const Springs& others) const {
  const auto have_same_end = [](const auto& a, const auto& b) { return a.first == b.first; };
  return stiffness == others.stiffness &&
         std::equal(targets.begin(), targets.end(), others.targets.begin(), others.targets.end(), have_same_end);
}

ReducedFactor ReducedFactor::of(HermitianMatrix&& matrix, std::optional<LinearConstraints> constraints,
                                const BoundaryForm& form, const Positions& positions, double relative_shift,
                                FactorizationBackend backend, const Progress& progress,
                                std::unique_ptr<Factorization> analyzed) {
  ReducedFactor result;
  result.relative_shift_ = relative_shift;
  result.factorize(std::move(matrix), std::move(constraints), &form, positions, backend, progress, std::move(analyzed));
  return result;
}

ReducedFactor ReducedFactor::of_held(const ConformalEnergy& energy, LinearConstraints constraints,
                                     const Positions& positions, FactorizationBackend backend, const Progress& progress,
                                     Springs springs) {
  HermitianMatrix matrix = energy.matrix();
  // The diagonal comes first in each column.
  for (const auto& spring : springs.targets)
    matrix.valuePtr()[matrix.outerIndexPtr()[spring.first]] += springs.stiffness;
  ReducedFactor result;
  result.springs_ = std::move(springs);
  result.factorize(std::move(matrix), std::move(constraints), nullptr, positions, backend, progress, nullptr);
  return result;
}

void ReducedFactor::factorize(HermitianMatrix&& matrix, std::optional<LinearConstraints> constraints,
                              const BoundaryForm* form, const Positions& positions, FactorizationBackend backend,
                              const Progress& progress, std::unique_ptr<Factorization> factorization) {
  const bool is_analyzed = factorization != nullptr;
  if (!is_analyzed) {
    factorization = make_factorization(backend, constraints ? constraints->n_unknowns() : matrix.rows());
    report(progress, 0.0, "ordering");
  }
  space_ = constraints ? AffineSpace::of(std::move(*constraints), matrix, positions, *factorization)
                       : AffineSpace::free(static_cast<int>(matrix.rows()));
  if (!space_.is_free()) {
    HermitianMatrix reduced = space_.reduced(matrix);
    matrix.swap(reduced);
  }
  const BoundaryForm mass = form ? space_.reduced(*form) : diagonal_of(matrix);
  if (mass.vertices.empty()) return;
  if (!is_analyzed && space_.is_ordered()) {
    factorization->analyze_in_order(matrix, space_.is_real());
  } else if (!is_analyzed) {
    const Positions at = space_.positions_of_unknowns(positions);
    factorization->analyze(matrix, &at);
  }
  const auto diagonal = [&matrix](int k) -> Complex& { return matrix.valuePtr()[matrix.outerIndexPtr()[k]]; };
  for (int k = 0; k < matrix.outerSize(); ++k) max_diagonal_ = std::max(max_diagonal_, diagonal(k).real());
  std::vector<Complex> unshifted;
  std::vector<double> ratios;
  for (std::size_t i = 0; i < mass.vertices.size(); ++i) {
    unshifted.push_back(diagonal(mass.vertices[i]));
    ratios.push_back(unshifted[i].real() / mass.mass[static_cast<Eigen::Index>(i)]);
  }
  // The median is robust against the huge entries of tiny triangles; a shift of their size would drown the small
  // eigenvalues.
  const auto median = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), median, ratios.end());
  // A map with held vertices has no freedom left. With held coordinates a flat patch may have one, a scale; the shift
  // decides it, well above the rounding of the diagonal, and the refinement of a solution removes it.
  double relative_shift = form ? relative_shift_ : space_.is_complex() ? 0 : 100 * epsilon;
  // From none to a little more than the rounding of the diagonal.
  const auto raised = [](double shift) { return shift > 0 ? 100 * shift : 10 * epsilon; };
  for (; relative_shift < 0.5; relative_shift = raised(relative_shift)) {
    report(progress, 0.2, "factorization");
    shift_ = relative_shift * *median;
    for (std::size_t i = 0; i < mass.vertices.size(); ++i) {
      // Section 3.4, with s D instead of epsilon I.
      diagonal(mass.vertices[i]) = unshifted[i] + shift_ * mass.mass[static_cast<Eigen::Index>(i)];
    }
    if (!factorization->factorize(matrix)) continue;
    factorization_ = std::move(factorization);
    return;
  }
}

ComplexVector ReducedFactor::solve(const ComplexVector& f) {
  if (space_.size() == 0) return f;
  ComplexVector w;
  factorization_->solve(f, w);
  if (springs_.targets.empty()) space_.remove_translations(w);
  return w;
}

}  // namespace spectral_conformal
