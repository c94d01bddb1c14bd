#include "seams/piece_seams.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "graph/disjoint_sets.h"
#include "mesh/boundary_loops.h"
#include "seams/handle_cuts.h"

namespace spectral_conformal {

PieceSeams::PieceSeams(const Piece& piece, int index, PieceMirror mirror, const MirrorSymmetry& symmetry)
    : piece_(&piece),
      graph_(SeamGraph::of(piece.view())),
      mirror_(std::move(mirror)),
      symmetric_(mirror_.image == index),
      side_(piece.vertices.size(), 0),
      loops_(std::make_shared<const EdgeLoops>(EdgeLoops::of(graph_))) {
  if (!symmetric_) return;
  for (std::size_t v = 0; v < side_.size(); ++v) side_[v] = symmetry.side[piece.vertices[v]];
}

void PieceSeams::scale_costs(const std::vector<double>& factors) {
  for (int e = 0; e < n_edges(); ++e) graph_.scale_cost(e, factors[e]);
}

double PieceSeams::length(const SeamEdges& edges) const {
  if (piece_->given.rows() == 0) return graph_.length(edges);
  double sum = 0;
  for (const int edge : edges) {
    const auto [a, b] = graph_.edges()[edge].vertices;
    sum += (piece_->given.row(a) - piece_->given.row(b)).norm();
  }
  return sum;
}

void PieceSeams::add(const SeamEdges& edges) {
  for (const int edge : edges) {
    graph_.cut(edge);
    edges_.push_back(edge);
  }
}

double PieceSeams::cost(const SeamEdges& edges) const {
  double sum = 0;
  for (const int edge : edges) sum += graph_.edges()[edge].cost;
  return sum;
}

SeamEdges PieceSeams::edges_after(const SeamEdges& added, const SeamEdges& removed) const {
  const std::set<int> gone(removed.begin(), removed.end());
  SeamEdges left = added;
  std::copy_if(edges_.begin(), edges_.end(), std::back_inserter(left), [&](int edge) { return gone.count(edge) == 0; });
  return left;
}

double PieceSeams::turning(const SeamEdges& added, const SeamEdges& removed) const {
  return graph_.turning(edges_after(added, removed));
}

/// The shares are rounded: lengths summed up in another order must not make a half more than one.
std::vector<PieceSeams::OpenRing> PieceSeams::rings_left_open(const SeamEdges& added, const SeamEdges& removed) const {
  constexpr double steps = 1024;
  std::vector<OpenRing> result;
  if (!graph_.turns_cost()) return result;
  const SeamEdges edges = edges_after(added, removed);
  std::map<int, double> cut;  // per loop, the length
  for (const int edge : edges) {
    const int loop = loops_->loop_of[edge];
    if (loop >= 0) cut[loop] += graph_.edges()[edge].length;
  }
  std::vector<char> is_cut;  // per edge
  for (const auto& [loop, length] : cut) {
    const SeamEdges& whole = loops_->loops[loop];
    const double share = std::round(steps * length / graph_.length(whole)) / steps;
    if (!(share > 0.5)) continue;
    if (is_cut.empty()) {
      for (const SeamGraph::Edge& edge : graph_.edges()) is_cut.push_back(edge.cut ? 1 : 0);
      for (const int edge : removed) is_cut[edge] = 0;
      for (const int edge : added) is_cut[edge] = 1;
    }
    SeamEdges missing;
    std::copy_if(whole.begin(), whole.end(), std::back_inserter(missing), [&](int edge) { return is_cut[edge] == 0; });
    DisjointSets islands(piece_->n_faces());
    poll(20.0 * n_edges());
    for (int e = 0; e < n_edges(); ++e) {
      const auto [one, other] = graph_.edges()[e].faces;
      if (is_cut[e] == 0 && loops_->loop_of[e] != loop) islands.unite(one, other);
    }
    const bool is_hinge = std::any_of(missing.begin(), missing.end(), [&](int edge) {
      const auto [one, other] = graph_.edges()[edge].faces;
      return islands.find(one) != islands.find(other);
    });
    if (is_hinge) result.push_back({std::move(missing), share});
  }
  return result;
}

double PieceSeams::open_rings(const SeamEdges& added, const SeamEdges& removed) const {
  double sum = 0;
  for (const OpenRing& ring : rings_left_open(added, removed)) sum += 2 * ring.share - 1;
  return sum;
}

std::vector<SeamEdges> PieceSeams::missing_in_rings() const {
  std::vector<SeamEdges> result;
  for (const OpenRing& ring : rings_left_open({}, {})) {
    SeamEdges missing = with_images(ring.missing);
    std::sort(missing.begin(), missing.end());
    if (std::find(result.begin(), result.end(), missing) == result.end()) result.push_back(std::move(missing));
  }
  return result;
}

void PieceSeams::remove(const SeamEdges& edges) {
  if (edges.empty()) return;
  const std::set<int> gone(edges.begin(), edges.end());
  for (const int edge : edges) graph_.uncut(edge);
  edges_.erase(std::remove_if(edges_.begin(), edges_.end(), [&](int edge) { return gone.count(edge) > 0; }),
               edges_.end());
}

std::vector<std::array<int, 2>> PieceSeams::changed(const SeamEdges& added, const SeamEdges& removed) const {
  const std::set<int> gone(removed.begin(), removed.end());
  std::vector<std::array<int, 2>> seams = piece_->seams;
  for (const int edge : edges_) {
    if (gone.count(edge) == 0) seams.push_back(graph_.edges()[edge].vertices);
  }
  for (const int edge : added) seams.push_back(graph_.edges()[edge].vertices);
  return seams;
}

std::vector<SeamChain> PieceSeams::chains() const {
  std::set<int> left(edges_.begin(), edges_.end());
  std::vector<SeamChain> result;
  while (!left.empty()) {
    const int first = *left.begin();
    left.erase(left.begin());
    std::array<SeamEdges, 2> beyond;  // the first edge, at each of its ends
    SeamChain chain{};
    for (const std::size_t side : {0, 1}) {
      int v = graph_.edges()[first].vertices[side];
      for (bool goes_on = true; goes_on;) {
        goes_on = false;
        if (graph_.n_cuts(v) != 2) break;
        for (const auto& arc : graph_.adjacency().arcs(v)) {
          if (goes_on || left.erase(arc.edge) == 0) continue;
          beyond[side].push_back(arc.edge);
          v = arc.to;
          goes_on = true;
        }
      }
      chain.ends[side] = v;
      chain.is_tip[side] = graph_.n_cuts(v) == 1;
    }
    chain.edges.assign(beyond[0].rbegin(), beyond[0].rend());
    chain.edges.push_back(first);
    chain.edges.insert(chain.edges.end(), beyond[1].begin(), beyond[1].end());
    const std::set<int> own(chain.edges.begin(), chain.edges.end());
    for (const int edge : chain.edges) {
      const int image = mirror_edge(edge);
      chain.is_own_image = chain.is_own_image || own.count(image) > 0;
      left.erase(image);
    }
    result.push_back(std::move(chain));
  }
  return result;
}

SeamEdges PieceSeams::with_cut_images(const SeamEdges& some) const {
  SeamEdges all = some;
  for (const int edge : some) {
    const int image = mirror_edge(edge);
    if (image >= 0 && graph_.edges()[image].cut) all.push_back(image);
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

SeamEdges PieceSeams::straightened(const SeamChain& chain, double corridor) const {
  if (chain.edges.size() < 2) return {};
  const SeamEdges found = with_images(chain.ends[0] == chain.ends[1]
                                          ? straight_loop(chain, corridor)
                                          : straight_path(chain.is_own_image ? half_of(chain) : chain, corridor));
  if (found.empty()) return {};
  return cost_with_turns(found) < cost_with_turns(with_images(chain.edges)) ? found : SeamEdges{};
}

/// The half of an open chain that is its own image, from the mirror plane on; no edges if it crosses the plane between
/// two vertices, or lies in it.
SeamChain PieceSeams::half_of(const SeamChain& chain) const {
  const std::vector<int> vertices = vertices_of(chain);
  const auto middle = static_cast<std::ptrdiff_t>(chain.edges.size() / 2);
  SeamChain half{};
  if (chain.edges.size() % 2 != 0 || !on_axis(vertices[static_cast<std::size_t>(middle)])) return half;
  half.edges.assign(chain.edges.begin() + middle, chain.edges.end());
  half.ends = {vertices[static_cast<std::size_t>(middle)], chain.ends[1]};
  return half;
}

/// (V,) whether a chain may end there as well as at one of its ends: where the cuts go on that meet it there, or where
/// the mirror plane does that it crosses, in its own half of the corridor. nearest: of the chain's vertices.
std::vector<char> PieceSeams::possible_ends(const SeamChain& chain, std::size_t end, const std::vector<int>& nearest,
                                            double radius) const {
  const int own_side = side_of(chain);
  const int at = chain.ends[end];
  std::vector<char> result(static_cast<std::size_t>(graph_.n_vertices()), 0);
  const auto middle = static_cast<int>(chain.edges.size() / 2);
  const auto add = [&](int v) {
    const bool is_in_half = nearest[v] >= 0 && (end == 0 ? nearest[v] <= middle : nearest[v] > middle);
    if (is_in_half && (own_side == 0 ? side(v) == 0 : side(v) * own_side >= 0)) result[v] = 1;
  };
  if (graph_.n_cuts(at) > 0) {
    // Where length alone counts, seams are taken back edge by edge instead (seam_retraction.h): with both, the seams of
    // 18 meshes within an energy were 3 % longer.
    for (const int v : graph_.along_cuts(at, graph_.turns_cost() ? radius : 0)) add(v);
  } else if (on_axis(at)) {
    for (int v = 0; v < graph_.n_vertices(); ++v) {
      if (on_axis(v) && graph_.n_cuts(v) == 0) add(v);
    }
  }
  result[at] = 1;
  return result;
}

SeamEdges PieceSeams::straight_path(const SeamChain& chain, double corridor) const {
  if (chain.edges.empty()) return {};
  const int own_side = side_of(chain);
  const double radius = corridor * graph_.length(chain.edges);
  const std::vector<int> nearest = graph_.nearest(vertices_of(chain), radius);
  // A step over more than half of a chain would close the loop that the chain nearly is.
  const int longest_step = std::max(1, static_cast<int>(chain.edges.size() / 2));
  const auto path_from = [&](int start, const std::vector<char>& target) {
    return graph_.path(start, target, [&](int e, int from) {
      const int to = graph_.edges()[e].other_end(from);
      if (graph_.edges()[e].cut) return false;
      if (nearest[to] < 0 || std::abs(nearest[to] - nearest[from]) > longest_step) return false;
      return target[to] != 0 || (graph_.n_cuts(to) == 0 && (!symmetric_ || side(to) * own_side > 0));
    });
  };
  // One end slides after the other.
  int end = chain.ends[0];
  for (const int e : path_from(end, possible_ends(chain, 1, nearest, radius))) end = graph_.edges()[e].other_end(end);
  return end == chain.ends[0] ? SeamEdges{} : path_from(end, possible_ends(chain, 0, nearest, radius));
}

SeamEdges PieceSeams::straight_loop(const SeamChain& chain, double corridor) const {
  const int own_side = side_of(chain);
  const int n = static_cast<int>(chain.edges.size());
  const std::vector<int> nearest = graph_.nearest(vertices_of(chain), corridor * graph_.length(chain.edges));
  // Whether a loop stays on the chain's side of the mirror plane, or is its own image if the chain is.
  const auto fits_image = [&](const SeamEdges& loop) {
    if (!symmetric_) return true;
    if (chain.is_own_image) return std::find(loop.begin(), loop.end(), mirror_edge(loop.front())) != loop.end();
    return std::all_of(loop.begin(), loop.end(), [&](int e) {
      const auto [a, b] = graph_.edges()[e].vertices;
      return side(a) * own_side >= 0 && side(b) * own_side >= 0;
    });
  };
  const auto runs_around_once = [&](const SeamEdges& loop) {
    int around = 0;
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const int from = graph_.common_vertex(loop[k], loop[k > 0 ? k - 1 : loop.size() - 1]);
      const int to = graph_.edges()[loop[k]].other_end(from);
      if (nearest[from] < 0 || nearest[to] < 0 || graph_.edges()[loop[k]].cut) return false;
      int step = nearest[to] - nearest[from];
      step += 2 * step > n ? -n : 2 * step < -n ? n : 0;
      around += step;
    }
    return std::abs(around) == n;
  };
  SeamEdges best;
  double least = infinity;
  for (const SeamEdges& loop : loops_->loops) {
    if (loop.size() < 3 || nearest[graph_.edges()[loop.front()].vertices[0]] < 0) continue;
    poll(loop.size());
    const double loop_cost = cost_with_turns(loop);
    if (!(loop_cost < least) || !runs_around_once(loop) || !fits_image(loop)) continue;
    least = loop_cost;
    best = loop;
  }
  // Other cuts that meet the chain go on to the loop.
  const int junction = chain.ends[0];
  if (best.empty() || graph_.n_cuts(junction) == 0) return best;
  std::vector<char> target(static_cast<std::size_t>(graph_.n_vertices()), 0);
  for (const int e : best) {
    for (const int v : graph_.edges()[e].vertices) target[v] = 1;
  }
  if (target[junction] != 0) return best;
  const SeamEdges rest = graph_.path(junction, target, [&](int e, int from) {
    const int to = graph_.edges()[e].other_end(from);
    return !graph_.edges()[e].cut && nearest[to] >= 0 && side(to) * side(junction) >= 0 &&
           (!on_axis(from) || on_axis(to));
  });
  if (rest.empty()) return {};
  best.insert(best.end(), rest.begin(), rest.end());
  return best;
}

/// A chain on one side of the mirror plane stays there: 0 for one in the plane.
int PieceSeams::side_of(const SeamChain& chain) const {
  int own_side = 0;
  for (const int edge : chain.edges) {
    for (const int v : graph_.edges()[edge].vertices) own_side = own_side != 0 ? own_side : side(v);
  }
  return own_side;
}

std::vector<int> PieceSeams::vertices_of(const SeamChain& chain) const {
  std::vector<int> vertices{chain.ends[0]};
  for (const int edge : chain.edges) vertices.push_back(graph_.edges()[edge].other_end(vertices.back()));
  return vertices;
}

int PieceSeams::mirrored_chart(int face, const std::vector<int>& chart_of_face) const {
  return chart_of_face[symmetric_ ? mirror_.face[face] : face];
}

bool PieceSeams::self_mirrored(int face, const std::vector<int>& chart_of_face) const {
  return symmetric_ && mirrored_chart(face, chart_of_face) == chart_of_face[face];
}

int PieceSeams::on_positive_side(int vertex) const {
  return symmetric_ && side_[vertex] < 0 ? mirror_.vertex[vertex] : vertex;
}

bool PieceSeams::along_axis(int edge) const {
  return on_axis(graph_.edges()[edge].vertices[0]) && on_axis(graph_.edges()[edge].vertices[1]);
}

int PieceSeams::mirror_edge(int edge) const {
  if (!symmetric_) return -1;
  const auto [a, b] = graph_.edges()[edge].vertices;
  return graph_.find_edge(mirror_.vertex[a], mirror_.vertex[b]);
}

SeamEdges PieceSeams::with_images(const SeamEdges& path) const {
  SeamEdges result;
  std::set<int> known;
  for (const int edge : path) {
    if (!graph_.edges()[edge].cut && known.insert(edge).second) result.push_back(edge);
  }
  if (!symmetric_) return result;
  const std::size_t n = result.size();
  for (std::size_t i = 0; i < n; ++i) {
    const int image = mirror_edge(result[i]);
    if (image >= 0 && known.insert(image).second) result.push_back(image);
  }
  return result;
}

std::vector<SeamEdges> PieceSeams::open() {
  std::vector<SeamEdges> cuts = handle_cuts(piece_->view(), graph_, [&](int edge) { return mirror_edge(edge); });
  for (const SeamEdges& cut : cuts) add(cut);
  if (std::none_of(graph_.edges().begin(), graph_.edges().end(), [](const auto& edge) { return edge.cut; })) {
    cuts.push_back(first_slit());
    add(cuts.back());
  }
  const SeamEdges bridge = symmetric_outer_loop();
  if (!bridge.empty()) {
    cuts.push_back(bridge);
    add(bridge);
  }
  return cuts;
}

/// The slit that opens a surface without boundary: between vertices far apart, in the mirror plane if edges lie in it.
SeamEdges PieceSeams::first_slit() {
  int axis_edge = -1;
  for (int e = 0; e < n_edges() && axis_edge < 0; ++e) {
    if (along_axis(e)) axis_edge = e;
  }
  symmetric_ = symmetric_ && axis_edge >= 0;
  const auto allowed = [&](int edge) { return !symmetric_ || along_axis(edge); };
  const int one = graph_.farthest_vertex(graph_.edges()[symmetric_ ? axis_edge : 0].vertices[0], allowed);
  std::vector<char> target(static_cast<std::size_t>(graph_.n_vertices()), 0);
  target[graph_.farthest_vertex(one, allowed)] = 1;
  return graph_.path(one, target, [&](int edge, int) { return allowed(edge); });
}

SeamEdges PieceSeams::symmetric_outer_loop() const {
  if (!symmetric_) return {};
  const std::vector<std::array<int, 2>> seams = changed({}, {});
  const PolygonMesh mesh = piece_->view(seams);
  const ChartDecomposition decomposition = build_charts(mesh);
  const Chart& chart = decomposition.charts.front();
  if (chart.boundary_loops.size() < 2) return {};
  const int outer = outer_loop(chart.boundary_loops, chart.positions(mesh));
  std::set<int> loop;
  for (const int v : chart.boundary_loops[outer]) loop.insert(chart.vertices[v]);
  const int start = *loop.begin();
  if (loop.count(mirror_.vertex[start]) > 0) return {};
  std::vector<char> axis(static_cast<std::size_t>(graph_.n_vertices()), 0);
  for (int v = 0; v < graph_.n_vertices(); ++v) axis[v] = on_axis(v) ? 1 : 0;
  return with_images(graph_.path(on_positive_side(start), axis,
                                 [&](int e, int from) { return side_[graph_.edges()[e].other_end(from)] >= 0; }));
}

bool PieceSeams::in_chart(int edge, int chart, const std::vector<int>& chart_of_face) const {
  const auto& faces = graph_.edges()[edge].faces;
  return std::any_of(faces.begin(), faces.end(), [&](int face) { return face >= 0 && chart_of_face[face] == chart; });
}

SeamEdges PieceSeams::cut_to(int vertex, bool on_loop, int face, const std::vector<int>& chart_of_face) const {
  const bool halved = self_mirrored(face, chart_of_face);
  std::vector<char> target(static_cast<std::size_t>(graph_.n_vertices()), 0);
  for (int v = 0; v < graph_.n_vertices(); ++v) target[v] = graph_.n_cuts(v) > 0 ? 1 : 0;
  std::vector<char> own_loop(target.size(), 0);
  if (on_loop) {
    const std::vector<double> along = graph_.distances({vertex}, [&](int edge) { return graph_.edges()[edge].cut; });
    for (std::size_t v = 0; v < along.size(); ++v) {
      if (!std::isfinite(along[v])) continue;
      own_loop[v] = 1;
      target[v] = 0;
    }
  }
  const bool own_loop_halved = halved && on_loop && own_loop[mirror_.vertex[vertex]] != 0;
  const auto allowed = [&](int e, int from) {
    if (!in_chart(e, chart_of_face[face], chart_of_face)) return false;
    const auto& edge = graph_.edges()[e];
    if (!halved || edge.cut) return true;
    const int to = edge.other_end(from);
    // A path that leaves the mirror plane, or its own loop off the plane, would enclose an island with its image.
    if (side_[to] < 0 || (on_axis(from) && !on_axis(to))) return false;
    return !(own_loop_halved && own_loop[from] != 0 && !on_axis(from));
  };
  return with_images(graph_.path(vertex, target, allowed));
}

/// Makes a side symmetric if it is mostly its own mirror image, otherwise disjoint from its image.
void PieceSeams::clear_of_image(const SeparableFaces& faces, std::vector<char>& side) const {
  const std::vector<char> whole = side;
  const auto shared = [&](std::size_t f) {
    const int image = faces.index(mirror_.face[faces.faces[f]]);
    return whole[f] != 0 && image >= 0 && whole[image] != 0;
  };
  double own_area = 0;
  double shared_area = 0;
  for (std::size_t f = 0; f < side.size(); ++f) {
    own_area += whole[f] != 0 ? faces.area[f] : 0;
    shared_area += shared(f) ? faces.area[f] : 0;
  }
  for (std::size_t f = 0; f < side.size(); ++f) {
    side[f] = 2 * shared_area > own_area ? shared(f) : whole[f] != 0 && !shared(f);
  }
}

SeamEdges PieceSeams::cut_apart(const SeparableFaces& faces, const std::vector<int>& sources,
                                const std::vector<int>& sinks, const std::vector<int>& chart_of_face) const {
  std::vector<char> side = separating_side(faces, sources, sinks, min_island);
  if (self_mirrored(faces.faces.front(), chart_of_face)) clear_of_image(faces, side);
  return between_sides(faces, side);
}

SeamEdges PieceSeams::loop_through(int vertex, std::size_t which, int face,
                                   const std::vector<int>& chart_of_face) const {
  std::vector<int> found;
  for (const auto& arc : graph_.adjacency().arcs(vertex)) {
    const int loop = loops_->loop_of[arc.edge];
    if (loop >= 0 && std::find(found.begin(), found.end(), loop) == found.end()) found.push_back(loop);
  }
  if (which >= found.size()) return {};
  const SeamEdges& edges = loops_->loops[found[which]];
  const bool is_inside =
      std::all_of(edges.begin(), edges.end(), [&](int e) { return in_chart(e, chart_of_face[face], chart_of_face); });
  return is_inside ? with_images(edges) : SeamEdges{};
}

SeamEdges PieceSeams::border(const SeparableFaces& faces, const std::vector<int>& some) const {
  std::vector<char> side(faces.size(), 0);
  for (const int face : some) side[face] = 1;
  return between_sides(faces, side);
}

SeamEdges PieceSeams::between_sides(const SeparableFaces& faces, const std::vector<char>& side) const {
  SeamEdges between;
  for (int face = 0; face < faces.dual.n_nodes(); ++face) {
    for (const auto& arc : faces.dual.arcs(face)) {
      if (face < arc.to && side[face] != side[arc.to]) between.push_back(arc.edge);
    }
  }
  std::sort(between.begin(), between.end());
  return with_images(between);
}

}  // namespace spectral_conformal
