#pragma once

#include <array>
#include <functional>
#include <vector>

#include "graph/adjacency.h"
#include "mesh/charts.h"

namespace spectral_conformal {

/// About what a step of the search takes per face, corner or edge, 200 to 3000 ns: decides alone what is worth a thread
/// of its own.
constexpr double work_per_face = 1000;

/// Faces or edges of a hub, a vertex at which a search does not look at all of them every time.
constexpr int hub_size = 64;

/// The edges of a polygon mesh as a graph of possible seam paths. Edges between two faces are free unless they are
/// seams; all others are cut already.
class SeamGraph {
 public:
  struct Edge {
    std::array<int, 2> vertices;  ///< the smaller first
    std::array<int, 2> faces;     ///< -1 where there is none; of three or more faces the first two
    double length;
    double cost;  ///< of a seam along it: the length times the price (seam_price.h) and the factors of scale_cost
    bool cut;     ///< seam, or not between exactly two faces
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< sum of the unit normals of the two faces; 0 where it is cut

    int other_end(int vertex) const { return vertices[0] == vertex ? vertices[1] : vertices[0]; }
  };

  /// Takes the selected faces and the seams of `mesh`. Coordinates must be finite.
  explicit SeamGraph(const PolygonMesh& mesh);

  int n_vertices() const { return adjacency_.n_nodes(); }
  const std::vector<Edge>& edges() const { return edges_; }
  /// The faces as nodes, joined over every edge between exactly two, cut or not, with the numbers of the edges.
  const Adjacency& dual() const { return dual_; }
  /// The vertices as nodes, with the numbers of the edges; the arcs of each are sorted by where they lead.
  const Adjacency& adjacency() const { return adjacency_; }
  /// The edge between two vertices, or -1; by bisection of the arcs of one.
  int find_edge(int a, int b) const;
  void cut(int edge) { edges_[edge].cut = true; }
  /// Precondition: it lies between exactly two faces.
  void uncut(int edge) { edges_[edge].cut = false; }
  void scale_cost(int edge, double factor) { edges_[edge].cost *= factor; }

  /// The angle between the normals of the edge's two faces, in radians, 0 to pi; pi for a cut edge.
  static double dihedral_angle(const Edge& edge);

  /// Cost of the cheapest path from every vertex to a source along `allowed` edges, cut ones being free; infinite where
  /// there is no path. With `parent`, the edge by which each vertex is reached from its source, or -1.
  std::vector<double> distances(const std::vector<int>& sources, const std::function<bool(int edge)>& allowed,
                                std::vector<int>* parent = nullptr) const;
  /// The last of the vertices by this distance from a source that there is a path to.
  int farthest_vertex(int source, const std::function<bool(int edge)>& allowed) const;
  /// The cheapest path from a vertex to the nearest target, as edges in order; empty where there is none or the start
  /// is a target. Turns cost too, so that of the many shortest paths over a grid a straight one is taken; cut edges are
  /// free. In a vertex with more than 64 edges only turns out of those that are reached first are looked at.
  /// `allowed(edge, from)` says whether an edge may be walked from a vertex.
  std::vector<int> path(int start, const std::vector<char>& is_target,
                        const std::function<bool(int edge, int from)>& allowed) const;

 private:
  void collect_edges(const PolygonMesh& mesh);
  void price_edges(const PolygonMesh& mesh);
  double turn_cost(int vertex, const Adjacency::Arc& in, const Adjacency::Arc& out) const;

  Positions positions_;
  std::vector<Edge> edges_;
  Adjacency adjacency_;
  Adjacency dual_;
};

}  // namespace spectral_conformal
