#pragma once

#include <cstddef>
#include <vector>

#include "linear_algebra/dense_kernels.h"
#include "linear_algebra/large_pages.h"
#include "linear_algebra/symbolic_factor.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// L L^H of a Hermitian positive definite matrix by the multifrontal method (Duff and Reid 1983; Liu 1992), and solves
/// with it. Each supernode sums its children's update matrices, eliminates its columns by BLAS and passes the remainder
/// to its parent. Subtrees are independent and factorized in as many threads as the ThreadBudget allows. The work of a
/// supernode does not depend on the number of threads, so results are equal to the bit. Blocks stay real until an
/// imaginary part reaches them: in the conformal energy with uniform weights, only boundary edges have one (Eq. 3).
class SupernodalFactor {
 public:
  /// max_threads: 0 for as many as the ThreadBudget allows.
  explicit SupernodalFactor(unsigned max_threads = 0) : max_threads_(max_threads) {}

  /// is_real: as in Factorization::analyze_in_order, alike for all columns of a supernode; or empty.
  void analyze(const HermitianMatrix& matrix, const Adjacency& graph, SupernodalStructure structure,
               const std::vector<char>& is_real = {});
  const SymbolicFactor& symbolic() const { return symbolic_; }
  /// Factorizes a matrix of the analyzed pattern. Returns false if it is not positive definite in double precision.
  bool factorize(const HermitianMatrix& matrix);
  /// The size of the last factor: one double per entry of a real block, two for a complex one.
  double n_doubles() const { return static_cast<double>(offset_.back()); }

  /// work <- L^-1 work, (n,) in the factor's order, over the path; zero elsewhere.
  void forward(const SymbolicFactor::Path& path, ComplexVector& work);
  /// work <- L^-H work over the path.
  void backward(const SymbolicFactor::Path& path, ComplexVector& work);

 private:
  template <class Scalar>
  DenseBlock<Scalar> block(int k) {
    return {symbolic_.columns(k), symbolic_.rows(k), reinterpret_cast<Scalar*>(values_.data() + offset_[k])};
  }
  unsigned n_threads(double steps) const;
  double multiplications() const;
  double n_doubles(const SymbolicFactor::Path& path) const;
  template <class Scalar>
  bool eliminate(int k, const HermitianMatrix& matrix);
  template <class Scalar, class Visit>
  void for_each_child(int k, const Visit& visit);
  template <class Scalar, class OfChild>
  void add_to_columns(int child, const OfChild* from, const DenseBlock<Scalar>& own) const;
  template <class Scalar, class OfChild>
  void add_below(int child, const OfChild* from, const DenseBlock<Scalar>& own, Scalar* passed) const;

  unsigned max_threads_;
  SymbolicFactor symbolic_;
  std::vector<char> has_real_unknowns_;      ///< per supernode
  std::vector<char> is_real_;                ///< per supernode: its block
  std::vector<std::ptrdiff_t> offset_;       ///< (supernodes + 1,) into values_, in doubles
  LargeVector<double> values_;               ///< unset until a block is begun
  std::vector<LargeVector<double>> passed_;  ///< lower triangle that a supernode passes on, until consumed
  ComplexVector below_;                      ///< what each supernode passes on in a solve, aligned with its rows
};

}  // namespace spectral_conformal
