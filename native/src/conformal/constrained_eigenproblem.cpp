#include "conformal/constrained_eigenproblem.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "conformal/correction.h"
#include "conformal/lanczos.h"
#include "conformal/start_vector.h"

namespace spectral_conformal {
namespace {

using Eigen::VectorXd;
using Expansion = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// P on the coordinates of the vertices with mass, and only for the unknowns that these depend on.
struct BorderExpansion {
  Expansion p;                ///< (2 form.vertices.size(), unknowns.size())
  std::vector<int> unknowns;  ///< ascending
  /// The diagonal of P^T M P, as a form.
  BoundaryForm diagonal;
};

BorderExpansion border_expansion(const BoundaryForm& form, const LinearConstraints& constraints) {
  BorderExpansion result;
  std::vector<int> number(static_cast<std::size_t>(constraints.n_unknowns()), -1);
  const auto for_each = [&](const auto& visit) {
    for (std::size_t i = 0; i < form.vertices.size(); ++i) {
      for (int axis = 0; axis < 2; ++axis) {
        for (Expansion::InnerIterator it(constraints.expansion(), 2 * form.vertices[i] + axis); it; ++it) {
          visit(static_cast<int>(i), axis, static_cast<int>(it.col()), it.value());
        }
      }
    }
  };
  for_each([&](int, int, int unknown, double) { number[static_cast<std::size_t>(unknown)] = 0; });
  for (int k = 0; k < constraints.n_unknowns(); ++k) {
    if (number[static_cast<std::size_t>(k)] < 0) continue;
    number[static_cast<std::size_t>(k)] = static_cast<int>(result.unknowns.size());
    result.unknowns.push_back(k);
  }
  std::vector<Eigen::Triplet<double>> entries;
  const auto n = static_cast<Eigen::Index>(result.unknowns.size());
  result.diagonal = {result.unknowns, VectorXd::Zero(n)};
  for_each([&](int i, int axis, int unknown, double factor) {
    const int k = number[static_cast<std::size_t>(unknown)];
    entries.emplace_back(2 * i + axis, k, factor);
    result.diagonal.mass[k] += factor * factor * form.mass[i];
  });
  result.p.resize(2 * static_cast<Eigen::Index>(form.vertices.size()), n);
  if (n == 0) return result;  // every vertex with mass is held
  result.p.setFromTriplets(entries.begin(), entries.end());
  return result;
}

/// The operator of solve_constrained_eigenproblem on the coordinates of the vertices that carry mass. Unlike that of
/// eigenproblem.h it is linear over the reals only.
class ConstrainedOperator {
 public:
  using Scalar = double;
  using Vector = VectorXd;

  ConstrainedOperator(Factorization& factorization, const BoundaryForm& form, const BorderExpansion& border,
                      const Progress& progress)
      : factorization_(factorization), border_(border), progress_(progress) {
    const ComplexVector root_mass = form.mass.cwiseSqrt().cast<Complex>();
    root_mass_ = real_view(root_mass * Complex(1, 1));
    for (const Complex& axis : {Complex(1, 0), Complex(0, 1)}) constants_.push_back(real_view(root_mass * axis));
    for (VectorXd& constant : constants_) constant.normalize();
    factorization_.select(border.unknowns);
  }

  static VectorXd real_view(const ComplexVector& z) {
    return Eigen::Map<const VectorXd>(reinterpret_cast<const double*>(z.data()), 2 * z.size());
  }
  Eigen::Index size() const { return root_mass_.size(); }
  Eigen::Index rows() const { return size(); }
  Eigen::Index cols() const { return size(); }
  int solves() const { return solves_; }
  bool interrupted() const { return interruption_.happened(); }
  void project(VectorXd& y) const {
    for (const VectorXd& constant : constants_) y -= constant.dot(y) * constant;
  }
  /// w = K^-1 P^T M^1/2 y.
  VectorXd extend(const VectorXd& y) const {
    weigh(y);
    factorization_.solve_from_selected(weighted_, solved_);
    ++solves_;
    return solved_.real();
  }
  void perform_op(const double* x, double* y) const {
    interruption_.guard([&] {
      report(progress_, 1.0 - 1.0 / (1.0 + 0.1 * solves_), "eigenproblem");
      VectorXd moved = Eigen::Map<const VectorXd>(x, size());
      project(moved);
      weigh(moved);
      factorization_.solve_selected(weighted_, solved_);
      ++solves_;
      moved = root_mass_.cwiseProduct(VectorXd(border_.p * solved_.real()));
      project(moved);
      Eigen::Map<VectorXd>(y, size()) = moved;
    });
  }

 private:
  void weigh(const VectorXd& y) const {
    const VectorXd on_unknowns = border_.p.transpose() * root_mass_.cwiseProduct(y);
    weighted_ = on_unknowns.cast<Complex>();
  }

  Factorization& factorization_;
  const BorderExpansion& border_;
  const Progress& progress_;
  VectorXd root_mass_;               ///< per coordinate
  std::vector<VectorXd> constants_;  ///< of u and of v
  // Work space; mutable because Spectra takes the operator by const reference.
  mutable ComplexVector weighted_;
  mutable ComplexVector solved_;
  mutable int solves_ = 0;
  mutable Interruption interruption_;
};

}  // namespace

ConstrainedEigenpair solve_constrained_eigenproblem(const ConformalEnergy& energy, const BoundaryForm& form,
                                                    LinearConstraints constraints, const Positions& positions,
                                                    double relative_shift, FactorizationBackend backend,
                                                    const Progress& progress) {
  ConstrainedEigenpair result;
  const BorderExpansion border = border_expansion(form, constraints);
  result.factor = std::make_unique<ConstrainedFactor>(energy, std::move(constraints), border.diagonal, positions,
                                                      relative_shift, backend, part(progress, 0.0, 0.6));
  ConstrainedFactor& factor = *result.factor;
  if (!factor.is_factored()) return result;

  const Progress solving = part(progress, 0.6, 1.0);
  ConstrainedOperator op(factor.factorization(), form, border, solving);
  VectorXd start = ConstrainedOperator::real_view(start_vector(form, 0));
  op.project(start);
  std::optional<VectorXd> found = largest_eigenvector(op, start, {});
  result.pair.solves = op.solves();
  if (!found) return result;
  op.project(*found);
  VectorXd w = op.extend(found->normalized());

  // As in correction.h: removes the shift and the rounding of the factor, until the changes no longer fall.
  constexpr int max_corrections = 10;
  const QuotientForm quotient = quotient_form(form);
  ComplexVector residual;
  double before = std::numeric_limits<double>::infinity();
  for (int k = 0; k < max_corrections; ++k) {
    factor.remove_translations(w);
    result.pair.vector = factor.constraints().expanded(w);
    const double lambda = eigen_residual(energy, quotient, result.pair.vector, residual);
    result.pair.mu = 1 / lambda;
    const VectorXd change = factor.solve(residual);
    ++result.pair.solves;
    result.change = change.norm() / w.norm();
    if (!(result.change < before) || result.change < 0.01 * resolved_change) break;
    before = result.change;
    w -= change;
  }
  result.pair.solves = std::max(result.pair.solves, op.solves());
  result.pair.residual = result.change;
  result.pair.converged = result.change < resolved_change && result.pair.vector.allFinite();
  return result;
}

}  // namespace spectral_conformal
