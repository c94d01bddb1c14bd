#pragma once

#include <array>
#include <functional>
#include <vector>

#include "graph/adjacency.h"
#include "mesh/charts.h"
#include "seams/edge_flow.h"

namespace spectral_conformal {

/// Visits of each face, corner or edge in a part of the search, roughly. They only decide whether the part is worth a
/// thread of its own.
constexpr std::size_t steps_per_face = 20;

/// A vertex with more faces or edges is a hub: searches do not visit all of them every time.
constexpr int hub_size = 64;

/// The edges of a polygon mesh as a graph of possible seam paths. Edges between exactly two faces can be cut unless
/// they are seams; all others count as cut.
class SeamGraph {
 public:
  struct Edge {
    std::array<int, 2> vertices;  ///< the smaller first
    std::array<int, 2> faces;     ///< -1 for none; the first two of three or more
    double length;
    /// Of a seam along it: length times price (seam_price.h) times the factors of scale_cost, a multiple of cost_step.
    double cost;
    bool cut;                                          ///< seam, or not between exactly two faces
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< sum of the two faces' unit normals; 0 if cut from the start

    int other_end(int vertex) const { return vertices[0] == vertex ? vertices[1] : vertices[0]; }
  };

  /// From the selected faces and the seams of `mesh`. Coordinates must be finite. Throws InvalidMesh.
  static SeamGraph of(const PolygonMesh& mesh);

  int n_vertices() const { return adjacency_.n_nodes(); }
  const std::vector<Edge>& edges() const { return edges_; }
  /// The faces as nodes, joined across every edge between exactly two, cut or not. Arcs carry the indices of the edges.
  const Adjacency& dual() const { return dual_; }
  /// The vertices as nodes. Arcs carry the indices of the edges and are sorted by the vertex they lead to.
  const Adjacency& adjacency() const { return adjacency_; }
  /// The edge between two vertices, or -1. Bisects the arcs of `a`.
  int find_edge(int a, int b) const;
  /// A vertex of two edges that meet; of two between the same vertices, the first of `one`.
  int common_vertex(int one, int other) const;
  double length(const std::vector<int>& edges) const;
  /// The edge that goes straight on from a vertex along an edge loop (edge_flow.h), or -1.
  int onward(int edge, int vertex) const { return flow_.onward[edge][edges_[edge].vertices[0] == vertex ? 0 : 1]; }
  /// What a seam costs that leaves edge loops, at the regular vertices (edge_flow.h): where exactly two of its edges
  /// meet and do not go straight on, their mean cost times 1 - the cosine of the turn. With a least turn, that is added
  /// to the mean, and an end costs as much as a right angle.
  double turning(const std::vector<int>& edges) const;
  const EdgeFlow& flow() const { return flow_; }
  void cut(int edge) { set_cut(edge, true); }
  /// Precondition: it lies between exactly two faces.
  void uncut(int edge) { set_cut(edge, false); }
  /// How many cut edges end at a vertex.
  int n_cuts(int vertex) const { return n_cuts_[vertex]; }
  /// Multiplies what turns cost, in paths and turning(); 0 makes them free.
  void scale_turns(double factor) { turn_factor_ = factor; }
  /// What is added to the cost of the edges at a turn: turns between short or sharp edges are not free then.
  void set_least_turn(double least) { least_turn_ = least; }
  double least_turn() const { return least_turn_; }
  bool turns_cost() const { return turn_factor_ > 0; }
  void scale_cost(int edge, double factor) { edges_[edge].cost = rounded_cost(factor * edges_[edge].cost); }
  /// All costs are multiples of this power of two, 2^-22 of the extent: sums of them are exact, in any order, and paths
  /// whose costs differ by rounding errors tie.
  double cost_step() const { return cost_step_; }

  /// The angle between the normals of the edge's two faces, in radians, 0 to pi; pi for a cut edge.
  static double dihedral_angle(const Edge& edge);

  /// The cost of the cheapest path from every vertex to a source along `allowed` edges, where cut edges are free;
  /// infinite without a path. `parent` receives the edge by which each vertex is reached from its source, or -1.
  std::vector<double> distances(const std::vector<int>& sources, const std::function<bool(int edge)>& allowed,
                                std::vector<int>* parent = nullptr) const;
  /// (V,) the index of the source nearest to every vertex along the edges, by their lengths; -1 beyond `radius`.
  std::vector<int> nearest(const std::vector<int>& sources, double radius) const;
  /// The vertices within `radius` of one along cut edges, by their lengths.
  std::vector<int> along_cuts(int vertex, double radius) const;
  /// Of the vertices with a path to the source, the farthest by `distances`.
  int farthest_vertex(int source, const std::function<bool(int edge)>& allowed) const;
  /// The cheapest path from a vertex to the nearest target, as edges in order; empty if there is none or the start is a
  /// target. Cut edges are free. Turns cost, too: of the many shortest paths over a grid, a straight one wins. At a
  /// hub, only turns from the edges reached first are tried. `allowed(edge, from)` says whether the path may leave the
  /// vertex `from` along the edge; it is asked only where that may shorten a path.
  std::vector<int> path(int start, const std::vector<char>& is_target,
                        const std::function<bool(int edge, int from)>& allowed) const;

 private:
  void collect_edges(const PolygonMesh& mesh);
  void price_edges(const PolygonMesh& mesh);
  void count_cuts();
  void set_cut(int edge, bool cut);
  double turn_cost(int vertex, int in, int out) const;
  double rounded_cost(double cost) const;
  double rounded_turn(double cost) const;

  double cost_step_ = 0;
  double turn_factor_ = 1;
  double least_turn_ = 0;
  Positions positions_;
  std::vector<Edge> edges_;
  std::vector<int> n_cuts_;  ///< per vertex
  Adjacency adjacency_;
  Adjacency dual_;
  EdgeFlow flow_;
};

}  // namespace spectral_conformal
