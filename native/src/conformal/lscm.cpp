#include "conformal/lscm.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "conformal/conjugate_gradients.h"
#include "conformal/correction.h"
#include "geometry/tolerances.h"

namespace spectral_conformal {
namespace {

/// The rows and columns of the free vertices, in their order.
HermitianMatrix free_block(const HermitianMatrix& matrix, const std::vector<int>& free_index, int n_free) {
  HermitianMatrix block(n_free, n_free);
  block.reserve(matrix.nonZeros());
  for (int column = 0; column < matrix.outerSize(); ++column) {
    if (free_index[column] < 0) continue;
    block.startVec(free_index[column]);
    for (HermitianMatrix::InnerIterator it(matrix, column); it; ++it) {
      if (free_index[it.row()] >= 0) block.insertBack(free_index[it.row()], free_index[column]) = it.value();
    }
  }
  block.finalize();
  return block;
}

/// A solution in progress: L z = force at the free vertices.
class PinnedSystem {
 public:
  PinnedSystem(const ConformalEnergy& energy, PinnedFactor& factor, const ComplexVector* force, ComplexVector& z,
               const Progress& progress, double tolerance)
      : energy_(energy),
        factor_(factor),
        force_(force),
        z_(z),
        center_(z.mean()),
        progress_(progress),
        is_single_(tolerance > single_epsilon) {}

  void solve() {
    if (factor_.is_definite()) refine();
    if (!(change() < single_epsilon)) change_ = conjugate_gradients<ComplexVector>(*this);
  }
  /// The remaining error, relative to z.
  double change() const { return change_; }

  // Of conjugate_gradients.h.
  ComplexVector residual() {
    energy_.apply(z_, gradient_);
    if (force_) gradient_ -= *force_;
    return -factor_.gathered(gradient_);
  }
  ComplexVector preconditioned(const ComplexVector& r) {
    ComplexVector w;
    factor_.solve(r, w);
    return w;
  }
  double curvature(const ComplexVector& p) {
    whole_ = factor_.scattered(p);
    return energy_.apply(whole_, gradient_);
  }
  void move(double alpha) { z_ += alpha * whole_; }
  double relative(const ComplexVector& step) const { return step.norm() / (z_.array() - center_).matrix().norm(); }
  void still_working(int k) const { report(progress_, 1.0 - 0.2 / (1.0 + 0.05 * k), "solve"); }

 private:
  /// Takes whole steps (the factor's solution for the residual) while they halve the residual, or until single
  /// precision is enough.
  void refine() {
    double before = infinity;
    ComplexVector step;
    while (true) {
      const ComplexVector rhs = residual();
      const double norm = rhs.norm();
      if (!(norm < 0.5 * before)) break;  // rounding is reached
      before = norm;
      factor_.solve(rhs, step);
      z_ += factor_.scattered(step);
      const double last = std::exchange(change_, relative(step));
      if (std::isfinite(last) && !std::isfinite(factor_.contraction())) factor_.set_contraction(change_ / last);
      const double error = change_ * factor_.contraction();
      if (!is_single_ || !(error < single_epsilon)) continue;
      change_ = error;
      return;
    }
  }

  const ConformalEnergy& energy_;
  PinnedFactor& factor_;
  const ComplexVector* force_;  ///< or none
  ComplexVector& z_;
  Complex center_;
  const Progress& progress_;
  bool is_single_;
  ComplexVector gradient_;
  ComplexVector whole_;  ///< the direction of conjugate gradients
  double change_ = infinity;
};

}  // namespace

PinnedFactor PinnedFactor::of(const ConformalEnergy& energy, const Pins& pins, FactorizationBackend backend,
                              const Progress& progress) {
  PinnedFactor result;
  result.free_index_.resize(static_cast<std::size_t>(energy.n_vertices()));
  for (const auto& pin : pins) result.free_index_[pin.first] = -1;
  for (int& index : result.free_index_) index = index < 0 ? -1 : result.n_free_++;
  if (result.n_free_ == 0) return result;
  report(progress, 0.1, "factorization");
  HermitianMatrix block = free_block(energy.matrix(), result.free_index_, result.n_free_);
  const auto diagonal = [&](int v) -> Complex& { return block.valuePtr()[block.outerIndexPtr()[v]]; };
  for (int v = 0; v < result.n_free_; ++v) result.max_diagonal_ = std::max(result.max_diagonal_, diagonal(v).real());
  result.factorization_ = make_factorization(backend, result.n_free_);
  result.factorization_->analyze(block);
  result.is_definite_ = result.factorization_->factorize(block);
  if (result.is_definite_) return result;
  // The smallest eigenvalues of a long strip are below the rounding of the factor: use the least shift that makes it
  // definite.
  double given = 0;
  for (const double relative_shift : {1e-15, 1e-14, 1e-13, 1e-12}) {
    for (int v = 0; v < result.n_free_; ++v) diagonal(v) *= (1 + relative_shift) / (1 + given);
    given = relative_shift;
    result.is_factorized_ = result.factorization_->factorize(block);
    if (result.is_factorized_) return result;
  }
  return result;
}

bool PinnedFactor::holds(const Pins& pins) const {
  const auto n_pinned = free_index_.size() - static_cast<std::size_t>(n_free_);
  return pins.size() == n_pinned &&
         std::all_of(pins.begin(), pins.end(), [this](const auto& pin) { return free_index_[pin.first] < 0; });
}

ComplexVector PinnedFactor::gathered(const ComplexVector& whole) const {
  ComplexVector free(n_free_);
  for (std::size_t v = 0; v < free_index_.size(); ++v) {
    if (free_index_[v] >= 0) free[free_index_[v]] = whole[static_cast<Eigen::Index>(v)];
  }
  return free;
}

ComplexVector PinnedFactor::scattered(const ComplexVector& free) const {
  ComplexVector whole = ComplexVector::Zero(static_cast<Eigen::Index>(free_index_.size()));
  for (std::size_t v = 0; v < free_index_.size(); ++v) {
    if (free_index_[v] >= 0) whole[static_cast<Eigen::Index>(v)] = free[free_index_[v]];
  }
  return whole;
}

void PinnedFactor::solve_on_all(const ComplexVector& b, ComplexVector& x) {
  ComplexVector free = gathered(b);
  if (n_free_ > 0) factorization_->solve(free, free);
  x = scattered(free);
}

PinnedSolution solve_lscm(const ConformalEnergy& energy, const Pins& pins, PinnedFactor& factor,
                          const Progress& progress, double tolerance) {
  PinnedSolution result;
  Complex mean = 0;
  for (const auto& pin : pins) mean += pin.second / static_cast<double>(pins.size());
  // Starting from the mean of the pins keeps the numbers small wherever the pins lie, since L 1 = 0.
  result.vector = ComplexVector::Constant(energy.n_vertices(), mean);
  for (const auto& [vertex, position] : pins) result.vector[vertex] = position;
  if (factor.n_free() == 0) return result;

  report(progress, 0.8, "solve");
  PinnedSystem equations(energy, factor, nullptr, result.vector, progress, tolerance);
  equations.solve();
  result.change = equations.change();
  ComplexVector gradient;
  energy.apply(result.vector, gradient);
  const double unit = factor.max_diagonal() * (result.vector.array() - mean).abs().maxCoeff();
  result.residual = unit > 0 ? factor.gathered(gradient).norm() / unit : 0;
  return result;
}

PinnedSolution pinned_response(const ConformalEnergy& energy, const ComplexVector& force, PinnedFactor& factor,
                               const Progress& progress, double tolerance) {
  PinnedSolution result;
  result.vector = ComplexVector::Zero(energy.n_vertices());
  if (factor.n_free() == 0) return result;
  PinnedSystem equations(energy, factor, &force, result.vector, progress, tolerance);
  equations.solve();
  result.change = equations.change();
  return result;
}

}  // namespace spectral_conformal
