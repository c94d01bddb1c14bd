#pragma once

#include <cstddef>
#include <vector>

#include "geometry/segment_tree.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Keeps the boundary of a map from touching itself: a one-to-one map stays so as long as no triangle flips and the
/// boundary does not cross itself (Smith and Schaefer, Bijective Parameterization with Free Boundaries, 2015). The
/// energy sums w (D / distance - 1)^2 over every boundary vertex nearer than D to a boundary edge other than its own
/// two, with w = 1e-4 / (number of edges). D is a quarter of the shortest of these three edges in the initial map. If
/// that is a map to keep (Contacts::ignored), D ends at what is nearest to the vertex there: it has no energy.
class BoundaryBarrier {
 public:
  /// Whether vertices that touch an edge in the initial map count; their energy is infinite.
  enum class Contacts { counted, ignored };

  /// loops: all of the chart's; z: (V,), finite. Ignored contacts never count, not even once they have parted.
  /// A vertex that touches very many edges is ignored altogether, and so are the edges at a vertex through which the
  /// boundary passes very often: they all meet there, and so do their ways.
  static BoundaryBarrier around(const std::vector<BoundaryLoop>& loops, const ComplexVector& z,
                                Contacts contacts = Contacts::counted);

  /// Whether there are ignored contacts, which may turn into overlaps.
  bool ignores_contacts() const { return ignores_contacts_; }

  /// A boundary vertex and a boundary edge other than its own two.
  struct Pair {
    int vertex;
    int from;
    int to;
    double reach;  ///< D
  };

  /// The pairs that may be within reach, or touch, anywhere on the way from z to z + step.
  std::vector<Pair> pairs_near(const ComplexVector& z, const ComplexVector& step) const;

  /// The first part of a step, and the pairs near it.
  struct Way {
    double part = 1;  ///< 1, or a power of 1/2
    std::vector<Pair> pairs;
  };
  /// The longest part of a step with a number of pairs near it that grows no faster than that of the edges, unless so
  /// many are near z itself.
  Way way_along(const ComplexVector& z, const ComplexVector& step) const;

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

  /// The barriers on their way.
  SegmentTree tree_along(const ComplexVector& z, const ComplexVector& step) const;
  /// Adds up to `limit` of `pairs_near` to `pairs`. Returns whether these are all.
  bool list_pairs(const ComplexVector& z, const ComplexVector& step, std::size_t limit, std::vector<Pair>& pairs) const;
  /// Removes the edges at such a vertex from barriers_.
  void pass_hubs(Eigen::Index n_vertices);
  void ignore_contacts(const SegmentTree& tree, const ComplexVector& z);
  void bound_reach(const SegmentTree& tree, const ComplexVector& z);
  /// Whether an edge is one of the vertex's own, or its contact with the `from` of edge i is ignored.
  bool is_apart(std::size_t i, int edge) const;

  std::vector<BoundaryEdge> edges_;  ///< each with its `from`
  std::vector<int> barriers_;        ///< the edges that keep vertices away; trees are over these
  std::vector<double> reach_;        ///< per edge, for `from`: its part of D
  double weight_ = 0;                ///< per pair
  bool ignores_contacts_ = false;
  std::vector<std::vector<int>> touched_;  ///< per edge, for `from`: the edges whose contact is ignored, sorted
  std::vector<char> is_ignored_;           ///< per edge, for `from`: whether all its pairs are, or another has them
};

}  // namespace spectral_conformal
