#include "seams/pieces.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "concurrency/work_counter.h"
#include "geometry/polygon_normal.h"
#include "graph/adjacency.h"
#include "mesh/edge_table.h"

namespace spectral_conformal {
namespace {

std::vector<std::array<int, 2>> sorted_seams(const PolygonMesh& mesh) {
  std::vector<std::array<int, 2>> seams;
  seams.reserve(static_cast<std::size_t>(mesh.n_seam_edges));
  for (int i = 0; i < mesh.n_seam_edges; ++i) {
    seams.push_back(edge_between(mesh.seam_edges[i][0], mesh.seam_edges[i][1]));
  }
  std::sort(seams.begin(), seams.end());
  return seams;
}

/// The edges that a chart's boundary passes twice: edges of four faces, two of which are connected around both ends.
/// With these two faces alone, such an edge would not be boundary.
std::vector<std::array<int, 2>> slit_edges(const Chart& chart) {
  const EdgeTable<int> passed(chart.n_vertices(), [&](const auto& visit) {
    for (const BoundaryLoop& loop : chart.boundary_loops) {
      for (std::size_t i = 0; i < loop.size(); ++i) visit(loop[i], loop[(i + 1) % loop.size()], 0);
    }
  });
  std::vector<std::array<int, 2>> result;
  passed.for_each_edge([&](const std::array<int, 2>& ends, const auto* first, const auto* last) {
    if (last - first > 1) result.push_back(ends);
  });
  return result;
}

/// Matches the corners of a piece's faces with those of their images. False if that does not map the piece onto its
/// image. corner_at: scratch, per vertex of the mesh, -1 before and after.
bool match_corners(const Piece& piece, const std::vector<Piece>& pieces, const std::vector<int>& face_in_piece,
                   const MirrorSymmetry& symmetry, std::vector<int>& corner_at, PieceMirror& mirror) {
  const Piece& image = pieces[mirror.image];
  if (image.faces.size() != piece.faces.size() || image.vertices.size() != piece.vertices.size()) return false;
  mirror.vertex.assign(piece.vertices.size(), -1);
  mirror.face.assign(piece.faces.size(), -1);
  for (int f = 0; f < piece.n_faces(); ++f) {
    const int other = face_in_piece[symmetry.face[piece.faces[f]]];
    mirror.face[f] = other;
    const int first = image.face_offsets[other];
    const int last = image.face_offsets[other + 1];
    count_steps(last - first);
    poll(last - first);
    for (int d = first; d < last; ++d) corner_at[image.vertices[image.corner_vertices[d]]] = image.corner_vertices[d];
    bool matched = true;
    for (int c = piece.face_offsets[f]; c < piece.face_offsets[f + 1] && matched; ++c) {
      const int v = piece.corner_vertices[c];
      const int wanted = symmetry.vertex[piece.vertices[v]];
      const int found = wanted < 0 ? -1 : corner_at[wanted];
      matched = found >= 0 && (mirror.vertex[v] < 0 || mirror.vertex[v] == found);
      mirror.vertex[v] = found;
    }
    for (int d = first; d < last; ++d) corner_at[image.vertices[image.corner_vertices[d]]] = -1;
    if (!matched) return false;
  }
  // A cut on only one side shows as duplicated vertices, or as a seam without an image.
  std::vector<int> images = mirror.vertex;
  std::sort(images.begin(), images.end());
  if (std::adjacent_find(images.begin(), images.end()) != images.end()) return false;
  return image.seams.size() == piece.seams.size() &&
         std::all_of(piece.seams.begin(), piece.seams.end(), [&](const auto& seam) {
           const auto wanted = edge_between(mirror.vertex[seam[0]], mirror.vertex[seam[1]]);
           return std::binary_search(image.seams.begin(), image.seams.end(), wanted);
         });
}

}  // namespace

Positions Piece::corners(int face) const {
  const int first = face_offsets[face];
  Positions result(face_offsets[face + 1] - first, 3);
  for (Eigen::Index i = 0; i < result.rows(); ++i) {
    result.row(i) = positions.row(corner_vertices[first + static_cast<int>(i)]);
  }
  return result;
}

double Piece::area() const {
  double area = 0;
  for (int face = 0; face < n_faces(); ++face) {
    const Positions around = corners(face);
    area += 0.5 * polygon_normal(around, around.row(0).transpose()).norm();
  }
  return area;
}

bool has_extent(const Piece& piece) {
  if (!piece.positions.allFinite()) return false;
  const double extent = (piece.positions.colwise().maxCoeff() - piece.positions.colwise().minCoeff()).maxCoeff();
  return extent > 0 && std::isfinite(extent);
}

std::vector<Piece> split_into_pieces(const PolygonMesh& mesh, const ChartDecomposition& decomposition) {
  const std::vector<std::array<int, 2>> seams = sorted_seams(mesh);
  std::vector<Piece> pieces;
  for (const Chart& chart : decomposition.charts) {
    Piece piece;
    piece.positions = chart.positions(mesh);
    piece.vertices = chart.vertices;
    piece.faces = chart.faces;
    for (const int face : chart.faces) {
      const int first = mesh.face_offsets[face];
      const int last = mesh.face_offsets[face + 1];
      poll(last - first);
      for (int c = first; c < last; ++c) {
        const int v = decomposition.chart_vertex_of_corner[c];
        const int next = decomposition.chart_vertex_of_corner[c + 1 == last ? first : c + 1];
        piece.corner_vertices.push_back(v);
        const auto edge = edge_between(piece.vertices[v], piece.vertices[next]);
        if (std::binary_search(seams.begin(), seams.end(), edge)) piece.seams.push_back(edge_between(v, next));
      }
      piece.end_face();
    }
    const std::vector<std::array<int, 2>> slits = slit_edges(chart);
    piece.seams.insert(piece.seams.end(), slits.begin(), slits.end());
    std::sort(piece.seams.begin(), piece.seams.end());
    piece.seams.erase(std::unique(piece.seams.begin(), piece.seams.end()), piece.seams.end());
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

std::vector<PieceMirror> mirror_pieces(const PolygonMesh& mesh, const ChartDecomposition& decomposition,
                                       const std::vector<Piece>& pieces, const MirrorSymmetry& symmetry) {
  std::vector<int> face_in_piece(static_cast<std::size_t>(mesh.n_faces), -1);
  for (const Piece& piece : pieces) {
    for (int f = 0; f < piece.n_faces(); ++f) face_in_piece[piece.faces[f]] = f;
  }
  std::vector<int> corner_at(static_cast<std::size_t>(mesh.n_vertices), -1);
  std::vector<PieceMirror> mirrors(pieces.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const Piece& piece = pieces[i];
    const auto image_of = [&](int face) {
      const int image = symmetry.face[face];
      return image < 0 || face_in_piece[image] < 0 ? -1 : decomposition.chart_of_face[image];
    };
    PieceMirror mirror;
    mirror.image = image_of(piece.faces.front());
    const bool onto_one = std::all_of(piece.faces.begin(), piece.faces.end(),
                                      [&](int face) { return image_of(face) == mirror.image && mirror.image >= 0; });
    if (onto_one && match_corners(piece, pieces, face_in_piece, symmetry, corner_at, mirror)) {
      mirrors[i] = std::move(mirror);
    }
  }
  return mirrors;
}

MirroredPieces MirroredPieces::of(const PolygonMesh& mesh) {
  MirroredPieces result;
  result.symmetry = find_mirror_symmetry(mesh);
  const ChartDecomposition decomposition = build_charts(mesh);
  result.pieces = split_into_pieces(mesh, decomposition);
  result.mirrors = mirror_pieces(mesh, decomposition, result.pieces, result.symmetry);
  return result;
}

}  // namespace spectral_conformal
