#include "linear_algebra/symbolic_factor.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "concurrency/listening.h"
#include "concurrency/parallel_calls.h"

namespace spectral_conformal {

SymbolicFactor::SymbolicFactor(const HermitianMatrix& matrix, const Adjacency& graph, SupernodalStructure structure)
    : structure_(std::move(structure)), supernode_of_(structure_.order.size()) {
  const int n_super = static_cast<int>(structure_.first_column.size()) - 1;
  for (int k = 0; k < n_super; ++k) {
    std::fill(supernode_of_.begin() + first_column(k), supernode_of_.begin() + first_column(k + 1), k);
  }
  std::vector<int> index_of(structure_.order.size());
  for (int i = 0; i < n(); ++i) index_of[structure_.order[i]] = i;

  parent_.resize(n_super);
  index_in_parent_.resize(structure_.rows.size());
  first_entry_.assign(n_super + 1, 0);
  std::vector<double> cost(n_super);
  const auto for_each_supernode = [&](const auto& visit) {
    run_blocks_in_parallel(n_super, 2000, [&](int begin, int end) {
      for (int k = begin; k < end; ++k) visit(k);
    });
  };
  for_each_supernode([&](int k) {
    const double width = columns(k);
    const double height = rows(k);
    // Multiplications, plus the overhead of calls and of passing on small blocks.
    cost[k] = width * height * height + 20 * height * height + 5000;
    for (int column = first_column(k); column < first_column(k + 1); ++column) {
      ++first_entry_[k + 1];
      for (const Adjacency::Arc arc : graph.arcs(structure_.order[column])) {
        if (index_of[arc.to] > column) ++first_entry_[k + 1];
      }
    }
    parent_[k] = rows(k) == columns(k) ? -1 : supernode_of_[row_indices(k)[columns(k)]];
    if (parent_[k] < 0) return;
    const int* const above = row_indices(parent_[k]);
    int at = 0;
    for (int i = columns(k); i < rows(k); ++i) {
      while (above[at] < row_indices(k)[i]) ++at;
      index_in_parent_[structure_.first_row[k] + i] = at;
    }
  });
  children_ = Grouped<int>(n_super, [&](const auto& visit) {
    for (int k = 0; k < n_super; ++k) {
      if (parent_[k] >= 0) visit(parent_[k], k);
    }
  });
  schedule_ = ForestSchedule(parent_, cost);
  still_working(100.0 * n_super);

  std::partial_sum(first_entry_.begin(), first_entry_.end(), first_entry_.begin());
  entries_.resize(static_cast<std::size_t>(matrix.nonZeros()));
  for_each_supernode([&](int k) {
    Entry* entry = entries_.data() + first_entry_[k];
    for (int column = first_column(k); column < first_column(k + 1); ++column) {
      const int v = structure_.order[column];
      const int in_block = column - first_column(k);
      *entry++ = {matrix.outerIndexPtr()[v], in_block + in_block * rows(k)};
      for (const Adjacency::Arc arc : graph.arcs(v)) {
        const int index = index_of[arc.to];
        if (index <= column) continue;
        const auto row = std::lower_bound(row_indices(k) + in_block, row_indices(k) + rows(k), index) - row_indices(k);
        *entry++ = {arc.to > v ? arc.edge : ~arc.edge, static_cast<int>(row) + in_block * rows(k)};
      }
    }
  });
}

double SymbolicFactor::nonzeros() const {
  double sum = 0;
  for (int k = 0; k < n_supernodes(); ++k) sum += static_cast<double>(rows(k)) * columns(k);
  return sum;
}

SymbolicFactor::Path SymbolicFactor::whole() const {
  std::vector<int> all(parent_.size());
  std::iota(all.begin(), all.end(), 0);
  return path_of(std::move(all));
}

SymbolicFactor::Path SymbolicFactor::above(const std::vector<int>& columns) const {
  std::vector<char> is_reached(parent_.size(), 0);
  for (const int column : columns) {
    for (int k = supernode_of_[column]; k >= 0 && !is_reached[k]; k = parent_[k]) is_reached[k] = 1;
  }
  std::vector<int> reached;
  for (int k = 0; k < n_supernodes(); ++k) {
    if (is_reached[k]) reached.push_back(k);
  }
  return path_of(std::move(reached));
}

SymbolicFactor::Path SymbolicFactor::path_of(std::vector<int> supernodes) const {
  Path path;
  path.is_member_.assign(parent_.size(), 0);
  std::vector<int> index(parent_.size(), -1);
  for (std::size_t i = 0; i < supernodes.size(); ++i) {
    path.is_member_[supernodes[i]] = 1;
    index[supernodes[i]] = static_cast<int>(i);
  }
  std::vector<int> parent;
  std::vector<double> cost;
  parent.reserve(supernodes.size());
  cost.reserve(supernodes.size());
  for (const int k : supernodes) {
    parent.push_back(parent_[k] < 0 ? -1 : index[parent_[k]]);
    cost.push_back(static_cast<double>(rows(k)) * columns(k));
  }
  path.schedule_ = ForestSchedule(parent, cost);
  path.supernodes_ = std::move(supernodes);
  return path;
}

}  // namespace spectral_conformal
