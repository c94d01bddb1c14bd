#pragma once

#include <array>
#include <memory>
#include <vector>

#include "mesh/charts.h"
#include "mesh/mirror_symmetry.h"
#include "seams/pieces.h"
#include "seams/seam_graph.h"
#include "seams/separating_cut.h"

namespace spectral_conformal {

/// Least area of an island, as a fraction of the area of the chart it is cut from: crumbs are hard to texture.
constexpr double min_island = 0.02;

/// Indices of edges of a SeamGraph.
using SeamEdges = std::vector<int>;

/// A run of seam edges, in order from one end to the other.
struct SeamChain {
  SeamEdges edges;
  std::array<int, 2> ends;     ///< vertices; equal for a closed chain
  std::array<bool, 2> is_tip;  ///< whether no other cut meets that end
  bool is_own_image = false;   ///< whether it has both an edge and the edge's mirror image
};

/// The new seams of a piece, and cuts that extend them. If the piece is its own mirror image, a path stays in one half
/// and is cut together with its image, so the two enclose nothing.
class PieceSeams {
 public:
  /// `index` is the index of `piece`, which must outlive this object. Coordinates must be finite.
  PieceSeams(const Piece& piece, int index, PieceMirror mirror, const MirrorSymmetry& symmetry);

  const Piece& piece() const { return *piece_; }
  const SeamGraph& graph() const { return graph_; }
  const EdgeLoops& loops() const { return *loops_; }
  /// The new seams so far.
  const SeamEdges& edges() const { return edges_; }
  /// In units of the whole mesh, unlike SeamGraph::length.
  double length(const SeamEdges& edges) const;
  /// The sum of SeamGraph::Edge::cost. Without the turns.
  double cost(const SeamEdges& edges) const;
  /// SeamGraph::turning of the new seams after a change.
  double turning(const SeamEdges& added, const SeamEdges& removed) const;
  /// The sum of 2 s - 1 over the edge loops of which the new seams cut a share s between 1/2 and 1 of their length, and
  /// which would part an island if they were cut whole, after a change: what is left of such a ring is a narrow hinge.
  /// 0 if turns are free.
  double open_rings(const SeamEdges& added, const SeamEdges& removed) const;
  /// What these rings lack, with images; each once.
  std::vector<SeamEdges> missing_in_rings() const;
  /// Multiplies the costs of the edges, not their lengths. factors: one per edge of the graph.
  void scale_costs(const std::vector<double>& factors);
  /// As in SeamGraph. Open rings cost nothing, too, if turns are free.
  void scale_turns(double factor) { graph_.scale_turns(factor); }
  void set_least_turn(double least) { graph_.set_least_turn(least); }
  void add(const SeamEdges& edges);
  /// Removes new seams.
  void remove(const SeamEdges& edges);
  /// All seams of the piece, given and new, as vertex pairs for a PolygonMesh, after a change of the new ones.
  std::vector<std::array<int, 2>> changed(const SeamEdges& added, const SeamEdges& removed) const;
  /// The new seams, split where seams cross or end. Of two chains that mirror each other, only the one with the lowest
  /// edge index.
  std::vector<SeamChain> chains() const;
  /// Some new seams and those of their images that are cut, ascending.
  SeamEdges with_cut_images(const SeamEdges& some) const;
  /// The cheapest path beside a chain that touches no other cut on its way, within `corridor` times its length. Its
  /// ends slide along the cuts that the chain meets, as far, unless turns are free. For a closed chain, the cheapest
  /// edge loop there that runs around once, too, and the path to it from a cut that meets the chain. With its image.
  /// Empty if it is not cheaper than the chain, turns included, or if an open chain that is its own image has no vertex
  /// in the mirror plane. Precondition: the chain is not cut.
  SeamEdges straightened(const SeamChain& chain, double corridor) const;

  /// Whether the chart of a face is its own mirror image. chart_of_face: (F,), -1 for faces in no chart.
  bool self_mirrored(int face, const std::vector<int>& chart_of_face) const;
  /// The mirror image of the chart of a face; the chart itself if the piece is not symmetric.
  int mirrored_chart(int face, const std::vector<int>& chart_of_face) const;
  /// Whether cuts come with their images. Not if the piece was slit off its mirror plane.
  bool is_symmetric() const { return symmetric_; }
  void forget_symmetry() { symmetric_ = false; }
  /// For a symmetric piece: the side of a vertex, as MirrorSymmetry::side; the image of a vertex; whether an edge lies
  /// in the mirror plane.
  int side(int vertex) const { return side_[vertex]; }
  int mirrored(int vertex) const { return mirror_.vertex[vertex]; }
  bool along_axis(int edge) const;
  /// The edges of some paths that are not cut yet, each once and in order, followed by their images.
  SeamEdges with_images(const SeamEdges& path) const;
  /// The vertex or its mirror image, whichever is on the positive side.
  int on_positive_side(int vertex) const;

  /// Cuts handles open, slits a closed surface, and adds and returns these cuts. If the longest boundary loop of a
  /// symmetric piece is not its own image, one more cut joins the two; otherwise the map would not be symmetric.
  std::vector<SeamEdges> open();
  /// The cheapest cut within the chart of a face from a vertex to the nearest cut; if `on_loop`, the nearest one not
  /// connected to the vertex's own boundary loop.
  SeamEdges cut_to(int vertex, bool on_loop, int face, const std::vector<int>& chart_of_face) const;
  /// The edges between some faces of a chart, given by their indices in `faces`, and its other faces; with their
  /// images.
  SeamEdges border(const SeparableFaces& faces, const std::vector<int>& some) const;
  /// One of the edge loops through a vertex and within the chart of a face, with its image; empty if there are not so
  /// many. A regular vertex of quads has up to two.
  SeamEdges loop_through(int vertex, std::size_t which, int face, const std::vector<int>& chart_of_face) const;
  /// The border of separating_side, with its image. sources, sinks: indices in `faces`.
  SeamEdges cut_apart(const SeparableFaces& faces, const std::vector<int>& sources, const std::vector<int>& sinks,
                      const std::vector<int>& chart_of_face) const;

 private:
  SeamEdges edges_after(const SeamEdges& added, const SeamEdges& removed) const;
  SeamEdges between_sides(const SeparableFaces& faces, const std::vector<char>& side) const;
  bool in_chart(int edge, int chart, const std::vector<int>& chart_of_face) const;
  int side_of(const SeamChain& chain) const;
  /// In order, from one end to the other.
  std::vector<int> vertices_of(const SeamChain& chain) const;
  struct OpenRing {
    SeamEdges missing;
    double share;  ///< that is cut
  };
  std::vector<OpenRing> rings_left_open(const SeamEdges& added, const SeamEdges& removed) const;
  SeamChain half_of(const SeamChain& chain) const;
  std::vector<char> possible_ends(const SeamChain& chain, std::size_t end, const std::vector<int>& nearest,
                                  double radius) const;
  SeamEdges straight_path(const SeamChain& chain, double corridor) const;
  SeamEdges straight_loop(const SeamChain& chain, double corridor) const;
  double cost_with_turns(const SeamEdges& edges) const { return cost(edges) + graph_.turning(edges); }
  int n_edges() const { return static_cast<int>(graph_.edges().size()); }
  bool on_axis(int vertex) const { return symmetric_ && mirror_.vertex[vertex] == vertex; }
  int mirror_edge(int edge) const;
  SeamEdges first_slit();
  SeamEdges symmetric_outer_loop() const;
  void clear_of_image(const SeparableFaces& faces, std::vector<char>& side) const;

  const Piece* piece_;
  SeamGraph graph_;
  PieceMirror mirror_;
  bool symmetric_;                 ///< cuts come with their images
  std::vector<signed char> side_;  ///< per vertex, see MirrorSymmetry; all 0 if not symmetric
  SeamEdges edges_;
  std::shared_ptr<const EdgeLoops> loops_;  ///< shared by copies
};

}  // namespace spectral_conformal
