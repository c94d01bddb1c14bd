#include "conformal/reduced_factor.h"

#include <algorithm>
#include <numeric>

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

ReducedFactor ReducedFactor::of(const HermitianMatrix& matrix, LinearConstraints constraints, const BoundaryForm& form,
                                const Positions& positions, double relative_shift, FactorizationBackend backend,
                                const Progress& progress) {
  ReducedFactor result;
  result.relative_shift_ = relative_shift;
  result.factorize(matrix, std::move(constraints), &form, positions, backend, progress);
  return result;
}

ReducedFactor ReducedFactor::of_free(HermitianMatrix&& matrix, const BoundaryForm& form, const Positions& positions,
                                     double relative_shift, FactorizationBackend backend, const Progress& progress,
                                     std::unique_ptr<Factorization> analyzed) {
  ReducedFactor result;
  result.relative_shift_ = relative_shift;
  result.space_ = AffineSpace::free(static_cast<int>(matrix.rows()));
  result.factor_ =
      factor_shifted(std::move(matrix), positions, form, relative_shift, backend, progress, std::move(analyzed));
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
  result.factorize(matrix, std::move(constraints), nullptr, positions, backend, progress);
  return result;
}

void ReducedFactor::factorize(const HermitianMatrix& matrix, LinearConstraints constraints, const BoundaryForm* form,
                              const Positions& positions, FactorizationBackend backend, const Progress& progress) {
  std::unique_ptr<Factorization> factorization = make_factorization(backend, constraints.n_unknowns());
  report(progress, 0.0, "ordering");
  space_ = AffineSpace::of(std::move(constraints), matrix, positions, *factorization);
  if (space_.size() == 0) return;
  HermitianMatrix reduced = space_.reduced(matrix);
  const BoundaryForm diagonal = form ? space_.reduced(*form) : diagonal_of(reduced);
  if (space_.is_ordered()) {
    factorization->analyze_in_order(reduced, space_.is_real());
  } else {
    const Positions at = space_.positions_of_unknowns(positions);
    factorization->analyze(reduced, &at);
  }
  // A map with held vertices has no freedom left. With held coordinates a flat patch may have one, a scale; the shift
  // decides it, well above the rounding of the diagonal, and the refinement of a solution removes it.
  const double least_shift = space_.is_complex() ? 0 : 100 * epsilon;
  factor_ = factor_shifted(std::move(reduced), positions, diagonal, form ? relative_shift_ : least_shift, backend,
                           progress, std::move(factorization));
}

ComplexVector ReducedFactor::solve(const ComplexVector& f) {
  if (space_.size() == 0) return f;
  ComplexVector w;
  factor_.factorization->solve(f, w);
  if (springs_.targets.empty()) space_.remove_translations(w);
  return w;
}

}  // namespace spectral_conformal
