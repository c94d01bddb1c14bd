#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cmath>
#include <complex>
#include <limits>
#include <map>
#include <vector>

namespace spectral_conformal {

constexpr double pi = 3.14159265358979323846;  // std::numbers::pi of C++20
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double unmeasured = std::numeric_limits<double>::quiet_NaN();  ///< for what was not or cannot be measured

using Complex = std::complex<double>;

/// Whether the square of a number is far from overflow and underflow, as are products of two such squares.
inline bool is_moderate(double square) {
  constexpr double bound = 0x1p400;
  return square > 1 / bound && square < bound;
}

/// |z|. std::abs is several times slower because it handles numbers whose squares overflow or underflow.
inline double modulus(Complex z) {
  const double square = std::norm(z);
  return is_moderate(square) ? std::sqrt(square) : std::abs(z);
}

inline bool is_finite(Complex z) { return std::isfinite(z.real()) && std::isfinite(z.imag()); }

/// One complex number u + i v per vertex.
using ComplexVector = Eigen::VectorXcd;
/// (V, 3), one position per row.
using Positions = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
/// The lower triangle of a Hermitian matrix, columns sorted, every diagonal entry stored (first in its column).
using HermitianMatrix = Eigen::SparseMatrix<Complex, Eigen::ColMajor, int>;
/// The weight of a triangle: 1, or 1/2 for each of the four triangles of a quad with both splits (quad_splits.h), so
/// that the quad counts once.
class TriangleWeight {
 public:
  TriangleWeight() = default;
  constexpr explicit TriangleWeight(bool in_both_splits) : in_both_splits_(in_both_splits) {}
  constexpr bool in_both_splits() const { return in_both_splits_; }
  constexpr operator double() const { return in_both_splits_ ? 0.5 : 1.0; }

 private:
  bool in_both_splits_ = false;
};
constexpr TriangleWeight whole_triangle(false);
constexpr TriangleWeight split_of_quad(true);

/// Vertices in walking order, with the surface on the left; an edge joins the last vertex to the first.
using BoundaryLoop = std::vector<int>;
/// Position in the plane, u + i v, per pinned vertex.
using Pins = std::map<int, Complex>;
/// Pins on face corners, as in a UV map, in the caller's arrays; owns nothing.
struct CornerPins {
  const bool* pinned = nullptr;  ///< (C,) or null for no pins
  const double* uv = nullptr;    ///< (C, 2) the current map; finite at pinned corners
};

}  // namespace spectral_conformal
