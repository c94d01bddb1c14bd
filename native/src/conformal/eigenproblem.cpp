#include "conformal/eigenproblem.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "conformal/ritz_space.h"
#include "conformal/start_vector.h"
#include "conformal/subspace.h"

namespace spectral_conformal {
namespace {

template <class Scalar>
using VectorOf = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

/// B y = mu K y on the unknowns S: y = G f with G = S^* K^-1 S, and K y means f.
template <class Number>
class ReducedProblem {
 public:
  using Scalar = Number;
  using Vector = VectorOf<Scalar>;
  static constexpr bool has_own_energy = false;

  ReducedProblem(ReducedFactor& factor, const QuotientForm& form)
      : factorization_(factor.factorization()),
        form_(form),
        space_(factor.space().restricted(form.support(), support_)) {
    factorization_.select(support_);
  }
  const std::vector<int>& support() const { return support_; }
  Vector metric(const Vector&, const Vector& image) const { return image; }
  void renew(const Vector&, Vector&) const {}
  Vector force(const Vector& y) const { return force_at(space_.expanded(as_complex(y))); }
  /// P_S^* B x, for x on the support of the form.
  Vector force_at(const ComplexVector& x) const {
    ComplexVector image;
    form_.apply(x, image);
    return view_as<Scalar>(space_.gathered(image));
  }
  /// G f. Translations, of length 1/s in G, would drown the rest in rounding.
  Vector solved(Vector& f) {
    ComplexVector x = as_complex(f);
    space_.remove_translations(x);
    f = view_as<Scalar>(x);
    ComplexVector y;
    factorization_.solve_selected(x, y);
    space_.remove_translations(y);
    return view_as<Scalar>(y);
  }

 private:
  Factorization& factorization_;
  const QuotientForm& form_;
  std::vector<int> support_;  ///< S; before the space
  AffineSpace space_;         ///< P_S
};

/// B z = mu L z on whole vectors, in the inner product of L + s M.
template <class Number>
class WholeProblem {
 public:
  using Scalar = Number;
  using Vector = VectorOf<Scalar>;
  static constexpr bool has_own_energy = true;

  WholeProblem(const ConformalEnergy& energy, const QuotientForm& form, const BoundaryForm& mass, double shift)
      : energy_(energy), form_(form), mass_(mass), shift_(shift) {}
  Vector metric(const Vector& y, const Vector& image) const {
    ComplexVector result = as_complex(image);
    mass_.add_applied(as_complex(y), shift_, result);
    return view_as<Scalar>(result);
  }
  Vector force(const Vector& y) const {
    ComplexVector result = ComplexVector::Zero(energy_.n_vertices());
    form_.add_applied(as_complex(y), 1, result);
    return view_as<Scalar>(result);
  }
  /// image = L z.
  void renew(const Vector& z, Vector& image) const {
    ComplexVector result;
    energy_.apply(as_complex(z), result);
    image = view_as<Scalar>(result);
  }

 private:
  const ConformalEnergy& energy_;
  const QuotientForm& form_;
  const BoundaryForm& mass_;
  double shift_;
};

/// A solve, over one kind of numbers.
template <class Scalar>
class Eigensolver {
 public:
  Eigensolver(ReducedFactor& factor, const ConformalEnergy& energy, const QuotientForm& form, const BoundaryForm& mass,
              const EigenproblemOptions& options, const Progress& progress)
      : factor_(factor), energy_(energy), form_(form), mass_(mass), options_(options), progress_(progress) {
    result_.change_limit = std::max(single_epsilon, options.tolerance);
  }

  /// Step 1. Leaves result().z empty if there is no map.
  void find(RitzBasis<Scalar>& basis, const ComplexVector& earlier) {
    ReducedProblem<Scalar> problem(factor_, form_);
    RitzSpace<ReducedProblem<Scalar>> space(problem);
    const auto grow = [&](const VectorOf<Scalar>& force) {
      report_progress();
      VectorOf<Scalar> f = space.without_images(force);
      VectorOf<Scalar> y = problem.solved(f);
      ++result_.solves;
      const double length = space.add(std::move(y), std::move(f));
      if (space.size() == 0 || !space.solve()) return infinity;
      return length / (space.mu() - std::max(0.0, space.mu(1)));
    };
    if (!basis.support.empty() && basis.support == problem.support()) {
      for (Eigen::Index j = 0; j < basis.vectors.cols(); ++j) space.add(basis.vectors.col(j), basis.images.col(j));
      space.solve();
    } else {
      ComplexVector circle = ComplexVector::Zero(energy_.n_vertices());
      circle(mass_.vertices) = start_vector(mass_, options_.start);
      grow(problem.force_at(form_.restrict(circle)));
      if (earlier.size() > 0) grow(problem.force_at(form_.restrict(earlier)));
    }
    // Where the shift makes up most of the second one, the factor does not separate it from the first.
    const auto is_blind = [&] { return factor_.shift() * space.mu(1) > max_shift_share; };
    Halving halving(result_.solves);
    while (space.size() > 0 && goes_on(halving, halving.least()) && !is_blind()) {
      const double change = grow(problem.force(space.vector()) - space.mu() * space.image());
      // Of the vector before the step, which usually takes away nine tenths.
      if (!(change > 10 * negligible())) break;
      halving.add(change, result_.solves);
      if (space.size() >= max_dimension) space.restart(kept_dimension);
    }
    result_.is_shift_too_large = is_blind() && options_.may_lower_shift;
    if (space.size() == 0 || !(space.mu() > 0) || result_.is_shift_too_large) return;
    ComplexVector w;
    factor_.factorization().solve_from_selected(as_complex(problem.force(space.vector())), w);
    ++result_.solves;
    factor_.space().remove_translations(w);
    result_.z = factor_.space().expanded(w / space.mu());
    if (!is_blind()) gap_ = 1 - std::max(0.0, space.mu(1)) / space.mu();
    space.restart(kept_dimension);
    basis = {space.vectors(), space.images(), problem.support()};
  }

  /// Step 2.
  void refine() {
    if (result_.z.size() == 0) return;
    WholeProblem<Scalar> problem(energy_, form_, mass_, factor_.shift());
    RitzSpace<WholeProblem<Scalar>> space(problem);
    const bool is_definite = form_.is_definite();
    Halving halving(result_.solves);
    ComplexVector& z = result_.z;
    ComplexVector image;
    VectorOf<Scalar> image_of_step;
    while (goes_on(halving, result_.change)) {
      const double lambda = energy_.apply(z, image) / form_.value_of_map(z);
      ComplexVector r = image;
      form_.add_applied(z, -lambda, r);
      report_progress();
      const ComplexVector d = factor_.inverse(r);
      ++result_.solves;
      const double gap = std::min(gap_, space_gap(space));
      result_.change = d.norm() / (z.norm() * gap);
      if (is_definite && !(result_.change > negligible())) {
        z -= d;
        return;
      }
      if (space.size() >= max_dimension) space.restart(kept_dimension);
      if (space.size() == 0) space.add(view_as<Scalar>(z), view_as<Scalar>(image));
      problem.renew(view_as<Scalar>(d), image_of_step);
      space.add(view_as<Scalar>(d), image_of_step);
      if (!space.solve()) return;
      const ComplexVector before = std::exchange(z, as_complex(space.vector()));
      if (!is_definite) {
        // Where the form is negative, it resists more than K, so that d is longer than the step to take.
        const double moved = (z - before.dot(z) / before.squaredNorm() * before).norm() / (z.norm() * gap);
        result_.change = std::min(result_.change, moved);
        if (!(result_.change > negligible())) return;
      }
      halving.add(result_.change, result_.solves);
    }
  }

  Eigenvector result() && {
    Eigenvector& v = result_;
    v.converged = v.z.size() > 0 && v.change < v.change_limit && v.z.allFinite() && form_.value_of_map(v.z) > 0;
    if (!v.converged) return std::move(v);
    ComplexVector r;
    v.lambda = eigen_residual(energy_, form_, v.z, r);  // Eq. 5
    v.residual = form_.is_boundary_form() ? factor_.space().gathered(r).norm() / (factor_.max_diagonal() * v.z.norm())
                                          : v.change;
    return std::move(v);
  }

 private:
  /// The least fraction of the best vector's error that K^-1 (L - lambda B) removes, (lambda_2 - lambda) / (lambda_2 +
  /// s), as far as the space shows lambda_2.
  double space_gap(const RitzSpace<WholeProblem<Scalar>>& space) const {
    if (space.size() < 2) return 1;
    const double next = std::max(0.0, space.mu(1));
    return (1 - next / space.mu()) / (1 + factor_.shift() * next);
  }
  /// Until rounding is reached, which is soon where it leaves little.
  bool goes_on(const Halving& halving, double change) const {
    const int patience = change < result_.change_limit ? kept_dimension : 2 * max_dimension;
    return result_.solves < options_.max_solves && halving.goes_on(result_.solves, patience);
  }
  double negligible() const { return std::max(0.1 * options_.tolerance, sum_rounding); }
  void report_progress() const { report(progress_, 1.0 - 1.0 / (1.0 + 0.1 * result_.solves), "eigenproblem"); }

  static constexpr double max_shift_share = 0.1;
  static constexpr int kept_dimension = 6;

  ReducedFactor& factor_;
  const ConformalEnergy& energy_;
  const QuotientForm& form_;
  const BoundaryForm& mass_;
  const EigenproblemOptions& options_;
  const Progress& progress_;
  double gap_ = 1;
  Eigenvector result_;
};

template <class Scalar>
Eigenvector solved(Eigensolver<Scalar> solver, RitzBasis<Scalar>& basis, const ComplexVector& earlier) {
  solver.find(basis, earlier);
  solver.refine();
  return std::move(solver).result();
}

}  // namespace

Eigenvector smallest_eigenvector(ReducedFactor& factor, const ConformalEnergy& energy, const QuotientForm& form,
                                 const BoundaryForm& mass, const EigenproblemOptions& options, EarlierBasis& basis,
                                 const ComplexVector& earlier, const Progress& progress) {
  if (factor.space().is_complex() && form.may_turn()) {
    return solved<Complex>({factor, energy, form, mass, options, progress}, basis.complex, earlier);
  }
  return solved<double>({factor, energy, form, mass, options, progress}, basis.real, earlier);
}

}  // namespace spectral_conformal
