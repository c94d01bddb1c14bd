#include "linear_algebra/symbolic_factor.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "concurrency/parallel_calls.h"
#include "graph/numbering.h"

namespace spectral_conformal {

SymbolicFactor SymbolicFactor::of(const HermitianMatrix& matrix, const Adjacency& graph,
                                  SupernodalStructure structure) {
  SymbolicFactor result;
  result.structure_ = std::move(structure);
  result.supernode_of_.resize(result.structure_.order.size());
  const int n_super = static_cast<int>(result.structure_.first_column.size()) - 1;
  for (int k = 0; k < n_super; ++k) {
    std::fill(result.supernode_of_.begin() + result.first_column(k),
              result.supernode_of_.begin() + result.first_column(k + 1), k);
  }
  const std::vector<int> index_of = indices_in(result.structure_.order, result.structure_.order.size());

  result.parent_.resize(n_super);
  result.index_in_parent_.resize(result.structure_.rows.size());
  result.first_entry_.assign(n_super + 1, 0);
  std::vector<double> cost(n_super);
  const auto for_each_supernode = [&](const auto& visit) {
    run_blocks_in_parallel(n_super, 500, [&](int begin, int end) {
      for (int k = begin; k < end; ++k) visit(k);
    });
  };
  for_each_supernode([&](int k) {
    const double width = result.columns(k);
    const double height = result.rows(k);
    // Multiplications, plus the overhead of calls and of passing on small blocks.
    cost[k] = width * height * height + 20 * height * height + 5000;
    for (int column = result.first_column(k); column < result.first_column(k + 1); ++column) {
      ++result.first_entry_[k + 1];
      for (const Adjacency::Arc arc : graph.arcs(result.structure_.order[column])) {
        if (index_of[arc.to] > column) ++result.first_entry_[k + 1];
      }
    }
    result.parent_[k] =
        result.rows(k) == result.columns(k) ? -1 : result.supernode_of_[result.row_indices(k)[result.columns(k)]];
    if (result.parent_[k] < 0) return;
    const int* const above = result.row_indices(result.parent_[k]);
    int at = 0;
    for (int i = result.columns(k); i < result.rows(k); ++i) {
      while (above[at] < result.row_indices(k)[i]) ++at;
      result.index_in_parent_[result.structure_.first_row[k] + i] = at;
    }
  });
  result.children_ = Grouped<int>(n_super, [&](const auto& visit) {
    for (int k = 0; k < n_super; ++k) {
      if (result.parent_[k] >= 0) visit(result.parent_[k], k);
    }
  });
  result.schedule_ = ForestSchedule::of(result.parent_, cost);
  poll(n_super);

  std::partial_sum(result.first_entry_.begin(), result.first_entry_.end(), result.first_entry_.begin());
  result.entries_.resize(static_cast<std::size_t>(matrix.nonZeros()));
  for_each_supernode([&](int k) {
    Entry* entry = result.entries_.data() + result.first_entry_[k];
    for (int column = result.first_column(k); column < result.first_column(k + 1); ++column) {
      const int v = result.structure_.order[column];
      const int in_block = column - result.first_column(k);
      *entry++ = {matrix.outerIndexPtr()[v], in_block + in_block * result.rows(k)};
      for (const Adjacency::Arc arc : graph.arcs(v)) {
        const int index = index_of[arc.to];
        if (index <= column) continue;
        const auto row =
            std::lower_bound(result.row_indices(k) + in_block, result.row_indices(k) + result.rows(k), index) -
            result.row_indices(k);
        *entry++ = {arc.to > v ? arc.edge : ~arc.edge, static_cast<int>(row) + in_block * result.rows(k)};
      }
    }
  });
  return result;
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
  for (const int k : supernodes) path.is_member_[k] = 1;
  const std::vector<int> index = indices_in(supernodes, parent_.size());
  std::vector<int> parent;
  std::vector<double> cost;
  parent.reserve(supernodes.size());
  cost.reserve(supernodes.size());
  for (const int k : supernodes) {
    parent.push_back(parent_[k] < 0 ? -1 : index[parent_[k]]);
    cost.push_back(static_cast<double>(rows(k)) * columns(k));
  }
  path.schedule_ = ForestSchedule::of(parent, cost);
  path.supernodes_ = std::move(supernodes);
  return path;
}

}  // namespace spectral_conformal
