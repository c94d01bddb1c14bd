#pragma once

#include <vector>

namespace spectral_conformal {

/// Linear constraints that hold exactly, because the coordinates that they tie are one unknown: with the map's real
/// coordinates x = (u_0, v_0, u_1, v_1, ...), x = P w, where each row of P has one entry, 1 or -1, or none.
struct LinearConstraints {
  std::vector<int> unknown;       ///< (2V,) index into w for each coordinate; -1 for a coordinate that is 0
  std::vector<signed char> sign;  ///< (2V,) 1 or -1
  int n_unknowns = 0;

  bool empty() const { return unknown.empty(); }
};

}  // namespace spectral_conformal
