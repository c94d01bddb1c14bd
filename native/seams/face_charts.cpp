#include "seams/face_charts.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace spectral_conformal {

FaceCharts::FaceCharts(std::vector<int> chart_of_face) : chart_of_face_(std::move(chart_of_face)) {
  for (std::size_t face = 0; face < chart_of_face_.size(); ++face) {
    if (chart_of_face_[face] < 0) continue;
    const auto chart = static_cast<std::size_t>(chart_of_face_[face]);
    first_face_.resize(std::max(first_face_.size(), chart + 1), -1);
    if (first_face_[chart] < 0) first_face_[chart] = static_cast<int>(face);
  }
}

}  // namespace spectral_conformal
