#include "seams/cut_surface.h"

#include <cstddef>

#include "concurrency/listening.h"
#include "concurrency/work_counter.h"
#include "graph/disjoint_sets.h"

namespace spectral_conformal {

int handle_curves(const Chart& chart) {
  // The loops of a non-orientable chart are not chained reliably.
  const int loops = chart.orientable ? static_cast<int>(chart.boundary_loops.size()) : 0;
  return 2 - loops - chart.euler_characteristic;
}

CutSurface::CutSurface(const PolygonMesh& mesh, const SeamGraph& graph, const Chart& chart)
    : mesh_(mesh),
      half_edges_(mesh),
      twin_(static_cast<std::size_t>(half_edges_.n_corners()), -1),
      halves_(graph.edges().size(), {-1, -1}),
      side_of_face_(static_cast<std::size_t>(mesh.n_faces), -1),
      euler_characteristic_(chart.euler_characteristic),
      loops_(0),
      orientable_(chart.orientable) {
  for (int c = 0; c < half_edges_.n_corners(); ++c) {
    still_working(100);
    twin_[c] = half_edges_.twin(c);
    if (c < twin_[c]) halves_[graph.find_edge(half_edges_.from(c), half_edges_.to(c))] = {c, twin_[c]};
  }
  loops_ = count_loops();
}

int CutSurface::previous(int corner) const {
  const int face = half_edges_.face(corner);
  return corner == mesh_.face_offsets[face] ? mesh_.face_offsets[face + 1] - 1 : corner - 1;
}

CutSurface::Spoke CutSurface::turned(const Spoke& spoke) const {
  return {spoke.corner, spoke.half_edge == spoke.corner ? previous(spoke.corner) : spoke.corner};
}

CutSurface::Spoke CutSurface::fan_end(Spoke spoke) const {
  while (twin_[spoke.half_edge] >= 0) {
    const int across = twin_[spoke.half_edge];
    // Adjacent faces may have opposite windings, so the twin may start at this vertex, too.
    const bool starts_here = half_edges_.from(across) == half_edges_.from(spoke.corner);
    spoke = turned({starts_here ? across : half_edges_.next(across), across});
  }
  return spoke;
}

CutSurface::Spoke CutSurface::next_on_boundary(const Spoke& spoke) const {
  const int other = spoke.corner == spoke.half_edge ? half_edges_.next(spoke.half_edge) : spoke.half_edge;
  return fan_end(turned({other, spoke.half_edge}));
}

int CutSurface::count_loops() const {
  std::vector<char> walked(twin_.size(), 0);
  int loops = 0;
  for (int h = 0; h < static_cast<int>(twin_.size()); ++h) {
    if (!half_edges_.is_used(half_edges_.face(h)) || twin_[h] >= 0 || walked[h] != 0) continue;
    ++loops;
    for (Spoke spoke{h, h}; walked[spoke.half_edge] == 0; spoke = next_on_boundary(spoke)) walked[spoke.half_edge] = 1;
  }
  return loops;
}

/// Separates the two sides of an edge. If both ends are inside, the edge becomes a new loop; if one is on the boundary,
/// a slit. If both are, two loops become one, or one becomes two; on a non-orientable surface, one may also remain one,
/// partly reversed. Walks along the boundary on both sides of the edge at once until one walk tells which: the cost is
/// that of the shorter loop.
void CutSurface::cut(int edge) {
  const auto [half, twin] = halves_[edge];
  twin_[half] = twin_[twin] = -1;
  const Spoke from{half, half};
  const Spoke to{half_edges_.next(half), half};
  const auto was_inside = [&, twin = twin](const Spoke& end) { return fan_end(turned(end)).half_edge == twin; };
  const int inside = (was_inside(from) ? 1 : 0) + (was_inside(to) ? 1 : 0);
  euler_characteristic_ += 1 - inside;
  if (inside == 2) ++loops_;
  if (inside > 0) return;
  const int start = half_edges_.from(from.corner);
  const int end = half_edges_.from(to.corner);
  Spoke one = next_on_boundary(from);
  Spoke other = next_on_boundary({half_edges_.from(twin) == end ? twin : half_edges_.next(twin), twin});
  const auto is_back = [&, half = half, twin = twin](const Spoke& spoke) {
    return spoke.half_edge == half || spoke.half_edge == twin;
  };
  double n_steps = 2;
  for (; !is_back(one) && !is_back(other); n_steps += 2) {
    one = next_on_boundary(one);
    other = next_on_boundary(other);
  }
  count_steps(n_steps);
  still_working(30 * n_steps);
  if (one.half_edge == half || other.half_edge == twin) {
    ++loops_;
  } else if (is_back(one) ? half_edges_.from(one.corner) == end : half_edges_.from(other.corner) == start) {
    --loops_;
  }
}

bool CutSurface::try_cut(const std::vector<int>& edges, bool may_join) {
  const int before = handle_curves();
  const int euler_characteristic = euler_characteristic_;
  const int loops = loops_;
  std::vector<int> parted;
  for (const int edge : edges) {
    if (halves_[edge][1] < 0 || twin_[halves_[edge][0]] < 0) continue;
    cut(edge);
    parted.push_back(edge);
  }
  const int most = may_join && loops_ < loops ? before : before - 1;
  // First the count of an orientable surface, the lowest: most candidates fail here, before any search.
  if (handle_curves(true, loops_) <= most && is_connected_across(parted)) {
    const bool orientable = orientable_ || is_orientable();
    if (handle_curves(orientable, loops_) <= most) {
      orientable_ = orientable;
      return true;
    }
  }
  for (const int edge : parted) {
    const auto& [half, twin] = halves_[edge];
    twin_[half] = twin;
    twin_[twin] = half;
  }
  euler_characteristic_ = euler_characteristic;
  loops_ = loops;
  return false;
}

/// Searches breadth first from both sides of all edges at once, until the searches meet or one runs out of faces: the
/// cost is that of the smaller side, or of the way around.
bool CutSurface::is_connected_across(const std::vector<int>& edges) {
  std::vector<int> queue;
  for (const int edge : edges) {
    for (const int half : halves_[edge]) {
      if (half < 0 || side_of_face_[half_edges_.face(half)] >= 0) continue;
      side_of_face_[half_edges_.face(half)] = static_cast<int>(queue.size());
      queue.push_back(half_edges_.face(half));
    }
  }
  int n_sides = static_cast<int>(queue.size());
  DisjointSets sides(n_sides);
  std::vector<int> waiting(queue.size(), 1);  // per side, by its root: faces in the queue
  bool closed = false;
  for (std::size_t head = 0; head < queue.size() && n_sides > 1 && !closed; ++head) {
    const int face = queue[head];
    for (int c = mesh_.face_offsets[face]; c < mesh_.face_offsets[face + 1]; ++c) {
      if (twin_[c] < 0) continue;
      const int other = half_edges_.face(twin_[c]);
      const int side = sides.find(side_of_face_[face]);
      if (side_of_face_[other] < 0) {
        side_of_face_[other] = side;
        ++waiting[side];
        queue.push_back(other);
        continue;
      }
      const int other_side = sides.find(side_of_face_[other]);
      if (!sides.unite(side, other_side)) continue;
      waiting[sides.find(side)] = waiting[side] + waiting[other_side];
      --n_sides;
    }
    closed = --waiting[sides.find(side_of_face_[face])] == 0 && n_sides > 1;
  }
  count_steps(static_cast<double>(queue.size()));
  still_working(100.0 * static_cast<double>(queue.size()));
  for (const int face : queue) side_of_face_[face] = -1;
  return n_sides <= 1;
}

/// Winds the faces consistently, from one to the next, until two disagree. Precondition: the surface is connected.
bool CutSurface::is_orientable() const {
  std::vector<signed char> winding(static_cast<std::size_t>(mesh_.n_faces), 0);
  std::vector<int> queue;
  for (int face = 0; face < mesh_.n_faces && queue.empty(); ++face) {
    if (half_edges_.is_used(face)) queue.push_back(face);
  }
  for (const int seed : queue) winding[seed] = 1;
  for (std::size_t head = 0; head < queue.size(); ++head) {
    const int face = queue[head];
    still_working(50);
    for (int c = mesh_.face_offsets[face]; c < mesh_.face_offsets[face + 1]; ++c) {
      if (twin_[c] < 0) continue;
      const int other = half_edges_.face(twin_[c]);
      const bool opposed = half_edges_.from(c) != half_edges_.from(twin_[c]);
      const auto expected = static_cast<signed char>(opposed ? winding[face] : -winding[face]);
      if (winding[other] == 0) {
        winding[other] = expected;
        queue.push_back(other);
      } else if (winding[other] != expected) {
        return false;
      }
    }
  }
  return true;
}

}  // namespace spectral_conformal
