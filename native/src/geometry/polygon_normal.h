#pragma once

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Newell's normal of a polygon: twice its vector area, the sum of (p_i - origin) x (p_{i+1} - origin) around it. The
/// result depends on the origin only by rounding, which is least for one near the polygon. corners: (n, 3), in order.
Eigen::Vector3d polygon_normal(const Eigen::Ref<const Positions>& corners, const Eigen::Vector3d& origin);

}  // namespace spectral_conformal
