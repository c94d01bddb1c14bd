#pragma once

#include <cstddef>
#include <deque>
#include <functional>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The inner product of two complex vectors as real ones of twice the length.
double real_dot(const ComplexVector& a, const ComplexVector& b);

/// Descent directions by limited-memory BFGS (Liu and Nocedal 1989): the two-loop recursion (Nocedal and Wright,
/// Numerical Optimization, 2006, Algorithm 7.4) with the inverse of a quadratic form that approximates the Hessian.
class Lbfgs {
 public:
  /// Steps kept (3 to 20, ibid.). This many solves take about as long as one factorization.
  static constexpr std::size_t capacity = 10;
  /// x = (inverse of the form) b.
  using Inverse = std::function<void(const ComplexVector& b, ComplexVector& x)>;

  void clear() { pairs_.clear(); }
  /// Adds a step and the change of the gradient along it, unless their curvature is not positive, which would make the
  /// Hessian indefinite.
  void add(ComplexVector step, ComplexVector gradient_change);
  /// The direction, (V,) like the gradient.
  ComplexVector descent(const Inverse& inverse, const ComplexVector& gradient) const;

 private:
  struct Pair {
    ComplexVector step;
    ComplexVector gradient_change;
    double curvature;
  };
  std::deque<Pair> pairs_;
};

}  // namespace spectral_conformal
