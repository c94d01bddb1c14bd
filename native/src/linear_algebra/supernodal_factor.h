#pragma once

#include <cstddef>
#include <vector>

#include "concurrency/forest_schedule.h"
#include "graph/adjacency.h"
#include "linear_algebra/large_pages.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Where a Cholesky factor may have entries: its columns in groups, the supernodes, of which each is a dense block.
struct SupernodalStructure {
  std::vector<int> order;                 ///< (n,) the row of the matrix at each place of the factor
  std::vector<int> first_column;          ///< (supernodes + 1,)
  std::vector<std::ptrdiff_t> first_row;  ///< (supernodes + 1,) into `rows`
  std::vector<int> rows;                  ///< of each supernode, ascending: its own columns, then those below
};

/// L L^H of a Hermitian positive definite matrix by the multifrontal method (Duff and Reid 1983; Liu 1992), and the
/// solves with it. Each supernode sums up what its children pass on, eliminates its columns by BLAS and passes the rest
/// on to its parent; subtrees do not know of each other and are factorised by as many threads as the ThreadBudget
/// allows. What a supernode does never depends on the number of threads, so neither does any bit of the result. Blocks
/// are real as long as no imaginary part has reached them: in the conformal energy with uniform weights only the
/// boundary's edges have one (Eq. 3).
class SupernodalFactor {
 public:
  /// max_threads: 0 for as many as the ThreadBudget allows.
  explicit SupernodalFactor(unsigned max_threads = 0) : max_threads_(max_threads) {}

  /// Takes the structure that the factor of matrices of this pattern has. graph: of the matrix (graph_of).
  void analyze(const HermitianMatrix& matrix, const Adjacency& graph, SupernodalStructure structure);
  /// Factorises a matrix of the analysed pattern. Returns false when it is not positive definite in double precision.
  bool factorize(const HermitianMatrix& matrix);

  int n() const { return static_cast<int>(structure_.order.size()); }
  int n_supernodes() const { return static_cast<int>(parent_.size()); }
  int first_column(int k) const { return structure_.first_column[k]; }
  const std::vector<int>& order() const { return structure_.order; }
  /// Entries of the factor as stored, some zeros among them, complex or real.
  double nonzeros() const;
  /// What the last factor takes: one for an entry of a real block, two of a complex one.
  double n_doubles() const { return static_cast<double>(offset_.back()); }

  /// Supernodes that a solve passes through, closed under parents.
  class Path {
   public:
    const std::vector<int>& supernodes() const { return supernodes_; }  ///< ascending

   private:
    friend class SupernodalFactor;
    std::vector<int> supernodes_;
    std::vector<char> is_member_;
    ForestSchedule schedule_;
  };
  /// All supernodes.
  Path whole() const;
  /// Those that these columns lie in, and everything above.
  Path above(const std::vector<int>& columns) const;

  /// work <- L^-1 work, (n,) in the factor's order, over the path; zero elsewhere.
  void forward(const Path& path, ComplexVector& work);
  /// work <- L^-H work over the path.
  void backward(const Path& path, ComplexVector& work);

 private:
  /// An entry of the matrix's lower triangle on its way into a block.
  struct Entry {
    int source;  ///< index of the value, or its complement where the conjugate is meant
    int target;  ///< row + column * rows of the block
  };

  int columns(int k) const { return structure_.first_column[k + 1] - structure_.first_column[k]; }
  int rows(int k) const { return static_cast<int>(structure_.first_row[k + 1] - structure_.first_row[k]); }
  const int* row_indices(int k) const { return structure_.rows.data() + structure_.first_row[k]; }
  /// Of each row below k's columns, its place in the block of k's parent.
  const int* place_in_parent(int k) const { return place_.data() + structure_.first_row[k]; }
  double* block(int k) { return values_.data() + offset_[k]; }

  Path path_of(std::vector<int> supernodes) const;
  unsigned n_threads(double work, double min_work) const;
  double multiplications() const;
  double n_doubles(const Path& path) const;
  template <class Scalar>
  bool eliminate(int k, const HermitianMatrix& matrix);
  template <class Scalar, class Visit>
  void for_each_child(int k, const Visit& visit);
  template <class Scalar, class OfChild>
  void add_to_columns(int child, const OfChild* from, Scalar* own, int height, int width) const;
  template <class Scalar, class OfChild>
  void add_below(int child, const OfChild* from, Scalar* passed, int height, int width) const;

  unsigned max_threads_;
  SupernodalStructure structure_;
  std::vector<int> supernode_of_;  ///< of each column
  std::vector<int> parent_;
  std::vector<int> first_child_;  ///< (supernodes + 1,) into children_
  std::vector<int> children_;
  std::vector<int> place_;
  std::vector<int> first_entry_;  ///< (supernodes + 1,) into entries_
  std::vector<Entry> entries_;
  ForestSchedule schedule_;
  std::vector<char> is_real_;
  std::vector<std::ptrdiff_t> offset_;       ///< (supernodes + 1,) into values_, in doubles
  LargeVector<double> values_;               ///< not set before a block is begun
  std::vector<LargeVector<double>> passed_;  ///< lower triangle that a supernode passes on, until it is taken
  ComplexVector below_;                      ///< what each supernode passes on in a solve, beside its rows
};

}  // namespace spectral_conformal
