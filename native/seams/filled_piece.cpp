#include "seams/filled_piece.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>
#include <vector>

#include "mesh/boundary_loops.h"
#include "seams/seam_functional.h"

namespace spectral_conformal {
namespace {

struct SmallLoop {
  BoundaryLoop hole;  ///< with the hole on its left
  int face = -1;      ///< that fills it
};

/// By their sorted vertices.
using SmallLoops = std::map<std::vector<int>, SmallLoop>;

SmallLoops small_loops(const Piece& piece) {
  const PolygonMesh mesh = piece.view({});
  // A seam around the hole costs less than an island: 35 edges, 11 faces across, in a million triangles; in pieces of
  // 10,000, only holes of single faces.
  const double longest = island_price * std::sqrt(piece.area());
  SmallLoops result;
  for (const Chart& chart : build_charts(mesh).charts) {
    for (const BoundaryLoop& loop : chart.boundary_loops) {
      BoundaryLoop hole;
      for (auto v = loop.rbegin(); v != loop.rend(); ++v) hole.push_back(chart.vertices[*v]);
      std::vector<int> key = hole;
      std::sort(key.begin(), key.end());
      const bool is_simple = hole.size() > 2 && std::adjacent_find(key.begin(), key.end()) == key.end();
      if (is_simple && loop_length(hole, piece.positions) <= longest) result[std::move(key)].hole = std::move(hole);
    }
  }
  return result;
}

}  // namespace

std::optional<FilledPiece> fill_small_holes(const Piece& piece, int index, const PieceMirror& mirror) {
  SmallLoops loops = small_loops(piece);
  const bool is_own_image = mirror.image == index;
  const auto image_of = [&](const std::vector<int>& vertices) {
    std::vector<int> key;
    key.reserve(vertices.size());
    for (const int v : vertices) key.push_back(mirror.vertex[v]);
    std::sort(key.begin(), key.end());
    return loops.find(key);
  };
  if (is_own_image) {
    // Rounding may put a loop and its image on different sides of the limit.
    for (auto loop = loops.begin(); loop != loops.end();) {
      loop = image_of(loop->first) == loops.end() ? loops.erase(loop) : std::next(loop);
    }
  }
  if (loops.empty()) return std::nullopt;
  FilledPiece result{piece, mirror};
  int next = piece.n_faces();
  for (auto& loop : loops) loop.second.face = next++;
  for (const auto& [vertices, loop] : loops) {
    if (is_own_image) result.mirror.face.push_back(image_of(vertices)->second.face);
    const BoundaryLoop& hole = loop.hole;
    result.piece.corner_vertices.insert(result.piece.corner_vertices.end(), hole.begin(), hole.end());
    result.piece.end_face();
    result.piece.faces.push_back(-1);
  }
  return result;
}

}  // namespace spectral_conformal
