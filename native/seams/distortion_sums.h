#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace spectral_conformal {

/// What a map all but collapses counts as much as this: the binary logarithm of a scale is within plus and minus it.
constexpr double max_log2_scale = 16;

/// Symmetric Dirichlet energy s1^2 + s2^2 + 1 / s1^2 + 1 / s2^2 of singular values, as the ratio and the product of
/// these tell it: shear * bounded_cosh(2 ln 2 times the difference of the scale's binary logarithm to that of a unit).
/// 2 cosh t, and beyond t = ln 4 the parabola that continues it smoothly.
double bounded_cosh(double t);

/// What map_quality needs of the faces of one chart, summed up in the order of their scale, so that it takes a few
/// look-ups whatever scale the distortion is about.
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
