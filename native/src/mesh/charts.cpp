#include "mesh/charts.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "concurrency/parallel_calls.h"
#include "geometry/polygon_triangulation.h"
#include "graph/disjoint_sets.h"
#include "graph/grouped.h"
#include "mesh/half_edges.h"

namespace spectral_conformal {
namespace {

struct Components {
  std::vector<int> chart_of_face;
  std::vector<char> reversed;    ///< per face: wound against the majority of its chart
  std::vector<char> orientable;  ///< per chart
  std::vector<std::vector<int>> faces;
};

/// Connected components over twins, consistently oriented if possible.
Components connect(const PolygonMesh& mesh, const HalfEdges& half_edges) {
  Components result;
  result.chart_of_face.assign(static_cast<std::size_t>(mesh.n_faces), -1);
  result.reversed.assign(static_cast<std::size_t>(mesh.n_faces), 0);
  std::vector<char> seed_is_reversed;  // per chart: its first face is wound against the majority
  std::vector<int> open;               // last in, first out: neighbors are near in memory
  for (int seed = 0; seed < mesh.n_faces; ++seed) {
    if (!half_edges.is_used(seed) || result.chart_of_face[seed] >= 0) continue;
    const int chart = static_cast<int>(result.faces.size());
    bool orientable = true;
    std::ptrdiff_t n_faces = 0;
    std::ptrdiff_t n_reversed = 0;
    open.assign(1, seed);
    result.chart_of_face[seed] = chart;
    while (!open.empty()) {
      const int face = open.back();
      open.pop_back();
      poll();
      ++n_faces;
      n_reversed += result.reversed[face];
      for (int c = mesh.face_offsets[face]; c < mesh.face_offsets[face + 1]; ++c) {
        if (half_edges.twin(c) < 0) continue;
        const int other = half_edges.face(half_edges.twin(c));
        const char reversed =
            half_edges.is_opposed(c) ? result.reversed[face] : static_cast<char>(1 - result.reversed[face]);
        if (result.chart_of_face[other] < 0) {
          result.chart_of_face[other] = chart;
          result.reversed[other] = reversed;
          open.push_back(other);
        } else if (result.reversed[other] != reversed) {
          orientable = false;
        }
      }
    }
    seed_is_reversed.push_back(2 * n_reversed > n_faces ? 1 : 0);
    result.faces.emplace_back();
    result.faces.back().reserve(static_cast<std::size_t>(n_faces));
    result.orientable.push_back(orientable ? 1 : 0);
  }
  for (int face = 0; face < mesh.n_faces; ++face) {
    const int chart = result.chart_of_face[face];
    if (chart < 0) continue;
    result.faces[chart].push_back(face);
    if (seed_is_reversed[chart] != 0) result.reversed[face] = static_cast<char>(1 - result.reversed[face]);
  }
  return result;
}

/// Chains the boundary half-edges, which start at distinct vertices. `next_vertex` maps a chart vertex to the next one
/// along the boundary, or -1.
std::vector<BoundaryLoop> chain_loops(std::vector<int>& next_vertex) {
  std::vector<BoundaryLoop> loops;
  for (std::size_t seed = 0; seed < next_vertex.size(); ++seed) {
    if (next_vertex[seed] < 0) continue;
    BoundaryLoop loop;
    int vertex = static_cast<int>(seed);
    while (vertex >= 0 && next_vertex[vertex] >= 0) {
      loop.push_back(vertex);
      vertex = std::exchange(next_vertex[vertex], -1);
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

class ChartBuilder {
 public:
  ChartBuilder(const PolygonMesh& mesh, const HalfEdges& half_edges, const std::vector<char>& reversed,
               const std::vector<int>& vertex_of_corner)
      : mesh_(mesh), half_edges_(half_edges), reversed_(reversed), vertex_of_corner_(vertex_of_corner) {}

  /// Sets triangles, loops and the Euler characteristic of a chart from its faces and vertices.
  void complete(Chart& chart) {
    next_vertex_.assign(chart.vertices.size(), -1);
    long long n_half_edges = 0;
    long long n_boundary = 0;
    for (const int face : chart.faces) {
      const bool reversed = reversed_[face] != 0;
      chart.reversed_faces += reversed ? 1 : 0;
      for (int c = mesh_.face_offsets[face]; c < mesh_.face_offsets[face + 1]; ++c) {
        ++n_half_edges;
        if (half_edges_.twin(c) >= 0) continue;
        ++n_boundary;
        const int a = vertex_of_corner_[c];
        const int b = vertex_of_corner_[half_edges_.next(c)];
        next_vertex_[reversed ? b : a] = reversed ? a : b;
      }
      poll(mesh_.n_corners(face));
    }
    chart.boundary_loops = chain_loops(next_vertex_);
    const long long n_edges = (n_half_edges + n_boundary) / 2;
    chart.euler_characteristic = static_cast<int>(static_cast<long long>(chart.vertices.size()) - n_edges +
                                                  static_cast<long long>(chart.faces.size()));
    triangulate(n_half_edges, chart);
  }

 private:
  /// The triangles of some of a chart's faces.
  struct Triangles {
    std::vector<std::array<int, 3>> corners;
    std::vector<TriangleWeight> weights;
    std::vector<int> face;  ///< index in the chart
    int n_self_intersecting = 0;
    Positions positions;  ///< of a face
    PolygonTriangulation polygon;
  };

  void triangulate(long long n_half_edges, Chart& chart) const {
    const std::size_t n = chart.faces.size();
    const auto n_parts = static_cast<std::size_t>(std::clamp(n_half_edges / corners_of_part, 1LL, 1LL * max_shares));
    std::vector<Triangles> parts(n_parts);
    const auto triangulate_part = [&](int k) {
      const auto p = static_cast<std::size_t>(k);
      const std::size_t begin = p * n / n_parts;
      const std::size_t end = (p + 1) * n / n_parts;
      std::size_t max_triangles = 0;
      for (std::size_t i = begin; i < end; ++i) {
        // A quad may have both splits.
        const int size = mesh_.n_corners(chart.faces[i]);
        max_triangles += static_cast<std::size_t>(size == 4 ? 4 : size - 2);
      }
      parts[p].corners.reserve(max_triangles);
      parts[p].weights.reserve(max_triangles);
      parts[p].face.reserve(max_triangles);
      for (std::size_t i = begin; i < end; ++i) triangulate_face(chart.faces[i], static_cast<int>(i), parts[p]);
    };
    if (n_parts == 1) {
      triangulate_part(0);
      chart.triangles = std::move(parts.front().corners);
      chart.triangle_weights = std::move(parts.front().weights);
      chart.triangle_face = std::move(parts.front().face);
      chart.self_intersecting_polygons += parts.front().n_self_intersecting;
      return;
    }
    run_in_parallel(
        static_cast<int>(n_parts), [&](int k, const Progress&) { triangulate_part(k); }, {}, "charts");
    std::size_t n_triangles = 0;
    for (const Triangles& part : parts) n_triangles += part.corners.size();
    std::vector<std::array<int, 3>> triangles;
    std::vector<TriangleWeight> weights;
    triangles.reserve(n_triangles);
    weights.reserve(n_triangles);
    chart.triangle_face.reserve(n_triangles);
    for (Triangles& part : parts) {
      triangles.insert(triangles.end(), part.corners.begin(), part.corners.end());
      weights.insert(weights.end(), part.weights.begin(), part.weights.end());
      chart.triangle_face.insert(chart.triangle_face.end(), part.face.begin(), part.face.end());
      chart.self_intersecting_polygons += part.n_self_intersecting;
      poll(part.corners.size());
      part = {};
    }
    chart.triangles = std::move(triangles);
    chart.triangle_weights = std::move(weights);
  }

  void triangulate_face(int face, int index, Triangles& result) const {
    const bool reversed = reversed_[face] != 0;
    const int first = mesh_.face_offsets[face];
    const int size = mesh_.n_corners(face);
    const auto corner = [&](int i) { return reversed ? first + size - 1 - i : first + i; };
    poll(size);
    if (size == 3) {
      result.corners.push_back(
          {vertex_of_corner_[corner(0)], vertex_of_corner_[corner(1)], vertex_of_corner_[corner(2)]});
      result.weights.push_back(whole_triangle);
      result.face.push_back(index);
      return;
    }
    // Not resize: Eigen 3.4 frees the old memory twice if the allocation fails.
    if (result.positions.rows() != size) result.positions = Positions(size, 3);
    for (int i = 0; i < size; ++i) {
      const double* p = mesh_.position(mesh_.corner_vertices[corner(i)]);
      result.positions.row(i) << p[0], p[1], p[2];
    }
    triangulate_polygon(result.positions, result.polygon);
    if (!result.polygon.simple) ++result.n_self_intersecting;
    for (std::size_t t = 0; t < result.polygon.triangles.size(); ++t) {
      const auto& local = result.polygon.triangles[t];
      result.corners.push_back({vertex_of_corner_[corner(local[0])], vertex_of_corner_[corner(local[1])],
                                vertex_of_corner_[corner(local[2])]});
      result.weights.push_back(result.polygon.triangle_weights[t]);
      result.face.push_back(index);
    }
  }

  static constexpr long long corners_of_part = 5000;  ///< these and their triangles make shared_steps

  const PolygonMesh& mesh_;
  const HalfEdges& half_edges_;
  const std::vector<char>& reversed_;
  const std::vector<int>& vertex_of_corner_;
  std::vector<int> next_vertex_;
};

}  // namespace

Positions Chart::positions(const PolygonMesh& mesh) const {
  Positions result(n_vertices(), 3);
  for (int i = 0; i < n_vertices(); ++i) {
    const double* p = mesh.position(vertices[i]);
    result.row(i) << p[0], p[1], p[2];
  }
  return result;
}

ChartDecomposition build_charts(const PolygonMesh& mesh) {
  validate(mesh);
  ChartDecomposition result;
  const HalfEdges half_edges = HalfEdges::of(mesh);
  result.non_manifold_edges = half_edges.non_manifold_edges();
  for (int face = 0; face < mesh.n_faces; ++face) {
    if (half_edges.state(face) == FaceState::degenerate) result.degenerate_faces.push_back(face);
  }
  Components components = connect(mesh, half_edges);
  result.chart_of_face = std::move(components.chart_of_face);

  DisjointSets fans(half_edges.n_corners());
  for (int c = 0; c < half_edges.n_corners(); ++c) {
    const int other = half_edges.twin(c);
    if (other < c) continue;
    const bool opposed = half_edges.is_opposed(c);
    fans.unite(c, opposed ? half_edges.next(other) : other);
    fans.unite(half_edges.next(c), opposed ? other : half_edges.next(other));
    poll();
  }
  std::vector<int>& vertex_of_corner = result.chart_vertex_of_corner;  // first the root of its fan
  vertex_of_corner.assign(static_cast<std::size_t>(half_edges.n_corners()), -1);
  std::vector<int> fan_roots;  // ascending
  for (int face = 0; face < mesh.n_faces; ++face) {
    if (!half_edges.is_used(face)) continue;
    for (int c = mesh.face_offsets[face]; c < mesh.face_offsets[face + 1]; ++c) {
      vertex_of_corner[c] = fans.find(c);
      if (vertex_of_corner[c] == c) fan_roots.push_back(c);
    }
  }
  poll(half_edges.n_corners());

  // Number the fans chart by chart in the order of the mesh vertices: first sort their roots by vertex.
  const Grouped<int> roots(mesh.n_vertices, [&](const auto& visit) {
    for (const int root : fan_roots) visit(mesh.corner_vertices[root], root);
  });
  result.charts.resize(components.faces.size());
  for (std::size_t i = 0; i < result.charts.size(); ++i) {
    result.charts[i].faces = std::move(components.faces[i]);
    result.charts[i].orientable = components.orientable[i] != 0;
  }
  for (const int root : roots.values()) {
    Chart& chart = result.charts[result.chart_of_face[half_edges.face(root)]];
    const int vertex = mesh.corner_vertices[root];
    if (!chart.vertices.empty() && chart.vertices.back() == vertex) ++result.split_vertices;
    vertex_of_corner[root] = chart.n_vertices();
    chart.vertices.push_back(vertex);
  }
  poll(mesh.n_vertices);
  auto next_root = fan_roots.begin();
  for (int c = 0; c < half_edges.n_corners(); ++c) {
    if (next_root != fan_roots.end() && *next_root == c) {
      ++next_root;
    } else if (vertex_of_corner[c] >= 0) {
      vertex_of_corner[c] = vertex_of_corner[vertex_of_corner[c]];  // a root is the first corner of its fan
    }
  }
  poll(half_edges.n_corners());

  ChartBuilder builder(mesh, half_edges, components.reversed, result.chart_vertex_of_corner);
  for (Chart& chart : result.charts) builder.complete(chart);

  std::vector<std::pair<int, int>> corner_of_vertex;  // of the face that represents a duplicate
  for (int face = 0; face < mesh.n_faces; ++face) {
    if (half_edges.state(face) != FaceState::duplicate) continue;
    const int original = half_edges.original(face);
    Chart& chart = result.charts[result.chart_of_face[original]];
    result.chart_of_face[face] = result.chart_of_face[original];
    chart.duplicates.push_back(face);
    corner_of_vertex.clear();
    for (int d = mesh.face_offsets[original]; d < mesh.face_offsets[original + 1]; ++d) {
      corner_of_vertex.emplace_back(mesh.corner_vertices[d], d);
    }
    std::sort(corner_of_vertex.begin(), corner_of_vertex.end());
    for (int c = mesh.face_offsets[face]; c < mesh.face_offsets[face + 1]; ++c) {
      // The last corner of a vertex that the face has several times.
      const auto behind = std::upper_bound(corner_of_vertex.begin(), corner_of_vertex.end(),
                                           std::pair(mesh.corner_vertices[c], half_edges.n_corners()));
      result.chart_vertex_of_corner[c] = result.chart_vertex_of_corner[std::prev(behind)->second];
    }
  }
  return result;
}

}  // namespace spectral_conformal
