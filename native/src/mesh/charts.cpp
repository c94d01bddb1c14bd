#include "mesh/charts.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "geometry/polygon_triangulation.h"
#include "graph/disjoint_sets.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal {
namespace {

/// Half-edge c runs from corner c's vertex to the next corner's vertex of the same face.
class HalfEdges {
 public:
  explicit HalfEdges(const PolygonMesh& mesh) : mesh_(mesh) {
    const int n_corners = mesh.n_faces == 0 ? 0 : mesh.face_offsets[mesh.n_faces];
    face_of_corner_.assign(static_cast<std::size_t>(n_corners), -1);
    for (int face = 0; face < mesh.n_faces; ++face) {
      for (int c = mesh.face_offsets[face]; c < mesh.face_offsets[face + 1]; ++c) face_of_corner_[c] = face;
    }
  }
  int n_corners() const { return static_cast<int>(face_of_corner_.size()); }
  int face(int corner) const { return face_of_corner_[corner]; }
  int next(int corner) const {
    const int face = face_of_corner_[corner];
    return corner + 1 == mesh_.face_offsets[face + 1] ? mesh_.face_offsets[face] : corner + 1;
  }
  int from(int corner) const { return mesh_.corner_vertices[corner]; }
  int to(int corner) const { return mesh_.corner_vertices[next(corner)]; }

 private:
  const PolygonMesh& mesh_;
  std::vector<int> face_of_corner_;
};

enum FaceState : char { outside, inside, degenerate, duplicate };

/// Selected faces; those with fewer than three different vertices or with a vertex twice in a row are degenerate.
std::vector<char> face_states(const PolygonMesh& mesh) {
  std::vector<char> state(static_cast<std::size_t>(mesh.n_faces), outside);
  std::vector<int> sorted;
  for (int face = 0; face < mesh.n_faces; ++face) {
    if (mesh.selected_faces != nullptr && !mesh.selected_faces[face]) continue;
    const int first = mesh.face_offsets[face];
    const int size = mesh.face_offsets[face + 1] - first;
    const int* v = mesh.corner_vertices + first;
    bool valid = size >= 3;
    if (size == 3) {
      valid = v[0] != v[1] && v[1] != v[2] && v[2] != v[0];
    } else if (valid) {
      for (int i = 0; i < size && valid; ++i) valid = v[i] != v[(i + 1) % size];
      if (valid) {
        sorted.assign(v, v + size);
        std::sort(sorted.begin(), sorted.end());
        valid = std::unique(sorted.begin(), sorted.end()) - sorted.begin() >= 3;
      }
    }
    state[face] = valid ? inside : degenerate;
  }
  return state;
}

/// The half-edges (and seams, as ~index) of every edge, grouped by the edge's smaller vertex.
class EdgeTable {
 public:
  struct Entry {
    int larger;     ///< the edge's larger vertex
    int half_edge;  ///< corner, or -1 for a seam
    bool operator<(const Entry& other) const {
      return larger != other.larger ? larger < other.larger : half_edge < other.half_edge;
    }
  };

  EdgeTable(const PolygonMesh& mesh, const HalfEdges& half_edges, const std::vector<char>& state)
      : start_(static_cast<std::size_t>(mesh.n_vertices) + 1, 0) {
    const auto each = [&](auto&& visit) {
      for (int c = 0; c < half_edges.n_corners(); ++c) {
        if (state[half_edges.face(c)] != inside) continue;
        const int a = half_edges.from(c);
        const int b = half_edges.to(c);
        visit(std::min(a, b), Entry{std::max(a, b), c});
      }
      for (int i = 0; i < mesh.n_seam_edges; ++i) {
        const auto& seam = mesh.seam_edges[i];
        visit(std::min(seam[0], seam[1]), Entry{std::max(seam[0], seam[1]), -1});
      }
    };
    each([&](int smaller, const Entry&) { ++start_[smaller + 1]; });
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    entries_.resize(static_cast<std::size_t>(start_.back()));
    std::vector<int> fill(start_.begin(), start_.end() - 1);
    each([&](int smaller, const Entry& entry) { entries_[fill[smaller]++] = entry; });
    for (int v = 0; v < mesh.n_vertices; ++v) {
      std::sort(entries_.begin() + start_[v], entries_.begin() + start_[v + 1]);
    }
  }

  /// Calls visit(first, last) for the run of entries of each edge; a seam's entry comes first.
  template <class Visit>
  void for_each_edge(Visit&& visit) const {
    for (std::size_t v = 0; v + 1 < start_.size(); ++v) {
      const Entry* entry = entries_.data() + start_[v];
      const Entry* const end = entries_.data() + start_[v + 1];
      while (entry != end) {
        const Entry* last = entry;
        while (last != end && last->larger == entry->larger) ++last;
        visit(entry, last);
        entry = last;
      }
    }
  }

 private:
  std::vector<int> start_;
  std::vector<Entry> entries_;
};

/// Marks every face but the first of those with the same set of vertices. Only faces on an edge of three or more faces
/// or glued twice can be duplicates, so only the faces of `candidates` are compared.
void mark_duplicates(const PolygonMesh& mesh, std::vector<int> candidates, std::vector<char>& state,
                     std::vector<int>& kept_twin) {
  std::sort(candidates.begin(), candidates.end());
  candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
  std::vector<std::pair<std::vector<int>, int>> keys;
  keys.reserve(candidates.size());
  for (const int face : candidates) {
    std::vector<int> key(mesh.corner_vertices + mesh.face_offsets[face],
                         mesh.corner_vertices + mesh.face_offsets[face + 1]);
    std::sort(key.begin(), key.end());
    keys.emplace_back(std::move(key), face);
  }
  std::sort(keys.begin(), keys.end());
  kept_twin.assign(static_cast<std::size_t>(mesh.n_faces), -1);
  for (std::size_t i = 1; i < keys.size(); ++i) {
    if (keys[i].first != keys[i - 1].first) continue;
    const int twin = kept_twin[keys[i - 1].second];
    kept_twin[keys[i].second] = twin < 0 ? keys[i - 1].second : twin;
    state[keys[i].second] = duplicate;
  }
}

/// For each corner the half-edge glued to its half-edge, or -1.
std::vector<int> glue(const PolygonMesh& mesh, const HalfEdges& half_edges, std::vector<char>& state,
                      std::vector<int>& kept_twin, int& non_manifold_edges) {
  std::vector<int> mate;
  for (int pass = 0; pass < 2; ++pass) {
    mate.assign(static_cast<std::size_t>(half_edges.n_corners()), -1);
    non_manifold_edges = 0;
    std::vector<int> suspects;
    const EdgeTable table(mesh, half_edges, state);
    table.for_each_edge([&](const EdgeTable::Entry* first, const EdgeTable::Entry* last) {
      bool seam = false;
      while (first != last && first->half_edge < 0) {
        seam = true;
        ++first;
      }
      if (last - first > 2) {
        ++non_manifold_edges;
        for (auto entry = first; entry != last; ++entry) suspects.push_back(half_edges.face(entry->half_edge));
      } else if (last - first == 2) {
        const int a = first[0].half_edge;
        const int b = first[1].half_edge;
        const int face_a = half_edges.face(a);
        const int face_b = half_edges.face(b);
        if (face_a == face_b) return;
        // Two triangles on the same three vertices, alone: a pillow, whose halves are duplicates.
        if (mesh.face_offsets[face_a + 1] - mesh.face_offsets[face_a] == 3 &&
            mesh.face_offsets[face_b + 1] - mesh.face_offsets[face_b] == 3 &&
            half_edges.to(half_edges.next(a)) == half_edges.to(half_edges.next(b))) {
          suspects.push_back(face_a);
          suspects.push_back(face_b);
        }
        if (seam) return;
        mate[a] = b;
        mate[b] = a;
      }
    });
    if (pass == 1 || suspects.empty()) break;
    mark_duplicates(mesh, std::move(suspects), state, kept_twin);
    if (std::find(state.begin(), state.end(), duplicate) == state.end()) break;
  }
  return mate;
}

struct Components {
  std::vector<int> chart_of_face;
  std::vector<char> reversed;    ///< per face: wound against its chart's majority
  std::vector<char> orientable;  ///< per chart
  std::vector<std::vector<int>> faces;
};

/// Connected components over glued edges, with a consistent orientation where there is one.
Components connect(const PolygonMesh& mesh, const HalfEdges& half_edges, const std::vector<char>& state,
                   const std::vector<int>& mate) {
  Components result;
  result.chart_of_face.assign(static_cast<std::size_t>(mesh.n_faces), -1);
  result.reversed.assign(static_cast<std::size_t>(mesh.n_faces), 0);
  std::vector<int> queue;
  for (int seed = 0; seed < mesh.n_faces; ++seed) {
    if (state[seed] != inside || result.chart_of_face[seed] >= 0) continue;
    const int chart = static_cast<int>(result.faces.size());
    bool orientable = true;
    queue.assign(1, seed);
    result.chart_of_face[seed] = chart;
    for (std::size_t head = 0; head < queue.size(); ++head) {
      const int face = queue[head];
      for (int c = mesh.face_offsets[face]; c < mesh.face_offsets[face + 1]; ++c) {
        if (mate[c] < 0) continue;
        const int other = half_edges.face(mate[c]);
        const bool opposed = half_edges.from(c) == half_edges.to(mate[c]);
        const char reversed = opposed ? result.reversed[face] : static_cast<char>(1 - result.reversed[face]);
        if (result.chart_of_face[other] < 0) {
          result.chart_of_face[other] = chart;
          result.reversed[other] = reversed;
          queue.push_back(other);
        } else if (result.reversed[other] != reversed) {
          orientable = false;
        }
      }
    }
    const auto against = std::count_if(queue.begin(), queue.end(), [&](int face) { return result.reversed[face]; });
    if (2 * against > static_cast<std::ptrdiff_t>(queue.size())) {
      for (const int face : queue) result.reversed[face] = static_cast<char>(1 - result.reversed[face]);
    }
    result.faces.emplace_back();
    result.faces.back().reserve(queue.size());
    result.orientable.push_back(orientable ? 1 : 0);
  }
  for (int face = 0; face < mesh.n_faces; ++face) {
    if (result.chart_of_face[face] >= 0) result.faces[result.chart_of_face[face]].push_back(face);
  }
  return result;
}

/// Chains the boundary half-edges, each of which starts at a vertex of its own. `next_vertex` maps a chart vertex to
/// the next one along the boundary, or -1.
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
  ChartBuilder(const PolygonMesh& mesh, const HalfEdges& half_edges, const std::vector<int>& mate,
               const std::vector<char>& reversed, const std::vector<int>& vertex_of_corner)
      : mesh_(mesh), half_edges_(half_edges), mate_(mate), reversed_(reversed), vertex_of_corner_(vertex_of_corner) {}

  /// Fills in triangles, loops and the Euler characteristic of a chart that has its faces and vertices.
  void complete(Chart& chart) {
    chart.triangles.reserve(2 * chart.faces.size());
    next_vertex_.assign(chart.vertices.size(), -1);
    long long n_half_edges = 0;
    long long n_boundary = 0;
    for (std::size_t i = 0; i < chart.faces.size(); ++i) {
      const int face = chart.faces[i];
      const bool reversed = reversed_[face] != 0;
      chart.reversed_faces += reversed ? 1 : 0;
      for (int c = mesh_.face_offsets[face]; c < mesh_.face_offsets[face + 1]; ++c) {
        ++n_half_edges;
        if (mate_[c] >= 0) continue;
        ++n_boundary;
        const int a = vertex_of_corner_[c];
        const int b = vertex_of_corner_[half_edges_.next(c)];
        next_vertex_[reversed ? b : a] = reversed ? a : b;
      }
      triangulate(face, static_cast<int>(i), reversed, chart);
    }
    chart.boundary_loops = chain_loops(next_vertex_);
    const long long n_edges = (n_half_edges + n_boundary) / 2;
    chart.euler_characteristic = static_cast<int>(static_cast<long long>(chart.vertices.size()) - n_edges +
                                                  static_cast<long long>(chart.faces.size()));
  }

 private:
  void triangulate(int face, int index, bool reversed, Chart& chart) {
    const int first = mesh_.face_offsets[face];
    const int size = mesh_.face_offsets[face + 1] - first;
    const auto corner = [&](int i) { return reversed ? first + size - 1 - i : first + i; };
    if (size == 3) {
      chart.triangles.push_back(
          {vertex_of_corner_[corner(0)], vertex_of_corner_[corner(1)], vertex_of_corner_[corner(2)]});
      chart.coverage.push_back(1.0);
      chart.triangle_face.push_back(index);
      return;
    }
    // Not resize: Eigen 3.4 frees the old memory twice where there is no new one.
    if (corners_.rows() != size) corners_ = Positions(size, 3);
    for (int i = 0; i < size; ++i) {
      const double* p = mesh_.positions + 3 * static_cast<std::size_t>(mesh_.corner_vertices[corner(i)]);
      corners_.row(i) << p[0], p[1], p[2];
    }
    triangulate_polygon(corners_, polygon_);
    if (!polygon_.simple) ++chart.self_intersecting_polygons;
    for (std::size_t t = 0; t < polygon_.triangles.size(); ++t) {
      const auto& local = polygon_.triangles[t];
      chart.triangles.push_back({vertex_of_corner_[corner(local[0])], vertex_of_corner_[corner(local[1])],
                                 vertex_of_corner_[corner(local[2])]});
      chart.coverage.push_back(polygon_.coverage[t]);
      chart.triangle_face.push_back(index);
    }
  }

  const PolygonMesh& mesh_;
  const HalfEdges& half_edges_;
  const std::vector<int>& mate_;
  const std::vector<char>& reversed_;
  const std::vector<int>& vertex_of_corner_;
  std::vector<int> next_vertex_;
  Positions corners_;
  PolygonTriangulation polygon_;
};

}  // namespace

void validate(const PolygonMesh& mesh) {
  const auto check_size = [](int n, const char* what) {
    if (n <= size_limit) return;
    throw InvalidMesh("The mesh has " + std::to_string(n) + " " + what + "; at most " + std::to_string(size_limit) +
                      " can be numbered. Split it into several meshes.");
  };
  check_size(mesh.n_vertices, "vertices");
  check_size(mesh.n_faces, "faces");
  check_size(mesh.n_faces > 0 ? mesh.face_offsets[mesh.n_faces] : 0, "face corners");
  check_size(mesh.n_seam_edges, "seam edges");
  for (int face = 0; face < mesh.n_faces; ++face) {
    if (mesh.face_offsets[face + 1] < mesh.face_offsets[face]) {
      throw InvalidMesh("face_offsets must not decrease, but they do after face " + std::to_string(face) + ".");
    }
  }
  if (mesh.n_faces > 0 && mesh.face_offsets[0] != 0) throw InvalidMesh("face_offsets must start with 0.");
  const int n_corners = mesh.n_faces == 0 ? 0 : mesh.face_offsets[mesh.n_faces];
  for (int c = 0; c < n_corners; ++c) {
    const int vertex = mesh.corner_vertices[c];
    if (vertex < 0 || vertex >= mesh.n_vertices) {
      throw InvalidMesh("Corner " + std::to_string(c) + " refers to vertex " + std::to_string(vertex) +
                        ", but there are " + std::to_string(mesh.n_vertices) + " vertices.");
    }
  }
  for (int i = 0; i < mesh.n_seam_edges; ++i) {
    for (const int vertex : mesh.seam_edges[i]) {
      if (vertex < 0 || vertex >= mesh.n_vertices) {
        throw InvalidMesh("Seam edge " + std::to_string(i) + " refers to vertex " + std::to_string(vertex) +
                          ", but there are " + std::to_string(mesh.n_vertices) + " vertices.");
      }
    }
  }
}

Positions Chart::positions(const PolygonMesh& mesh) const {
  Positions result(n_vertices(), 3);
  for (int i = 0; i < n_vertices(); ++i) {
    const double* p = mesh.positions + 3 * static_cast<std::size_t>(vertices[i]);
    result.row(i) << p[0], p[1], p[2];
  }
  return result;
}

ChartDecomposition build_charts(const PolygonMesh& mesh) {
  validate(mesh);
  ChartDecomposition result;
  const HalfEdges half_edges(mesh);
  std::vector<char> state = face_states(mesh);
  for (int face = 0; face < mesh.n_faces; ++face) {
    if (state[face] == degenerate) result.degenerate_faces.push_back(face);
  }
  std::vector<int> kept_twin;
  const std::vector<int> mate = glue(mesh, half_edges, state, kept_twin, result.non_manifold_edges);
  Components components = connect(mesh, half_edges, state, mate);
  result.chart_of_face = std::move(components.chart_of_face);

  DisjointSets fans(half_edges.n_corners());
  for (int c = 0; c < half_edges.n_corners(); ++c) {
    if (mate[c] < c) continue;
    const int other = mate[c];
    const bool opposed = half_edges.from(c) == half_edges.to(other);
    fans.unite(c, opposed ? half_edges.next(other) : other);
    fans.unite(half_edges.next(c), opposed ? other : half_edges.next(other));
  }

  // Number the fans chart by chart in the order of the mesh's vertices: first sort the fans' roots by vertex.
  std::vector<int> roots_start(static_cast<std::size_t>(mesh.n_vertices) + 1, 0);
  const auto is_root = [&](int c) { return state[half_edges.face(c)] == inside && fans.find(c) == c; };
  for (int c = 0; c < half_edges.n_corners(); ++c) {
    if (is_root(c)) ++roots_start[mesh.corner_vertices[c] + 1];
  }
  std::partial_sum(roots_start.begin(), roots_start.end(), roots_start.begin());
  std::vector<int> roots(static_cast<std::size_t>(roots_start.back()));
  {
    std::vector<int> fill(roots_start.begin(), roots_start.end() - 1);
    for (int c = 0; c < half_edges.n_corners(); ++c) {
      if (is_root(c)) roots[fill[mesh.corner_vertices[c]]++] = c;
    }
  }
  result.charts.resize(components.faces.size());
  for (std::size_t i = 0; i < result.charts.size(); ++i) {
    result.charts[i].faces = std::move(components.faces[i]);
    result.charts[i].orientable = components.orientable[i] != 0;
  }
  result.chart_vertex_of_corner.assign(static_cast<std::size_t>(half_edges.n_corners()), -1);
  for (const int root : roots) {
    Chart& chart = result.charts[result.chart_of_face[half_edges.face(root)]];
    const int vertex = mesh.corner_vertices[root];
    if (!chart.vertices.empty() && chart.vertices.back() == vertex) ++result.split_vertices;
    result.chart_vertex_of_corner[root] = chart.n_vertices();
    chart.vertices.push_back(vertex);
  }
  for (int c = 0; c < half_edges.n_corners(); ++c) {
    if (state[half_edges.face(c)] == inside) {
      result.chart_vertex_of_corner[c] = result.chart_vertex_of_corner[fans.find(c)];
    }
  }

  ChartBuilder builder(mesh, half_edges, mate, components.reversed, result.chart_vertex_of_corner);
  for (Chart& chart : result.charts) builder.complete(chart);

  for (int face = 0; face < mesh.n_faces; ++face) {
    if (state[face] != duplicate) continue;
    const int twin = kept_twin[face];
    Chart& chart = result.charts[result.chart_of_face[twin]];
    result.chart_of_face[face] = result.chart_of_face[twin];
    chart.duplicates.push_back(face);
    for (int c = mesh.face_offsets[face]; c < mesh.face_offsets[face + 1]; ++c) {
      for (int d = mesh.face_offsets[twin]; d < mesh.face_offsets[twin + 1]; ++d) {
        if (mesh.corner_vertices[c] == mesh.corner_vertices[d]) {
          result.chart_vertex_of_corner[c] = result.chart_vertex_of_corner[d];
        }
      }
    }
  }
  return result;
}

}  // namespace spectral_conformal
