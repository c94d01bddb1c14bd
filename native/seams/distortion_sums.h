#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace spectral_conformal {

/// Bound for nearly collapsed faces: the binary logarithm of a scale is clamped to plus or minus this.
constexpr double max_log2_scale = 16;

/// The symmetric Dirichlet energy s1^2 + s2^2 + 1 / s1^2 + 1 / s2^2 in terms of the ratio and the product of the
/// singular values: shear * bounded_cosh(2 ln 2 times the difference between the binary logarithms of the scale and of
/// a unit). 2 cosh t, and beyond t = ln 4 the parabola that continues it smoothly.
double bounded_cosh(double t);

/// The sums of map_quality over the faces of one chart, as prefix sums in the order of their scale, so that a few
/// look-ups evaluate it about any scale.
class DistortionSums {
 public:
  DistortionSums() = default;
  /// (F,) each: the area, the binary logarithm of the scale, within +-16, and the QC of faces, see TrialMap.
  DistortionSums(const std::vector<double>& area, const std::vector<double>& log2_scale, const std::vector<double>& qc);

  double area() const { return area_.back(); }
  double qc() const { return qc_; }  ///< area times QC
  /// Area times the part of the energy, above that of an isometry, that the angles have in it.
  double shear() const { return 2 * (shear_[0].back() - 2 * area()); }
  /// Area times energy, of a map whose unit of length is exp2(log2_unit).
  double energy(double log2_unit) const;
  /// Area of the faces whose scale is less than this, or not more.
  double area_below(double log2_scale) const { return area_[below(log2_scale)]; }
  double area_up_to(double log2_scale) const { return area_[up_to(log2_scale)]; }
  std::size_t n_faces() const { return log2_scale_.size(); }

  /// The least scale of a face of `charts` with which at least half of their area, `total`, is that of faces with no
  /// larger scale; 0 without faces.
  static double median_log2_scale(const std::vector<const DistortionSums*>& charts, double total);

 private:
  std::size_t below(double log2_scale) const;
  std::size_t up_to(double log2_scale) const;

  std::vector<double> log2_scale_;  ///< ascending
  /// All others: (F + 1,), sums over the first faces by scale.
  std::vector<double> area_{0};
  std::array<std::vector<double>, 3> shear_{{{0.0}, {0.0}, {0.0}}};  ///< of shear times powers of the scale's logarithm
  std::vector<double> wider_{0};                                     ///< of shear times the squared scale
  std::vector<double> narrower_{0};  ///< of shear by the squared scale, but over the last faces
  double qc_ = 0;
};

}  // namespace spectral_conformal
