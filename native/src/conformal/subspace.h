#pragma once

#include <type_traits>

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
  bool goes_on(int solves, int patience = 2 * max_dimension) const { return solves - halved_at_ <= patience; }

 private:
  double halved_ = infinity;
  int halved_at_;
};

// Spaces of complex vectors over the numbers over which a problem is linear: the complex ones, or, if it singles out
// directions, the reals.

/// How many numbers of a type a complex one is.
template <class Scalar>
constexpr Eigen::Index numbers_per_complex = std::is_same_v<Scalar, Complex> ? 1 : 2;

/// Complex numbers as such, or as real ones, twice as many.
template <class Scalar>
Eigen::Map<const Eigen::Matrix<Scalar, Eigen::Dynamic, 1>> view_as(const ComplexVector& z) {
  return {reinterpret_cast<const Scalar*>(z.data()), numbers_per_complex<Scalar> * z.size()};
}
/// Back.
template <class Vector>
ComplexVector as_complex(const Vector& view) {
  return Eigen::Map<const ComplexVector>(reinterpret_cast<const Complex*>(view.data()),
                                         view.size() / numbers_per_complex<typename Vector::Scalar>);
}

}  // namespace spectral_conformal
