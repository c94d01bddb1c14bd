#pragma once

#include <vector>

#include "linear_algebra/factorization.h"
#include "spectral_conformal/linear_constraints.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The unknowns w of maps x = P w + c, as rows of a matrix. Constraints single out directions, which the complex form
/// of the energy cannot represent. If they act on few unknowns, these are real rows that are eliminated last, and every
/// other vertex is one complex row, as without constraints. Otherwise all rows are real.
struct MixedUnknowns {
  bool is_ordered = false;         ///< rows are in a fill-reducing order; otherwise all are real, and row[k] is k
  std::vector<char> is_real;       ///< (rows,) whether a row is one real unknown
  std::vector<int> row;            ///< (n_unknowns,) the row of each unknown
  std::vector<char> is_imaginary;  ///< (n_unknowns,) whether it is the imaginary part of that row

  int size() const { return static_cast<int>(is_real.size()); }
};

/// Chooses the rows, in the factorization's order of the vertices if it offers one and few unknowns belong to several
/// vertices. matrix: L. positions: (V, 3), a help for the ordering.
MixedUnknowns mixed_unknowns(const LinearConstraints& constraints, const HermitianMatrix& matrix,
                             const Positions& positions, const Factorization& factorization);

/// The lower triangle of P^* L P, with only the real part between real rows: z_i = w_r for a complex row r of vertex i,
/// and x = u + i v otherwise. An entry a + i b of the complex form stands for the block [a, -b; b, a] of the real one.
HermitianMatrix mixed_matrix(const HermitianMatrix& matrix, const LinearConstraints& constraints,
                             const MixedUnknowns& unknowns);

}  // namespace spectral_conformal
