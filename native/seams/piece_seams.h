#pragma once

#include <array>
#include <unordered_set>
#include <vector>

#include "mesh/charts.h"
#include "mesh/mirror_symmetry.h"
#include "seams/pieces.h"
#include "seams/seam_graph.h"
#include "seams/separating_cut.h"

namespace spectral_conformal {

/// No island gets less than this fraction of the area of the chart that it is cut from: crumbs are hard to texture.
constexpr double min_island = 0.02;

/// Edges of a SeamGraph, by number.
using SeamEdges = std::vector<int>;

/// Seams that follow each other, from one end to the other.
struct SeamChain {
  SeamEdges edges;
  std::array<int, 2> ends;     ///< vertices; the same of a closed chain
  std::array<bool, 2> is_tip;  ///< whether nothing else is cut there
  bool is_own_image = false;   ///< in a piece that mirrors itself
};

/// The new seams of a piece, and the cuts that extend them. If the piece is its own mirror image, every cut includes
/// its image and stays in one half, so that the two together enclose nothing.
class PieceSeams {
 public:
  /// The piece must outlive this object; `index` is its number. Coordinates must be finite.
  PieceSeams(const Piece& piece, int index, PieceMirror mirror, const MirrorSymmetry& symmetry);

  const Piece& piece() const { return *piece_; }
  const SeamGraph& graph() const { return graph_; }
  /// The new seams so far.
  const SeamEdges& edges() const { return edges_; }
  double length(const SeamEdges& edges) const;
  /// The sum of SeamGraph::Edge::cost.
  double cost(const SeamEdges& edges) const;
  /// Multiplies the costs of the edges, not their lengths; factors per edge.
  void scale_costs(const std::vector<double>& factors);
  void add(const SeamEdges& edges);
  /// Takes new seams away again.
  void remove(const SeamEdges& edges);
  /// The vertices of all seams of the piece, old and new, for a PolygonMesh of it, after a change of the new ones.
  std::vector<std::array<int, 2>> changed(const SeamEdges& added, const SeamEdges& removed) const;
  /// The new seams, from one crossing or end of seams to the next; of two that mirror each other the one whose first
  /// edge has the lower number.
  std::vector<SeamChain> chains() const;
  /// Some new seams and their images, ascending.
  SeamEdges with_cut_images(const SeamEdges& some) const;
  /// The cheapest path between the ends of a chain that touches no other cut, where that is cheaper than the chain;
  /// empty where there is none, and of closed chains and those that meet their own image. The chain is not cut.
  SeamEdges straightened(const SeamChain& chain) const;

  /// Whether the chart of a face is its own mirror image. chart_of_face: (F,), -1 where a face is in none.
  bool self_mirrored(int face, const std::vector<int>& chart_of_face) const;
  /// The chart that the chart of a face is mapped onto, or itself where the piece has no mirror image of its own.
  int mirrored_chart(int face, const std::vector<int>& chart_of_face) const;
  /// Whether cuts come with their images. Not where the piece was slit off its mirror plane.
  bool is_symmetric() const { return symmetric_; }
  void forget_symmetry() { symmetric_ = false; }
  /// Of a symmetric piece: of a vertex, as MirrorSymmetry::side; the image of a vertex; whether an edge lies in the
  /// plane.
  int side(int vertex) const { return side_[vertex]; }
  int mirrored(int vertex) const { return mirror_.vertex[vertex]; }
  bool along_axis(int edge) const;
  /// Those of some edges that are not cut yet, in their order, and then their images.
  SeamEdges with_images(const SeamEdges& path) const;
  /// Of a vertex and its mirror image the one on the positive side.
  int on_positive_side(int vertex) const;

  /// Cuts the handles open and slits a closed surface, and adds these cuts. Then one more joins the longest boundary
  /// loop of a symmetric piece to its image, because its map would not be symmetric otherwise.
  std::vector<SeamEdges> open();
  /// The cheapest cut within the chart of a face from a vertex to the nearest cut, or, from the loop of a hole, to
  /// another one.
  SeamEdges cut_to(int vertex, bool on_loop, int face, const std::vector<int>& chart_of_face) const;
  /// The edges between some faces of a chart, by their indices in `faces`, and its others, and their images.
  SeamEdges border(const SeparableFaces& faces, const std::vector<int>& some) const;
  /// All edges of the chart on the mirror plane that are not cut.
  SeamEdges cut_along_axis(const SeparableFaces& faces) const;
  /// See separating_side; sources and sinks by their indices, too.
  SeamEdges cut_apart(const SeparableFaces& faces, const std::vector<int>& sources, const std::vector<int>& sinks,
                      const std::vector<int>& chart_of_face) const;

 private:
  SeamEdges between_sides(const SeparableFaces& faces, const std::vector<char>& side) const;
  bool in_chart(int edge, int chart, const std::vector<int>& chart_of_face) const;
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
  std::vector<signed char> side_;  ///< per vertex, see MirrorSymmetry; all 0 without a mirror image
  SeamEdges edges_;
};

/// The edges of some cuts, each once, in the order in which they come.
class JoinedCuts {
 public:
  explicit JoinedCuts(const PieceSeams& seams) : seams_(seams) {}
  void add(const SeamEdges& cut) {
    for (const int edge : cut) {
      if (!known_.insert(edge).second) continue;
      edges_.push_back(edge);
      length_ += seams_.graph().edges()[edge].length;
    }
  }
  SeamEdges& edges() { return edges_; }
  double length() const { return length_; }

 private:
  const PieceSeams& seams_;
  SeamEdges edges_;
  std::unordered_set<int> known_;
  double length_ = 0;
};

}  // namespace spectral_conformal
