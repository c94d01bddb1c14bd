#include "seams/carried_seams.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <utility>

#include "graph/grouped.h"

namespace spectral_conformal {
namespace {

/// Consecutive vertices of a coarse piece along its seams.
using CoarseChain = std::vector<int>;

/// Adds a chain. One that is closed, or leaves the mirror plane and returns, is halved; one that only leaves it is
/// reversed. A path is found from the first vertex to the last, and only the last may be on the plane.
void add_chain(const PieceSeams& seams, CoarseChain&& chain, std::vector<CoarseChain>& chains) {
  const auto on_plane = [&](int v) { return seams.is_symmetric() && seams.side(v) == 0; };
  const bool in_plane = std::all_of(chain.begin(), chain.end(), on_plane);
  const bool both_on_plane = !in_plane && on_plane(chain.front()) && on_plane(chain.back());
  if (chain.size() > 2 && (chain.front() == chain.back() || both_on_plane)) {
    const auto middle = chain.begin() + static_cast<std::ptrdiff_t>(chain.size() / 2);
    chains.emplace_back(middle, chain.end());
    chain.erase(middle + 1, chain.end());
    std::reverse(chain.begin(), chain.end());
  } else if (!in_plane && on_plane(chain.front())) {
    std::reverse(chain.begin(), chain.end());
  }
  chains.push_back(std::move(chain));
}

/// The seam chains of a coarse piece, split where they meet the mirror plane. Of two mirrored chains, only the one on
/// the positive side. An edge across the plane is a chain of its own.
std::vector<CoarseChain> coarse_chains(const PieceSeams& seams) {
  std::vector<CoarseChain> result;
  const auto side = [&](int v) { return seams.is_symmetric() ? seams.side(v) : 1; };
  for (const SeamChain& chain : seams.chains()) {
    CoarseChain run;
    const auto end_run = [&] {
      if (run.size() > 1) add_chain(seams, std::move(run), result);
      run.clear();
    };
    int v = chain.ends[0];
    for (const int e : chain.edges) {
      int from = v;
      v = seams.graph().edges()[e].other_end(from);
      int to = v;
      if (side(from) + side(to) < 0) {
        if (chain.is_own_image) continue;
        from = seams.mirrored(from);
        to = seams.mirrored(to);
      }
      const bool crosses = side(from) * side(to) < 0;
      const bool goes_on = !run.empty() && run.back() == from && !crosses && side(run[run.size() - 2]) >= 0 &&
                           (side(from) != 0 || (side(to) == 0 && side(run[run.size() - 2]) == 0));
      if (!goes_on) end_run();
      if (!goes_on) run.push_back(from);
      run.push_back(to);
      if (!crosses) continue;
      if (side(from) < 0) std::reverse(run.begin(), run.end());
      end_run();
    }
    end_run();
  }
  return result;
}

/// Finds the paths on the fine piece.
class SeamCarrier {
 public:
  SeamCarrier(const CoarsePiece& coarse, PieceSeams& to)
      : coarse_(coarse),
        to_(to),
        position_(coarse.vertex.size(), -1),
        on_cut_(coarse.cluster.size(), 0),
        members_(static_cast<int>(coarse.vertex.size()), [&](const auto& visit) {
          for (std::size_t v = 0; v < coarse.cluster.size(); ++v) visit(coarse.cluster[v], static_cast<int>(v));
        }) {
    for (const auto& edge : to.graph().edges()) {
      if (edge.cut) on_cut_[edge.vertices[0]] = on_cut_[edge.vertices[1]] = 1;
    }
  }
  /// Adds the path of a coarse chain to the new seams.
  void carry(const CoarseChain& vertices) {
    for (std::size_t i = 0; i < vertices.size(); ++i) position_[vertices[i]] = static_cast<int>(i);
    const bool crosses = to_.is_symmetric() &&
                         to_.side(coarse_.vertex[vertices.front()]) * to_.side(coarse_.vertex[vertices.back()]) < 0;
    const SeamEdges path = to_.with_images(crosses ? across_plane(vertices.front()) : between(vertices));
    for (const int v : vertices) position_[v] = -1;
    for (const int e : path) {
      for (const int v : to_.graph().edges()[e].vertices) on_cut_[v] = 1;
    }
    to_.add(path);
  }

 private:
  bool on_plane(int v) const { return to_.is_symmetric() && to_.side(v) == 0; }

  SeamEdges between(const CoarseChain& vertices) const {
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
        const int cluster = coarse_.cluster[next];
        if (position_[cluster] < 0 || std::abs(position_[cluster] - position_[coarse_.cluster[from]]) > 1) return false;
        const bool at_end = cluster == vertices.back();
        if (to_.is_symmetric() && (to_.side(next) < 0 || (in_plane ? !on_plane(next) : on_plane(next) && !at_end)))
          return false;
        // Chains may share vertices only where they meet.
        return !apart || on_cut_[next] == 0 || at_end || cluster == vertices.front();
      });
      if (!path.empty() || target[start] != 0) return path;
    }
    return {};
  }

  /// The path within the cluster of a coarse vertex to an edge across the mirror plane, and that edge.
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
  PieceSeams& to_;
  std::vector<int> position_;  ///< per coarse vertex: its index in the current chain, or -1
  std::vector<char> on_cut_;   ///< per fine vertex: whether a cut edge ends there
  Grouped<int> members_;       ///< the fine vertices of each coarse one
};

}  // namespace

void carry_seams(const CoarsePiece& coarse, const PieceSeams& from, PieceSeams& to) {
  if (!from.is_symmetric()) to.forget_symmetry();
  SeamCarrier carrier(coarse, to);
  for (const CoarseChain& chain : coarse_chains(from)) carrier.carry(chain);
}

}  // namespace spectral_conformal
