#include "spectral_conformal/face_distortion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "concurrency/parallel_calls.h"
#include "geometry/binary_unit.h"
#include "geometry/polygon_triangulation.h"
#include "geometry/quad_splits.h"
#include "geometry/signed_area.h"
#include "geometry/triangle_shape.h"

namespace spectral_conformal {
namespace {

/// Sums over the triangles of a face.
struct FaceSums {
  double area = 0;
  double image_area = 0;
  double qc = 0;

  /// Adds a triangle, given its corners in 3D and in the map; one without area in 3D does not count.
  void add(const std::array<Eigen::Vector3d, 3>& p, const std::array<Complex, 3>& z) {
    const TriangleShape shape = local_isometric_frame(p[0], p[1], p[2]);
    if (shape.clamped) return;
    area += shape.area();
    image_area += signed_area(z[0], z[1], z[2]);
    qc += shape.area() * shape.quasi_conformal_distortion(z[1] - z[0], z[2] - z[0]);
  }
};

/// The units in which a face is measured: those of the coordinates, or its own, in which squares neither overflow nor
/// underflow.
struct Units {
  BinaryUnit position;
  BinaryUnit image;
  bool are_own = false;
};

/// Measures one face after another; Real is the type of the UVs.
template <class Real>
class FaceMeasure {
 public:
  FaceMeasure(const PolygonMesh& mesh, const Real* corner_uv) : mesh_(mesh), corner_uv_(corner_uv) {}

  void measure(int face, FaceDistortion& result) {
    const int n = mesh_.n_corners(face);
    if (n < 3 || !mesh_.is_selected(face)) return;
    units_ = Units();
    Fit fit = add(face, n);
    if (fit == Fit::in_units_only) {
      units_ = units_of(face);
      fit = add(face, n);
    }
    if (fit == Fit::none) {
      result.qc[face] = result.log2_scale[face] = unmeasured;
      return;
    }
    if (!(sums_.area > 0)) return;
    result.qc[face] = sums_.qc / sums_.area;
    result.log2_scale[face] =
        0.5 * std::log2(std::abs(sums_.image_area) / sums_.area) + units_.image.exponent() - units_.position.exponent();
    result.area[face] = units_.position.area_of(sums_.area);
    result.image_area[face] = units_.image.area_of(is_mirrored_ ? -sums_.image_area : sums_.image_area);
  }

 private:
  /// How a face can be measured; `none` if a coordinate is not finite.
  enum class Fit { as_it_is, in_units_only, none };

  const double* coordinates(int corner) const { return mesh_.position(mesh_.corner_vertices[corner]); }
  Eigen::Vector3d position(int corner) const {
    const double* p = coordinates(corner);
    const BinaryUnit& unit = units_.position;
    return {unit.scaled(p[0]), unit.scaled(p[1]), unit.scaled(p[2])};
  }
  Complex image(int corner) const {
    const Real* uv = corner_uv_ + 2 * static_cast<std::size_t>(corner);
    return {units_.image.scaled(uv[0]), units_.image.scaled(uv[1])};
  }

  Units units_of(int face) const {
    Units units;
    units.are_own = true;
    for (int corner = mesh_.face_offsets[face]; corner < mesh_.face_offsets[face + 1]; ++corner) {
      for (int k = 0; k < 3; ++k) units.position.include(coordinates(corner)[k]);
      for (int k = 0; k < 2; ++k) units.image.include(corner_uv_[2 * static_cast<std::size_t>(corner) + k]);
    }
    return units;
  }

  /// How a face can be measured, given the sums of its squared lengths in 3D and in the map. These are not finite if a
  /// coordinate is not finite, or is too large.
  Fit fit_of(int face, double square, double image_square) const {
    if (is_moderate(square) && is_moderate(image_square)) return Fit::as_it_is;
    const int first = mesh_.face_offsets[face];
    bool is_point = true;
    for (int corner = first; corner < mesh_.face_offsets[face + 1]; ++corner) {
      const Complex z = image(corner);
      if (!position(corner).allFinite() || !is_finite(z)) return Fit::none;
      is_point = is_point && z == image(first);
    }
    return units_.are_own || (is_moderate(square) && is_point) ? Fit::as_it_is : Fit::in_units_only;
  }

  /// Adds a face, in the current units.
  Fit add(int face, int n) {
    sums_ = FaceSums();
    // Large meshes consist almost entirely of triangles and quads; a triangle needs no triangulation.
    return n == 3 ? add_triangle(face) : add_polygon(face, n);
  }

  /// Adds a face of three corners; mirrors its image if that is clockwise.
  Fit add_triangle(int face) {
    const int first = mesh_.face_offsets[face];
    const std::array<Eigen::Vector3d, 3> p = {position(first), position(first + 1), position(first + 2)};
    std::array<Complex, 3> z = {image(first), image(first + 1), image(first + 2)};
    // Unlike a maximum, a sum is not finite if one of them is not.
    const double square = (p[1] - p[0]).squaredNorm() + (p[2] - p[0]).squaredNorm();
    const Fit fit = fit_of(face, square, std::norm(z[1] - z[0]) + std::norm(z[2] - z[0]));
    if (fit != Fit::as_it_is) return fit;
    is_mirrored_ = signed_area(z[0], z[1], z[2]) < 0;
    if (is_mirrored_) z = {std::conj(z[0]), std::conj(z[1]), std::conj(z[2])};
    sums_.add(p, z);
    return fit;
  }

  /// Likewise for a face of more corners.
  Fit add_polygon(int face, int n) {
    const Fit fit = read(face, n);
    if (fit != Fit::as_it_is) return fit;
    triangulate_polygon(corners_, polygon_);
    const bool second = has_both_splits() && second_split_is_better({area_of(0), area_of(1), area_of(2), area_of(3)});
    const std::size_t first = second ? 2 : 0;
    const std::size_t count = has_both_splits() ? 2 : polygon_.triangles.size();
    for (std::size_t t = first; t < first + count; ++t) {
      const auto& [a, b, c] = polygon_.triangles[t];
      sums_.add({corners_.row(a), corners_.row(b), corners_.row(c)}, {z_[a], z_[b], z_[c]});
    }
    return fit;
  }

  /// Reads the face in 3D and its image, mirrored if clockwise.
  Fit read(int face, int n) {
    if (corners_.rows() != n) {
      corners_ = Positions(n, 3);
      z_ = ComplexVector(n);
    }
    double square = 0;
    double image_square = 0;
    for (int i = 0; i < n; ++i) {
      const int corner = mesh_.face_offsets[face] + i;
      corners_.row(i) = position(corner);
      z_[i] = image(corner);
      square += (corners_.row(i) - corners_.row(0)).squaredNorm();
      image_square += std::norm(z_[i] - z_[0]);
    }
    const Fit fit = fit_of(face, square, image_square);
    if (fit != Fit::as_it_is) return fit;
    double image_area = 0;
    for (int i = 1; i + 1 < n; ++i) image_area += signed_area(z_[0], z_[i], z_[i + 1]);
    is_mirrored_ = image_area < 0;
    if (is_mirrored_) z_ = z_.conjugate().eval();
    return fit;
  }
  bool has_both_splits() const { return polygon_.triangle_weights.front().in_both_splits(); }
  double area_of(std::size_t t) const {
    const auto& [a, b, c] = polygon_.triangles[t];
    return signed_area(z_[a], z_[b], z_[c]);
  }

  const PolygonMesh& mesh_;
  const Real* corner_uv_;
  Units units_;
  Positions corners_;
  ComplexVector z_;
  bool is_mirrored_ = false;
  PolygonTriangulation polygon_;
  FaceSums sums_;
};

template <class Real>
FaceDistortion measured(const PolygonMesh& mesh, const Real* corner_uv) {
  validate(mesh);
  FaceDistortion result;
  result.qc = Eigen::VectorXd::Ones(mesh.n_faces);
  result.log2_scale = result.area = result.image_area = Eigen::VectorXd::Zero(mesh.n_faces);
  run_blocks_in_parallel(mesh.n_faces, 5000, [&](int begin, int end) {
    FaceMeasure<Real> measure(mesh, corner_uv);
    for (int face = begin; face < end; ++face) measure.measure(face, result);
  });
  return result;
}

}  // namespace

FaceDistortion measure_face_distortion(const PolygonMesh& mesh, const double* corner_uv) {
  return measured(mesh, corner_uv);
}

FaceDistortion measure_face_distortion(const PolygonMesh& mesh, const float* corner_uv) {
  return measured(mesh, corner_uv);
}

}  // namespace spectral_conformal
