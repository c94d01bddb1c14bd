#pragma once

#include <cstddef>
#include <vector>

#include "concurrency/forest_schedule.h"
#include "graph/adjacency.h"
#include "graph/grouped.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The structure of a Cholesky factor: its columns in groups, the supernodes, each a dense block.
struct SupernodalStructure {
  std::vector<int> order;                 ///< (n,) the row of the matrix at each index of the factor
  std::vector<int> first_column;          ///< (supernodes + 1,)
  std::vector<std::ptrdiff_t> first_row;  ///< (supernodes + 1,) into `rows`
  std::vector<int> rows;                  ///< of each supernode, ascending: its own columns, then those below
};

/// The symbolic part of a factorization: the supernodes as a forest, the target of each matrix entry, and the schedule
/// of the threads.
class SymbolicFactor {
 public:
  /// An entry of the matrix's lower triangle on its way into a block.
  struct Entry {
    int source;  ///< index of the value, or its complement for the conjugate
    int target;  ///< row + column * rows of the block
  };
  /// The supernodes that a solve visits, closed under parents.
  class Path {
   public:
    const std::vector<int>& supernodes() const { return supernodes_; }  ///< ascending
    bool contains(int supernode) const { return is_member_[supernode] != 0; }
    const ForestSchedule& schedule() const { return schedule_; }  ///< of indices into supernodes; costs in entries

   private:
    friend class SymbolicFactor;
    std::vector<int> supernodes_;
    std::vector<char> is_member_;
    ForestSchedule schedule_;
  };

  /// structure: of the factors of matrices with this pattern. graph: of the matrix (graph_of).
  static SymbolicFactor of(const HermitianMatrix& matrix, const Adjacency& graph, SupernodalStructure structure);

  int n() const { return static_cast<int>(structure_.order.size()); }
  const std::vector<int>& order() const { return structure_.order; }
  int n_supernodes() const { return static_cast<int>(parent_.size()); }
  /// The rows of all supernodes, concatenated.
  std::size_t n_rows() const { return structure_.rows.size(); }
  double nonzeros() const;                                      ///< stored entries of the factor, including some zeros
  const ForestSchedule& schedule() const { return schedule_; }  ///< costs in multiplications

  // Of a supernode:
  int first_column(int k) const { return structure_.first_column[k]; }
  int columns(int k) const { return structure_.first_column[k + 1] - structure_.first_column[k]; }
  std::ptrdiff_t first_row(int k) const { return structure_.first_row[k]; }
  int rows(int k) const { return static_cast<int>(structure_.first_row[k + 1] - structure_.first_row[k]); }
  const int* row_indices(int k) const { return structure_.rows.data() + structure_.first_row[k]; }
  int parent(int k) const { return parent_[k]; }  ///< -1 for a root
  Grouped<int>::Range<const int*> children(int k) const { return children_[k]; }
  /// For each row below its columns, the index in the block of its parent.
  const int* index_in_parent(int k) const { return index_in_parent_.data() + structure_.first_row[k]; }
  Grouped<Entry>::Range<const Entry*> entries(int k) const {
    return {entries_.data() + first_entry_[k], entries_.data() + first_entry_[k + 1]};
  }

  Path whole() const;
  /// The supernodes of these columns, and all their ancestors.
  Path above(const std::vector<int>& columns) const;

 private:
  Path path_of(std::vector<int> supernodes) const;

  SupernodalStructure structure_;
  std::vector<int> supernode_of_;  ///< of each column
  std::vector<int> parent_;
  Grouped<int> children_;
  std::vector<int> index_in_parent_;
  std::vector<int> first_entry_;  ///< (supernodes + 1,) into entries_
  std::vector<Entry> entries_;
  ForestSchedule schedule_;
};

}  // namespace spectral_conformal
