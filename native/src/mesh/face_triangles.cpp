#include "spectral_conformal/face_triangles.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>

#include "concurrency/parallel_calls.h"
#include "geometry/polygon_triangulation.h"
#include "geometry/quad_splits.h"

namespace spectral_conformal {
namespace {

class FaceSplitter {
 public:
  explicit FaceSplitter(const PolygonMesh& mesh) : mesh_(mesh) {}

  /// Writes the triangles of a face, two fewer than its corners.
  void split(int face, std::array<int, 3>* triangles) {
    const int first = mesh_.face_offsets[face];
    const int n = mesh_.n_corners(face);
    if (n == 3) {
      *triangles = {first, first + 1, first + 2};
      return;
    }
    if (n == 4) {
      const std::size_t split = first_diagonal_is_outside(first) ? 2 : 0;
      for (std::size_t t = split; t < split + 2; ++t) *triangles++ = shifted(quad_splits[t], first);
      return;
    }
    if (corners_.rows() != n) corners_ = Positions(n, 3);
    for (int i = 0; i < n; ++i) corners_.row(i) = point(first + i).transpose();
    triangulate_polygon(corners_, polygon_);
    for (const auto& triangle : polygon_.triangles) *triangles++ = shifted(triangle, first);
  }

 private:
  static std::array<int, 3> shifted(const std::array<int, 3>& triangle, int first) {
    return {first + triangle[0], first + triangle[1], first + triangle[2]};
  }
  Eigen::Map<const Eigen::Vector3d> point(int corner) const {
    return Eigen::Map<const Eigen::Vector3d>(mesh_.position(mesh_.corner_vertices[corner]));
  }
  /// Whether the other two corners lie on the same side of the first diagonal.
  bool first_diagonal_is_outside(int first) const {
    const Eigen::Vector3d diagonal = point(first + 2) - point(first);
    const Eigen::Vector3d one = (point(first + 1) - point(first)).cross(diagonal);
    const Eigen::Vector3d two = (point(first + 3) - point(first)).cross(diagonal);
    return one.dot(two) > 0;
  }

  const PolygonMesh& mesh_;
  Positions corners_;
  PolygonTriangulation polygon_;
};

}  // namespace

FaceTriangles triangulate_faces(const PolygonMesh& mesh) {
  validate(mesh);
  std::vector<int> first_triangle{0};
  first_triangle.reserve(static_cast<std::size_t>(mesh.n_faces) + 1);
  for (int face = 0; face < mesh.n_faces; ++face) {
    first_triangle.push_back(first_triangle.back() +
                             (mesh.is_selected(face) ? std::max(mesh.n_corners(face) - 2, 0) : 0));
  }
  FaceTriangles result;
  result.corners.resize(static_cast<std::size_t>(first_triangle.back()));
  result.face.resize(result.corners.size());
  run_blocks_in_parallel(mesh.n_faces, [&](int begin, int end) {
    FaceSplitter splitter(mesh);
    for (int face = begin; face < end; ++face) {
      const int first = first_triangle[face];
      const int last = first_triangle[face + 1];
      if (first == last) continue;
      splitter.split(face, result.corners.data() + first);
      std::fill(result.face.begin() + first, result.face.begin() + last, face);
    }
  });
  return result;
}

}  // namespace spectral_conformal
