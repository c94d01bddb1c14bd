#pragma once

#include "spectral_conformal/types.h"

namespace spectral_conformal {

// Limits of the spaces in which eigenvectors are sought. They bound the memory: each vector has an entry per vertex.

/// The dimension that triggers a restart, which keeps half. A whole problem of this dimension is solved densely.
constexpr int max_dimension = 24;

/// Whether the change of an iterate still halves. Rounding is the limit once two full spaces of solves do not halve it.
class Halving {
 public:
  explicit Halving(int solves) : halved_at_(solves) {}
  void add(double change, int solves) {
    if (!(change < 0.5 * halved_)) return;
    halved_ = change;
    halved_at_ = solves;
  }
  double least() const { return halved_; }  ///< the last change that was halved
  bool goes_on(int solves) const { return solves - halved_at_ <= 2 * max_dimension; }

 private:
  double halved_ = infinity;
  int halved_at_;
};

// Spaces of complex vectors over the numbers over which a problem is linear: the complex ones, or, if it singles out
// directions, the reals.

/// Complex numbers as such, or as real ones, twice as many.
template <class Scalar>
Eigen::Map<const Eigen::Matrix<Scalar, Eigen::Dynamic, 1>> view_as(const ComplexVector& z) {
  return {reinterpret_cast<const Scalar*>(z.data()),
          static_cast<Eigen::Index>(sizeof(Complex) / sizeof(Scalar)) * z.size()};
}
/// Back.
template <class Vector>
ComplexVector as_complex(const Vector& view) {
  const auto n = static_cast<Eigen::Index>(sizeof(Complex) / sizeof(typename Vector::Scalar));
  return Eigen::Map<const ComplexVector>(reinterpret_cast<const Complex*>(view.data()), view.size() / n);
}

}  // namespace spectral_conformal
