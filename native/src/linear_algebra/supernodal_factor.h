#pragma once

#include <cstddef>
#include <vector>

#include "linear_algebra/dense_kernels.h"
#include "linear_algebra/large_pages.h"
#include "linear_algebra/symbolic_factor.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// L L^H of a Hermitian positive definite matrix by the multifrontal method (Duff and Reid 1983; Liu 1992), and the
/// solves with it. Each supernode sums up what its children pass on, eliminates its columns by BLAS and passes the rest
/// on to its parent; subtrees do not know of each other and are factorized by as many threads as the ThreadBudget
/// allows. What a supernode does never depends on the number of threads, so neither does any bit of the result. Blocks
/// are real as long as no imaginary part has reached them: in the conformal energy with uniform weights only the
/// boundary's edges have one (Eq. 3).
class SupernodalFactor {
 public:
  /// max_threads: 0 for as many as the ThreadBudget allows.
  explicit SupernodalFactor(unsigned max_threads = 0) : max_threads_(max_threads) {}

  void analyze(const HermitianMatrix& matrix, const Adjacency& graph, SupernodalStructure structure);
  const SymbolicFactor& symbolic() const { return symbolic_; }
  /// Factorizes a matrix of the analyzed pattern. Returns false when it is not positive definite in double precision.
  bool factorize(const HermitianMatrix& matrix);
  /// What the last factor takes: one for an entry of a real block, two of a complex one.
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
  unsigned n_threads(double nanoseconds) const;
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
  std::vector<char> is_real_;
  std::vector<std::ptrdiff_t> offset_;       ///< (supernodes + 1,) into values_, in doubles
  LargeVector<double> values_;               ///< not set before a block is begun
  std::vector<LargeVector<double>> passed_;  ///< lower triangle that a supernode passes on, until it is taken
  ComplexVector below_;                      ///< what each supernode passes on in a solve, beside its rows
};

}  // namespace spectral_conformal
