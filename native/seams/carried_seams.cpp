#include "seams/carried_seams.h"

#include <algorithm>
#include <cstddef>

#include "graph/grouped.h"

namespace spectral_conformal {
namespace {

/// A vertex beside a chain is in its corridor if those of the chain beside it are at most this far from each other.
constexpr int max_reach = 3;

/// Seam edges of a coarse piece that follow each other, by their vertices. All belong to one cut.
struct CoarseChain {
  std::vector<int> vertices;
  int cut;
};

/// The chains of the seams of a coarse piece: they end where seams meet, at the mirror plane, and where another cut
/// begins. Of mirrored chains there is the one on the positive side; an edge across the plane is a chain.
class SeamChains {
 public:
  SeamChains(const PieceSeams& seams, const std::vector<SeamEdges>& cuts);
  const std::vector<CoarseChain>& chains() const { return chains_; }

 private:
  std::array<int, 2> ends(int edge) const { return seams_.graph().edges()[edge].vertices; }
  int side(int v) const { return seams_.is_symmetric() ? seams_.side(v) : 1; }
  bool crosses(int edge) const { return side(ends(edge)[0]) * side(ends(edge)[1]) < 0; }
  bool goes_on(int v, int edge, int other) const;
  void follow(int v, CoarseChain& chain);
  void add(CoarseChain&& chain);

  const PieceSeams& seams_;
  std::vector<int> cut_of_edge_;          ///< -1 where an edge is no new seam
  std::vector<int> degree_;               ///< cut edges per vertex
  std::vector<std::vector<int>> new_at_;  ///< new seams per vertex
  std::vector<char> followed_;            ///< per edge
  std::vector<CoarseChain> chains_;
};

SeamChains::SeamChains(const PieceSeams& seams, const std::vector<SeamEdges>& cuts)
    : seams_(seams),
      cut_of_edge_(seams.graph().edges().size(), -1),
      degree_(static_cast<std::size_t>(seams.graph().n_vertices()), 0),
      new_at_(static_cast<std::size_t>(seams.graph().n_vertices())),
      followed_(seams.graph().edges().size(), 0) {
  for (const auto& edge : seams.graph().edges()) {
    for (const int v : edge.vertices) degree_[v] += edge.cut ? 1 : 0;
  }
  std::vector<char> is_new(followed_.size(), 0);
  for (const int e : seams.edges()) {
    is_new[e] = 1;
    for (const int v : ends(e)) new_at_[v].push_back(e);
  }
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    for (const int e : cuts[i])
      cut_of_edge_[e] = is_new[e] != 0 && cut_of_edge_[e] < 0 ? static_cast<int>(i) : cut_of_edge_[e];
  }
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    for (const int e : cuts[i]) {
      if (cut_of_edge_[e] != static_cast<int>(i) || followed_[e] != 0) continue;
      const auto [a, b] = ends(e);
      if (!crosses(e) && (side(a) < 0 || side(b) < 0)) continue;
      followed_[e] = 1;
      CoarseChain chain{{a, b}, static_cast<int>(i)};
      if (crosses(e)) {
        if (side(a) < 0) std::swap(chain.vertices[0], chain.vertices[1]);
      } else {
        follow(e, chain);
        std::reverse(chain.vertices.begin(), chain.vertices.end());
        follow(e, chain);
      }
      add(std::move(chain));
    }
  }
}

bool SeamChains::goes_on(int v, int edge, int other) const {
  return other != edge && followed_[other] == 0 && cut_of_edge_[other] == cut_of_edge_[edge] && !crosses(other) &&
         (side(v) != 0 || (seams_.along_axis(edge) && seams_.along_axis(other)));
}

/// Goes on from the last vertex of a chain, by an edge of the same cut as `edge`.
void SeamChains::follow(int edge, CoarseChain& chain) {
  for (bool found = true; found;) {
    found = false;
    const int v = chain.vertices.back();
    if (degree_[v] != 2) return;
    for (const int other : new_at_[v]) {
      if (found || !goes_on(v, edge, other)) continue;
      followed_[other] = 1;
      chain.vertices.push_back(seams_.graph().edges()[other].other_end(v));
      edge = other;
      found = true;
    }
  }
}

/// Chains begin off the mirror plane where they can, and where both ends are in one place they are halved: a path is
/// found from the first vertex to the last, and only the last may be on the plane.
void SeamChains::add(CoarseChain&& chain) {
  std::vector<int>& all = chain.vertices;
  const bool in_plane =
      seams_.is_symmetric() && std::all_of(all.begin(), all.end(), [&](int v) { return side(v) == 0; });
  const bool both_in_plane = !in_plane && side(all.front()) == 0 && side(all.back()) == 0;
  if (all.size() > 2 && (all.front() == all.back() || both_in_plane)) {
    const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
    CoarseChain other{{middle, all.end()}, chain.cut};
    all.erase(middle + 1, all.end());
    std::reverse(all.begin(), all.end());
    chains_.push_back(std::move(chain));
    chains_.push_back(std::move(other));
    return;
  }
  if (!in_plane && side(all.front()) == 0) std::reverse(all.begin(), all.end());
  chains_.push_back(std::move(chain));
}

/// Finds the paths on the fine piece.
class SeamCarrier {
 public:
  SeamCarrier(const CoarsePiece& coarse, const PieceSeams& from, bool is_wide, PieceSeams& to)
      : coarse_(coarse),
        from_(from),
        is_wide_(is_wide),
        to_(to),
        reach_(coarse.vertex.size()),
        on_seam_(coarse.vertex.size(), 0),
        on_cut_(coarse.cluster.size(), 0),
        members_(static_cast<int>(coarse.vertex.size()), [&](const auto& visit) {
          for (std::size_t v = 0; v < coarse.cluster.size(); ++v) visit(coarse.cluster[v], static_cast<int>(v));
        }) {
    for (const auto& edge : from.graph().edges()) {
      if (edge.cut) on_seam_[edge.vertices[0]] = on_seam_[edge.vertices[1]] = 1;
    }
    for (const auto& edge : to.graph().edges()) {
      if (edge.cut) on_cut_[edge.vertices[0]] = on_cut_[edge.vertices[1]] = 1;
    }
  }
  /// The new seams that a chain becomes.
  SeamEdges carry(const CoarseChain& chain) {
    const std::vector<int>& vertices = chain.vertices;
    open_corridor(vertices);
    const bool crosses = to_.is_symmetric() &&
                         to_.side(coarse_.vertex[vertices.front()]) * to_.side(coarse_.vertex[vertices.back()]) < 0;
    SeamEdges path = to_.with_images(crosses ? across_plane(vertices.front()) : between(vertices));
    for (const int v : corridor_) reach_[v] = {};
    corridor_.clear();
    for (const int e : path) {
      for (const int v : to_.graph().edges()[e].vertices) on_cut_[v] = 1;
    }
    to_.add(path);
    return path;
  }

 private:
  /// The vertices of the chain, by their indices in it, that a coarse vertex is or has for neighbors.
  struct Reach {
    int first = -1;  ///< -1 outside the corridor
    int last = -1;
  };
  const Reach& reach(int v) const { return reach_[coarse_.cluster[v]]; }
  /// The vertices of a chain, and beside them those neighbors that are on no seam.
  void open_corridor(const std::vector<int>& vertices) {
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const int position = static_cast<int>(i);
      for (const auto& arc : from_.graph().adjacency().arcs(vertices[i])) {
        Reach& beside = reach_[arc.to];
        if (!is_wide_ || on_seam_[arc.to] != 0) continue;
        if (beside.first < 0) corridor_.push_back(arc.to);
        beside = {beside.first < 0 ? position : beside.first, position};
      }
    }
    // Those that would let a path leave out much of the chain stay outside: it may go around something.
    for (const int v : corridor_) {
      if (reach_[v].last - reach_[v].first > max_reach) reach_[v] = {};
    }
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      reach_[vertices[i]] = {static_cast<int>(i), static_cast<int>(i)};
      corridor_.push_back(vertices[i]);
    }
  }
  bool on_plane(int v) const { return to_.is_symmetric() && to_.side(v) == 0; }

  SeamEdges between(const std::vector<int>& vertices) const {
    const int start = coarse_.vertex[vertices.front()];
    std::vector<char> target(on_cut_.size(), 0);
    bool any = false;
    for (const int v : members_[vertices.back()]) {
      target[v] = on_cut_[v];
      any = any || on_cut_[v] != 0;
    }
    if (!any) target[coarse_.vertex[vertices.back()]] = 1;
    const bool in_plane = on_plane(start);
    for (const bool apart : {true, false}) {
      SeamEdges path = to_.graph().path(start, target, [&](int e, int from) {
        const auto& edge = to_.graph().edges()[e];
        const int next = edge.other_end(from);
        const Reach& here = reach(from);
        const Reach& there = reach(next);
        if (there.first < 0 || there.first > here.last + 1 || here.first > there.last + 1) return false;
        const int cluster = coarse_.cluster[next];
        const bool at_end = cluster == vertices.back();
        if (to_.is_symmetric() && (to_.side(next) < 0 || (in_plane ? !on_plane(next) : on_plane(next) && !at_end)))
          return false;
        // Only where chains meet may they have vertices in common.
        return !apart || on_cut_[next] == 0 || at_end || cluster == vertices.front();
      });
      if (!path.empty() || target[start] != 0) return path;
    }
    return {};
  }

  /// From a vertex to an edge across the mirror plane, and this edge.
  SeamEdges across_plane(int vertex) const {
    const auto edge_across = [&](int v) { return to_.graph().find_edge(v, to_.mirrored(v)); };
    int v = coarse_.vertex[vertex];
    std::vector<char> target(on_cut_.size(), 0);
    for (const int member : members_[vertex]) target[member] = edge_across(member) >= 0 ? 1 : 0;
    SeamEdges path = to_.graph().path(v, target, [&](int e, int) {
      const auto& ends = to_.graph().edges()[e].vertices;
      return coarse_.cluster[ends[0]] == vertex && coarse_.cluster[ends[1]] == vertex;
    });
    for (const int e : path) v = to_.graph().edges()[e].other_end(v);
    if (target[v] != 0) path.push_back(edge_across(v));
    return path;
  }

  const CoarsePiece& coarse_;
  const PieceSeams& from_;
  bool is_wide_;
  PieceSeams& to_;
  std::vector<Reach> reach_;   ///< per coarse vertex, of the chain that is carried
  std::vector<int> corridor_;  ///< coarse vertices with a reach
  std::vector<char> on_seam_;  ///< per coarse vertex
  std::vector<char> on_cut_;   ///< per fine vertex
  Grouped<int> members_;       ///< fine vertices per coarse one
};

/// Euler characteristic and boundary loops of the charts of a piece, ascending.
std::vector<std::array<int, 2>> chart_topology(const PieceSeams& seams) {
  PolygonMesh mesh = seams.piece().view();
  const std::vector<std::array<int, 2>> edges = seams.changed({}, {});
  mesh.seam_edges = edges.data();
  mesh.n_seam_edges = static_cast<int>(edges.size());
  std::vector<std::array<int, 2>> result;
  for (const Chart& chart : build_charts(mesh).charts) {
    result.push_back({chart.euler_characteristic, static_cast<int>(chart.boundary_loops.size())});
  }
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace

std::vector<SeamEdges> carry_seams(const CoarsePiece& coarse, const PieceSeams& from,
                                   const std::vector<SeamEdges>& cuts, PieceSeams& to) {
  if (!from.is_symmetric()) to.forget_symmetry();
  const SeamChains chains(from, cuts);
  std::vector<SeamEdges> result;
  // In wide corridors paths are shorter, but in a narrow place one may pass on the other side of it.
  for (const bool is_wide : {true, false}) {
    to.remove(SeamEdges(to.edges()));
    result.assign(cuts.size(), {});
    SeamCarrier carrier(coarse, from, is_wide, to);
    for (const CoarseChain& chain : chains.chains()) {
      const SeamEdges path = carrier.carry(chain);
      SeamEdges& cut = result[static_cast<std::size_t>(chain.cut)];
      cut.insert(cut.end(), path.begin(), path.end());
    }
    if (is_wide && chart_topology(from) == chart_topology(to)) break;
  }
  return result;
}

}  // namespace spectral_conformal
