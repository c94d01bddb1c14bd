#pragma once

#include <memory>
#include <string>
#include <vector>

#include "graph/adjacency.h"
#include "spectral_conformal/options.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The factorization of one Hermitian positive definite matrix, and solves with it. Owns all its memory: different
/// objects may be used in different threads at once, one object by one thread at a time (solves share its workspace).
/// Results do not depend on the process's number of BLAS threads (blas_threads.h).
class Factorization {
 public:
  virtual ~Factorization() = default;

  /// Chooses the fill-reducing order and the structure of the factor. Throws std::bad_alloc, and SolveFailure if the
  /// factor is too large for the index type. positions: (n, 3), positions of the rows in 3D, which help to order large
  /// matrices; or null.
  virtual void analyze(const HermitianMatrix& matrix, const Positions* positions) = 0;
  void analyze(const HermitianMatrix& matrix) { analyze(matrix, nullptr); }
  /// A fill-reducing order of the nodes of a graph, for `analyze_in_order`; empty if this library offers neither.
  /// positions: as above, of the nodes.
  virtual std::vector<int> order(const Adjacency& graph, const Positions* positions) const = 0;
  /// The structure of the factor of a matrix whose rows are in a fill-reducing order already. is_real: per row, whether
  /// its unknown is real while the others are complex. Such an unknown takes part in the real part of the matrix alone,
  /// and no complex one may follow it on its path in the elimination tree. b must be real there in solves, as x will
  /// be.
  virtual void analyze_in_order(const HermitianMatrix& matrix, const std::vector<char>& is_real) = 0;
  /// Factorizes a matrix of the analyzed structure. Returns false if it is not positive definite in double precision.
  virtual bool factorize(const HermitianMatrix& matrix) = 0;
  /// Solves with the last factor: x = A^-1 b. b and x may be the same vector.
  virtual void solve(const ComplexVector& b, ComplexVector& x) = 0;
  /// Chooses the vertices for the two solves below: distinct, of the analyzed matrix.
  virtual void select(std::vector<int> vertices) = 0;
  /// x = S^T A^-1 S b, both (n selected,), where S embeds the selected vertices. Visits only the part of the factor
  /// that they reach.
  virtual void solve_selected(const ComplexVector& b, ComplexVector& x) = 0;
  /// x = A^-1 S b, (n,), from b on the selected vertices.
  virtual void solve_from_selected(const ComplexVector& b, ComplexVector& x) = 0;
  /// Stored entries of the factor; supernodes include some zeros.
  virtual double factor_nonzeros() const = 0;
};

/// The lower triangle of an n x n matrix from its entries; duplicate entries are summed. Can be canceled.
HermitianMatrix lower_triangle(Eigen::Index n, const std::vector<Eigen::Triplet<Complex>>& entries);

/// Throws SolveFailure if a factor of this many nonzeros is too large for the index type, int.
void check_factor_size(double nonzeros);

/// For matrices of n rows. Throws std::invalid_argument for CHOLMOD if the module was built without it.
std::unique_ptr<Factorization> make_factorization(FactorizationBackend backend, Eigen::Index n);

/// The library behind `automatic` and its version, such as "CHOLMOD 3.0.14".
std::string factorization_library();

}  // namespace spectral_conformal
