#include "seams/seam_graph.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "concurrency/cancellation_scope.h"
#include "concurrency/work_counter.h"
#include "geometry/polygon_normal.h"
#include "graph/shortest_paths.h"
#include "mesh/edge_table.h"
#include "seams/seam_price.h"

namespace spectral_conformal {
namespace {

/// The power of two next to 2^-22 times the extent of the selected faces; 0 without an extent.
double cost_step_of(const PolygonMesh& mesh) {
  Eigen::RowVector3d low = Eigen::RowVector3d::Constant(infinity);
  Eigen::RowVector3d high = -low;
  for_each_selected_corner(mesh, [&](int c, int) {
    const Eigen::Map<const Eigen::RowVector3d> point(mesh.position(mesh.corner_vertices[c]));
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  });
  const double extent = (high - low).maxCoeff();
  return extent > 0 && std::isfinite(extent) ? std::exp2(std::round(std::log2(extent)) - 22) : 0;
}

struct FaceShape {
  Eigen::Vector3d normal;
  Eigen::Vector3d center;
};

/// The unit normal and the mean of the corners.
FaceShape shape_of(const PolygonMesh& mesh, const Positions& positions, int face) {
  const int first = mesh.face_offsets[face];
  const int size = mesh.face_offsets[face + 1] - first;
  Positions corners(size, 3);
  FaceShape shape{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  for (int i = 0; i < size; ++i) {
    corners.row(i) = positions.row(mesh.corner_vertices[first + i]);
    shape.center += corners.row(i).transpose() / size;
  }
  shape.normal = polygon_normal(corners, corners.row(0).transpose()).normalized();
  return shape;
}

}  // namespace

SeamGraph SeamGraph::of(const PolygonMesh& mesh) {
  validate(mesh);
  SeamGraph result;
  result.positions_ = Eigen::Map<const Positions>(mesh.positions, mesh.n_vertices, 3);
  result.cost_step_ = cost_step_of(mesh);
  result.collect_edges(mesh);
  result.count_cuts();
  std::vector<std::array<int, 2>> ends;
  ends.reserve(result.edges_.size());
  for (const Edge& edge : result.edges_) ends.push_back(edge.vertices);
  result.adjacency_ = Adjacency(mesh.n_vertices, ends);
  for (int i = 0; i < mesh.n_seam_edges; ++i) {
    const int edge = result.find_edge(mesh.seam_edges[i][0], mesh.seam_edges[i][1]);
    if (edge >= 0) result.cut(edge);
  }
  result.price_edges(mesh);
  result.flow_ = EdgeFlow::of(mesh, result);
  return result;
}

void SeamGraph::collect_edges(const PolygonMesh& mesh) {
  const EdgeTable<int> faces(mesh.n_vertices, [&](const auto& visit) {
    for_each_side(mesh, [&](int c, int next, int face) {
      const int a = mesh.corner_vertices[c];
      const int b = mesh.corner_vertices[next];
      if (a != b) visit(a, b, face);
    });
    poll(mesh.n_corners());
  });
  edges_.reserve(faces.n_edges());
  faces.for_each_edge([&](const std::array<int, 2>& ends, const auto* first, const auto* last) {
    const double length = (positions_.row(ends[0]) - positions_.row(ends[1])).norm();
    const int other = last - first > 1 ? first[1].value : -1;
    edges_.push_back({ends, {first->value, other}, length, length, last - first != 2, Eigen::Vector3d::Zero()});
  });
  dual_ = Adjacency::from_arcs(mesh.n_faces, [&](auto&& visit) {
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      if (edges_[e].cut) continue;
      const auto [one, other] = edges_[e].faces;
      visit(one, static_cast<int>(e), other);
      visit(other, static_cast<int>(e), one);
    }
  });
}

void SeamGraph::count_cuts() {
  n_cuts_.assign(static_cast<std::size_t>(positions_.rows()), 0);
  for (const Edge& edge : edges_) {
    for (const int v : edge.vertices) n_cuts_[v] += edge.cut ? 1 : 0;
  }
}

void SeamGraph::set_cut(int edge, bool cut) {
  if (edges_[edge].cut == cut) return;
  edges_[edge].cut = cut;
  for (const int v : edges_[edge].vertices) n_cuts_[v] += cut ? 1 : -1;
}

void SeamGraph::price_edges(const PolygonMesh& mesh) {
  std::vector<FaceShape> shapes(static_cast<std::size_t>(mesh.n_faces));
  for (int face = 0; face < mesh.n_faces; ++face) {
    poll(mesh.face_offsets[face + 1] - mesh.face_offsets[face]);
    if (mesh.face_offsets[face + 1] > mesh.face_offsets[face]) shapes[face] = shape_of(mesh, positions_, face);
  }
  for (Edge& edge : edges_) {
    poll();
    if (edge.cut) continue;
    const FaceShape& left = shapes[edge.faces[0]];
    const FaceShape& right = shapes[edge.faces[1]];
    edge.normal = left.normal + right.normal;
    const Eigen::Vector3d middle = 0.5 * (positions_.row(edge.vertices[0]) + positions_.row(edge.vertices[1]));
    const bool concave = left.normal.dot(right.center - middle) > 0;
    edge.cost = rounded_cost(edge.length * seam_price(dihedral_angle(edge), concave));
  }
}

/// Nothing of a positive length becomes free.
double SeamGraph::rounded_cost(double cost) const {
  return cost_step_ > 0 && cost > 0 ? std::max(1.0, std::round(cost / cost_step_)) * cost_step_ : cost;
}

int SeamGraph::common_vertex(int one, int other) const {
  const auto& ends = edges_[one].vertices;
  const auto& others = edges_[other].vertices;
  return ends[0] == others[0] || ends[0] == others[1] ? ends[0] : ends[1];
}

double SeamGraph::length(const std::vector<int>& edges) const {
  double sum = 0;
  for (const int edge : edges) sum += edges_[edge].length;
  return sum;
}

double SeamGraph::dihedral_angle(const Edge& edge) {
  // The sum of two unit vectors with the angle theta between them has the length 2 cos(theta / 2).
  return 2 * std::acos(std::min(0.5 * edge.normal.norm(), 1.0));
}

int SeamGraph::find_edge(int a, int b) const {
  // Edges are sorted by their ends, the smaller end first, so the arcs of a vertex are sorted by where they lead.
  const auto arcs = adjacency_.arcs(a);
  const auto* const arc =
      std::lower_bound(arcs.begin(), arcs.end(), b, [](const Adjacency::Arc& other, int to) { return other.to < to; });
  return arc != arcs.end() && arc->to == b ? arc->edge : -1;
}

std::vector<double> SeamGraph::distances(const std::vector<int>& sources, const std::function<bool(int)>& allowed,
                                         std::vector<int>* parent) const {
  ShortestPathSearch search(n_vertices());
  for (const int source : sources) search.offer(source, 0);
  for (int vertex = search.settle(); vertex >= 0; vertex = search.settle()) {
    poll();
    for (const auto& [edge, to] : adjacency_.arcs(vertex)) {
      const double through = search.distance(vertex) + (edges_[edge].cut ? 0 : edges_[edge].cost);
      if (search.improves(to, through) && allowed(edge)) search.offer(to, through, edge);
    }
  }
  if (parent != nullptr) *parent = search.previous();
  return search.distances();
}

std::vector<int> SeamGraph::nearest(const std::vector<int>& sources, double radius) const {
  std::vector<int> result(static_cast<std::size_t>(n_vertices()), -1);
  ShortestPathSearch search(n_vertices());
  for (std::size_t i = 0; i < sources.size(); ++i) {
    search.offer(sources[i], 0);
    result[sources[i]] = static_cast<int>(i);
  }
  for (int vertex = search.settle(); vertex >= 0 && search.distance(vertex) <= radius; vertex = search.settle()) {
    poll();
    const int edge = search.previous(vertex);
    if (edge >= 0) result[vertex] = result[edges_[edge].other_end(vertex)];
    for (const auto& arc : adjacency_.arcs(vertex)) {
      search.offer(arc.to, search.distance(vertex) + edges_[arc.edge].length, arc.edge);
    }
  }
  return result;
}

std::vector<int> SeamGraph::along_cuts(int vertex, double radius) const {
  std::vector<int> result;
  ShortestPathSearch search(n_vertices());
  search.offer(vertex, 0);
  for (int v = search.settle(); v >= 0 && search.distance(v) <= radius; v = search.settle()) {
    poll();
    result.push_back(v);
    for (const auto& arc : adjacency_.arcs(v)) {
      if (edges_[arc.edge].cut) search.offer(arc.to, search.distance(v) + edges_[arc.edge].length);
    }
  }
  return result;
}

double SeamGraph::turn_cost(int vertex, int in, int out) const {
  const Edge& first = edges_[in];
  const Edge& second = edges_[out];
  if (!turns_cost() || onward(in, vertex) == out) return 0;
  const int from = first.other_end(vertex);
  const int to = second.other_end(vertex);
  const double lengths = first.length * second.length;
  if (!(lengths > 0)) return 0;
  const double cosine =
      (positions_.row(vertex) - positions_.row(from)).dot(positions_.row(to) - positions_.row(vertex)) / lengths;
  // A right angle costs one more edge, so a straight path may be a detour of one edge per turn.
  return rounded_turn((1 - cosine) * (0.5 * (first.cost + second.cost) + least_turn_));
}

double SeamGraph::rounded_turn(double cost) const {
  const double turn = turn_factor_ * cost;
  return cost_step_ > 0 ? std::round(turn / cost_step_) * cost_step_ : turn;
}

double SeamGraph::turning(const std::vector<int>& edges) const {
  std::vector<std::array<int, 2>> ends;  // vertex, edge
  ends.reserve(2 * edges.size());
  for (const int edge : edges) {
    for (const int v : edges_[edge].vertices) ends.push_back({v, edge});
  }
  std::sort(ends.begin(), ends.end());
  double sum = 0;
  for (std::size_t first = 0, last = 0; first < ends.size(); first = last) {
    while (last < ends.size() && ends[last][0] == ends[first][0]) ++last;
    const auto& [vertex, edge] = ends[first];
    if (last > first + 2 || onward(edge, vertex) < 0) continue;
    if (last == first + 2) {
      sum += turn_cost(vertex, edge, ends[first + 1][1]);
    } else if (least_turn_ > 0) {
      sum += rounded_turn(edges_[edge].cost + least_turn_);
    }
  }
  return sum;
}

int SeamGraph::farthest_vertex(int source, const std::function<bool(int)>& allowed) const {
  const std::vector<double> distance = distances({source}, allowed);
  int farthest = source;
  for (int v = 0; v < n_vertices(); ++v) {
    if (std::isfinite(distance[v]) && distance[v] > distance[farthest]) farthest = v;
  }
  return farthest;
}

std::vector<int> SeamGraph::path(int start, const std::vector<char>& is_target,
                                 const std::function<bool(int, int)>& allowed) const {
  if (is_target[start] != 0) return {};
  // The nodes of the search are arcs: the cost of a turn depends on the edge before it.
  ShortestPathSearch search(adjacency_.n_arcs());
  std::map<int, int> times_left;  // how often each hub was left
  double n_turns = 0;
  const auto turn_on_path = [&](int vertex, int in, int out) {
    return edges_[in].cut || edges_[out].cut ? 0 : turn_cost(vertex, in, out);
  };
  const auto leave = [&](int vertex, int from_arc) {
    const int n_edges = adjacency_.first_arc(vertex + 1) - adjacency_.first_arc(vertex);
    if (n_edges > hub_size && ++times_left[vertex] > hub_size * hub_size / n_edges + 1) return;
    n_turns += n_edges;
    poll(1 + n_edges);
    const double before = from_arc < 0 ? 0 : search.distance(from_arc);
    for (int k = adjacency_.first_arc(vertex); k < adjacency_.first_arc(vertex + 1); ++k) {
      const auto& out = adjacency_.arc(k);
      const double cost = edges_[out.edge].cut ? 0 : edges_[out.edge].cost;
      // The cheapest test first: turns are not negative.
      if (!search.improves(k, before + cost) || !allowed(out.edge, vertex)) continue;
      const double turn = from_arc < 0 ? 0 : turn_on_path(vertex, adjacency_.arc(from_arc).edge, out.edge);
      search.offer(k, before + (cost + turn), from_arc);
    }
  };
  leave(start, -1);
  int arc = search.settle();
  while (arc >= 0 && is_target[adjacency_.arc(arc).to] == 0) {
    leave(adjacency_.arc(arc).to, arc);
    arc = search.settle();
  }
  count_steps(n_turns);
  std::vector<int> result;
  for (int k = arc; k >= 0; k = search.previous(k)) result.push_back(adjacency_.arc(k).edge);
  std::reverse(result.begin(), result.end());
  return result;
}

}  // namespace spectral_conformal
