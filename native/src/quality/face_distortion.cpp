#include "spectral_conformal/face_distortion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "geometry/binary_unit.h"
#include "geometry/polygon_triangulation.h"
#include "geometry/quad_splits.h"
#include "geometry/signed_area.h"
#include "geometry/triangle_shape.h"
#include "graph/parallel_calls.h"

namespace spectral_conformal {
namespace {

/// Faces that a thread takes at once.
constexpr int block_size = 8192;
constexpr unsigned max_measuring_threads = 16;

/// One face after the other, in units in which squares neither overflow nor vanish.
class FaceMeasure {
 public:
  FaceMeasure(const PolygonMesh& mesh, const double* corner_uv, BinaryUnit unit, BinaryUnit image_unit)
      : mesh_(mesh), corner_uv_(corner_uv), unit_(unit), image_unit_(image_unit) {}

  void measure(int face, FaceDistortion& result) {
    const int n = mesh_.n_corners(face);
    if (n < 3 || !mesh_.is_selected(face)) return;
    if (!read(face, n)) {
      result.qc[face] = result.log2_scale[face] = std::numeric_limits<double>::quiet_NaN();
      return;
    }
    triangulate_polygon(corners_, polygon_);
    const bool second = has_both_splits() && second_split_is_better({image(0), image(1), image(2), image(3)});
    const std::size_t first = second ? 2 : 0;
    const std::size_t count = has_both_splits() ? 2 : polygon_.triangles.size();
    double area = 0;
    double image_area = 0;
    double qc = 0;
    for (std::size_t t = first; t < first + count; ++t) {
      const auto& [a, b, c] = polygon_.triangles[t];
      const TriangleShape shape = local_isometric_frame(corners_.row(a), corners_.row(b), corners_.row(c));
      if (shape.clamped) continue;
      area += shape.area();
      image_area += image(t);
      qc += shape.area() * shape.quasi_conformal_distortion(z_[b] - z_[a], z_[c] - z_[a]);
    }
    if (!(area > 0)) return;
    result.qc[face] = qc / area;
    result.log2_scale[face] = 0.5 * std::log2(std::abs(image_area) / area) + image_unit_.exponent() - unit_.exponent();
    result.area[face] = unit_.area_of(area);
    result.image_area[face] = image_unit_.area_of(is_mirrored_ ? -image_area : image_area);
  }

 private:
  /// The face in 3D, and its image, mirrored if it is wound clockwise; false where a coordinate is not finite.
  bool read(int face, int n) {
    if (corners_.rows() != n) {
      corners_ = Positions(n, 3);
      z_ = ComplexVector(n);
    }
    for (int i = 0; i < n; ++i) {
      const auto corner = static_cast<std::size_t>(mesh_.face_offsets[face]) + static_cast<std::size_t>(i);
      const double* p = mesh_.positions + 3 * static_cast<std::size_t>(mesh_.corner_vertices[corner]);
      corners_.row(i) << unit_.scaled(p[0]), unit_.scaled(p[1]), unit_.scaled(p[2]);
      z_[i] = Complex(image_unit_.scaled(corner_uv_[2 * corner]), image_unit_.scaled(corner_uv_[2 * corner + 1]));
    }
    if (!corners_.allFinite() || !z_.allFinite()) return false;
    double image_area = 0;
    for (int i = 1; i + 1 < n; ++i) image_area += signed_area(z_[0], z_[i], z_[i + 1]);
    is_mirrored_ = image_area < 0;
    if (is_mirrored_) z_ = z_.conjugate().eval();
    return true;
  }
  bool has_both_splits() const { return begins_quad(polygon_.triangle_weights.front()); }
  double image(std::size_t t) const {
    const auto& [a, b, c] = polygon_.triangles[t];
    return signed_area(z_[a], z_[b], z_[c]);
  }

  const PolygonMesh& mesh_;
  const double* corner_uv_;
  BinaryUnit unit_;
  BinaryUnit image_unit_;
  Positions corners_;
  ComplexVector z_;
  bool is_mirrored_ = false;
  PolygonTriangulation polygon_;
};

int n_blocks(int n) { return (n + block_size - 1) / block_size; }

/// The units of a mesh and of its map. The largest of the blocks' lengths is the same whoever finds them.
std::pair<BinaryUnit, BinaryUnit> units_of(const PolygonMesh& mesh, const double* corner_uv) {
  std::vector<std::pair<BinaryUnit, BinaryUnit>> units(static_cast<std::size_t>(n_blocks(mesh.n_corners())));
  run_in_parallel(
      static_cast<int>(units.size()), max_measuring_threads,
      [&](int block, const Progress&) {
        BinaryUnit unit;
        BinaryUnit image_unit;
        const int end = std::min(mesh.n_corners(), (block + 1) * block_size);
        for (int c = block * block_size; c < end; ++c) {
          const double* p = mesh.positions + 3 * static_cast<std::size_t>(mesh.corner_vertices[c]);
          for (int k = 0; k < 3; ++k) unit.include(p[k]);
          for (int k = 0; k < 2; ++k) image_unit.include(corner_uv[2 * static_cast<std::size_t>(c) + k]);
        }
        units[static_cast<std::size_t>(block)] = {unit, image_unit};
      },
      {}, "distortion");
  std::pair<BinaryUnit, BinaryUnit> all;
  for (const auto& [unit, image_unit] : units) {
    all.first.include(unit);
    all.second.include(image_unit);
  }
  return all;
}

}  // namespace

FaceDistortion measure_face_distortion(const PolygonMesh& mesh, const double* corner_uv) {
  validate(mesh);
  const std::pair<BinaryUnit, BinaryUnit> units = units_of(mesh, corner_uv);
  FaceDistortion result;
  result.qc = Eigen::VectorXd::Ones(mesh.n_faces);
  result.log2_scale = result.area = result.image_area = Eigen::VectorXd::Zero(mesh.n_faces);
  run_in_parallel(
      n_blocks(mesh.n_faces), max_measuring_threads,
      [&](int block, const Progress&) {
        FaceMeasure measure(mesh, corner_uv, units.first, units.second);
        const int end = std::min(mesh.n_faces, (block + 1) * block_size);
        for (int face = block * block_size; face < end; ++face) measure.measure(face, result);
      },
      {}, "distortion");
  return result;
}

}  // namespace spectral_conformal
