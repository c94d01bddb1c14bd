#pragma once

#include <utility>
#include <vector>

#include "conformal/boundary_form.h"
#include "graph/grouped.h"
#include "linear_algebra/factorization.h"
#include "spectral_conformal/linear_constraints.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The maps x = P w + c, (V,), that solve linear equations. Free maps have P = 1 and c = 0, pins make c, and equations
/// make P.
///
/// An unknown is complex if it is z of one vertex alone. Equations single out directions, which the complex form of the
/// energy cannot represent. If they act on few unknowns, these are real, and eliminated last, and the others complex.
/// Otherwise all are real. Vectors w are complex, with imaginary part 0 at real unknowns: the inner product is the real
/// part of v^* w.
class AffineSpace {
 public:
  AffineSpace() = default;
  /// Chooses the unknowns, in the factorization's order of the vertices if it offers one and few unknowns are real.
  /// matrix: L. positions: (V, 3), a help for the ordering.
  static AffineSpace of(LinearConstraints constraints, const HermitianMatrix& matrix, const Positions& positions,
                        const Factorization& factorization);

  /// All maps: P is the identity.
  static AffineSpace free(int n_vertices);

  int size() const { return static_cast<int>(is_real_.size()); }  ///< of w
  const std::vector<char>& is_real() const { return is_real_; }   ///< (size,)
  bool is_complex() const { return is_complex_; }  ///< whether every unknown is: the space contains its turned maps
  /// Whether P is the identity.
  bool is_free() const { return is_complex_ && size() == n_vertices_; }
  int n_vertices() const { return n_vertices_; }
  /// Whether the unknowns are in a fill-reducing order.
  bool is_ordered() const { return is_ordered_; }
  /// c, (V,).
  const ComplexVector& offset() const { return constraints_.offset(); }
  const LinearConstraints& constraints() const { return constraints_; }

  /// P w, (V,).
  ComplexVector expanded(ComplexVector w) const;
  /// x += P w.
  void add_expanded(const ComplexVector& w, ComplexVector& x) const;
  /// P^* z, (size,).
  ComplexVector gathered(const ComplexVector& z) const;
  /// P^* L P.
  HermitianMatrix reduced(const HermitianMatrix& matrix) const;
  /// The diagonal of P^* M P, where it is positive, as a form on w.
  BoundaryForm reduced(const BoundaryForm& form) const;
  /// Of a vertex of each unknown, (size, 3).
  Positions positions_of_unknowns(const Positions& positions) const;
  /// The translations in the space, as w, orthogonal to each other; not of a free one.
  const std::vector<ComplexVector>& translations() const { return translations_; }
  void remove_translations(ComplexVector& w) const;

  /// Whether other constraints have the same P.
  bool serves(const LinearConstraints& constraints) const;
  /// Adopts c of constraints with the same P.
  void adopt(LinearConstraints constraints) { constraints_ = std::move(constraints); }
  /// The maps of some vertices alone, with c = 0. unknowns: those that they depend on, in the order of the result.
  AffineSpace restricted(const std::vector<int>& vertices, std::vector<int>& unknowns) const;

 private:
  /// A nonzero entry of P.
  struct Term {
    int unknown;
    Complex factor;  ///< 1 if the unknown is complex
  };
  void choose_unknowns(const HermitianMatrix& matrix, const Positions& positions, const Factorization& factorization);
  void add_unknown(bool is_real, int vertex) {
    is_real_.push_back(is_real ? 1 : 0);
    vertex_.push_back(vertex);
  }
  /// Of each of some vertices.
  Grouped<Term> terms_of(const std::vector<int>& vertices) const;

  LinearConstraints constraints_;
  std::vector<char> is_real_;
  std::vector<int> vertex_;  ///< of each unknown, one that depends on it; -1 for the origin
  int n_vertices_ = 0;
  bool is_complex_ = true;
  bool is_ordered_ = false;
  Grouped<Term> terms_;  ///< of each vertex, unless all unknowns are complex
  std::vector<ComplexVector> translations_;
};

}  // namespace spectral_conformal
