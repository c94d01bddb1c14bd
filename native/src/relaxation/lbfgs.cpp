#include "relaxation/lbfgs.h"

#include <utility>
#include <vector>

#include "concurrency/cancellation_scope.h"
#include "geometry/signed_area.h"
#include "geometry/tolerances.h"

namespace spectral_conformal {
double real_dot(const ComplexVector& a, const ComplexVector& b) {
  double sum = 0;
  for (Eigen::Index i = 0; i < a.size(); ++i) sum += dot(a[i], b[i]);
  return sum;
}

void Lbfgs::add(ComplexVector step, ComplexVector gradient_change) {
  const double curvature = real_dot(step, gradient_change);
  // Rounding decides a smaller one.
  if (!(curvature > sum_rounding * step.norm() * gradient_change.norm())) return;
  if (pairs_.size() == capacity) pairs_.pop_front();
  pairs_.push_back({std::move(step), std::move(gradient_change), curvature});
}

ComplexVector Lbfgs::descent(const Inverse& inverse, const ComplexVector& gradient) const {
  ComplexVector remaining = gradient;
  std::vector<double> projections(pairs_.size());
  for (std::size_t k = pairs_.size(); k-- > 0;) {
    projections[k] = real_dot(pairs_[k].step, remaining) / pairs_[k].curvature;
    remaining -= projections[k] * pairs_[k].gradient_change;
    poll(remaining.size());
  }
  ComplexVector direction;
  inverse(remaining, direction);
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const double projection = real_dot(pairs_[k].gradient_change, direction) / pairs_[k].curvature;
    direction += (projections[k] - projection) * pairs_[k].step;
    poll(direction.size());
  }
  direction = -direction;
  return direction;
}

}  // namespace spectral_conformal
