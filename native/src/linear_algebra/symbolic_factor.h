#pragma once

#include <cstddef>
#include <vector>

#include "concurrency/forest_schedule.h"
#include "graph/adjacency.h"
#include "graph/grouped.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Where a Cholesky factor may have entries: its columns in groups, the supernodes, of which each is a dense block.
struct SupernodalStructure {
  std::vector<int> order;                 ///< (n,) the row of the matrix at each index of the factor
  std::vector<int> first_column;          ///< (supernodes + 1,)
  std::vector<std::ptrdiff_t> first_row;  ///< (supernodes + 1,) into `rows`
  std::vector<int> rows;                  ///< of each supernode, ascending: its own columns, then those below
};

/// What a factorization needs to know before it has numbers: the supernodes as a forest, where each entry of the matrix
/// goes, and the order in which threads work.
class SymbolicFactor {
 public:
  /// An entry of the matrix's lower triangle on its way into a block.
  struct Entry {
    int source;  ///< index of the value, or its complement where the conjugate is meant
    int target;  ///< row + column * rows of the block
  };
  /// Supernodes that a solve passes through, closed under parents.
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

  SymbolicFactor() = default;
  /// The structure is that of the factors of matrices of this pattern. graph: of the matrix (graph_of).
  SymbolicFactor(const HermitianMatrix& matrix, const Adjacency& graph, SupernodalStructure structure);

  int n() const { return static_cast<int>(structure_.order.size()); }
  const std::vector<int>& order() const { return structure_.order; }
  int n_supernodes() const { return static_cast<int>(parent_.size()); }
  /// Of all supernodes, at the end of each other.
  std::size_t n_rows() const { return structure_.rows.size(); }
  double nonzeros() const;  ///< entries of the factor as stored, some zeros among them
  const ForestSchedule& schedule() const { return schedule_; }  ///< costs in multiplications

  // Of a supernode:
  int first_column(int k) const { return structure_.first_column[k]; }
  int columns(int k) const { return structure_.first_column[k + 1] - structure_.first_column[k]; }
  std::ptrdiff_t first_row(int k) const { return structure_.first_row[k]; }
  int rows(int k) const { return static_cast<int>(structure_.first_row[k + 1] - structure_.first_row[k]); }
  const int* row_indices(int k) const { return structure_.rows.data() + structure_.first_row[k]; }
  int parent(int k) const { return parent_[k]; }  ///< -1 for a root
  Grouped<int>::Range<const int*> children(int k) const { return children_[k]; }
  /// Of each row below its columns, the index in the block of its parent.
  const int* index_in_parent(int k) const { return index_in_parent_.data() + structure_.first_row[k]; }
  Grouped<Entry>::Range<const Entry*> entries(int k) const {
    return {entries_.data() + first_entry_[k], entries_.data() + first_entry_[k + 1]};
  }

  Path whole() const;
  /// The supernodes that these columns lie in, and all above.
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
