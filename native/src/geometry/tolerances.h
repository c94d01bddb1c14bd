#pragma once

#include <limits>

namespace spectral_conformal {

// Tolerances relative to the size of what they judge, for all that has no reason for one of its own. Double precision
// rounds by u = 1.1e-16, single precision, in which files and Blender store positions, by 6e-8.

/// 2 u, the distance of 1 from the next number.
constexpr double epsilon = std::numeric_limits<double>::epsilon();
/// What sums and products of thousands of numbers lose: 1e4 u.
constexpr double sum_rounding = 1e-12;
/// Differences that count as none: far above sum_rounding, far below what anyone sees or measures.
constexpr double insignificant = 1e-9;
/// The distance of 1 from the next number in single precision, in which UVs are stored.
constexpr double single_epsilon = std::numeric_limits<float>::epsilon();
/// What positions in single precision lose in a few operations.
constexpr double single_rounding = 1e-6;
/// A triangle whose height or image is this thin has a QC of order 1e3. On its own it is invisible.
constexpr double sliver = 1e-3;

}  // namespace spectral_conformal
