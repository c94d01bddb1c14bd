#pragma once

#include <utility>
#include <vector>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Keeps the boundary of a map from touching itself: a one-to-one map stays so as long as no triangle flips and the
/// boundary does not cross itself (Smith and Schaefer, Bijective Parameterization with Free Boundaries, 2015). The
/// energy sums w (D / distance - 1)^2 over every boundary vertex nearer than D to a boundary edge other than its own
/// two, with w = 1e-4 / (number of edges). D is a quarter of the shortest of these three edges in the initial map.
class BoundaryBarrier {
 public:
  /// Whether vertices that touch an edge in the initial map count; their energy is infinite.
  enum class Contacts { counted, ignored };

  /// loops: all of the chart's; z: (V,), finite. Ignored contacts never count, not even once they have parted.
  static BoundaryBarrier around(const std::vector<BoundaryLoop>& loops, const ComplexVector& z,
                                Contacts contacts = Contacts::counted);

  /// Whether there are ignored contacts, which may turn into overlaps.
  bool ignores_contacts() const { return !ignored_.empty(); }

  /// A boundary vertex and a boundary edge other than its own two.
  struct Pair {
    int vertex;
    int from;
    int to;
    double reach;  ///< D
  };

  /// The pairs that may be within reach, or touch, anywhere on the way from z to z + step.
  std::vector<Pair> pairs_near(const ComplexVector& z, const ComplexVector& step) const;

  /// The energy at z (V,), infinite if the boundary touches itself. Adds its gradient, that of the real (2V,) vector u
  /// + i v, to `gradient`. pairs: at least those near z.
  double add(const std::vector<Pair>& pairs, const ComplexVector& z, ComplexVector& gradient) const;

  /// Adds, per vertex, twice an upper bound of the second derivative of the energy at z along any unit direction in
  /// which only this vertex moves, so that these bounds together bound the Hessian.
  void add_curvature(const std::vector<Pair>& pairs, const ComplexVector& z, Eigen::VectorXd& curvature) const;

  /// The fraction of a step from z, at most 1, at which the boundary first touches itself; infinite if it does not.
  /// pairs: at least those near the whole step.
  static double max_step(const std::vector<Pair>& pairs, const ComplexVector& z, const ComplexVector& step);

 private:
  struct BoundaryEdge {
    int from;
    int to;
    double length;  ///< in the initial map
  };

  /// Calls visit(pair, edge) for all of `pairs_near`.
  template <class Visit>
  void for_each_pair_near(const ComplexVector& z, const ComplexVector& step, const Visit& visit) const;

  std::vector<BoundaryEdge> edges_;           ///< each with its `from`
  std::vector<double> reach_;                 ///< per edge, for `from`: a quarter of the shorter of its two edges
  double weight_ = 0;                         ///< per pair
  std::vector<std::pair<int, int>> ignored_;  ///< vertices and edges, sorted
};

}  // namespace spectral_conformal
