#pragma once

#include <cstddef>
#include <vector>

namespace spectral_conformal {

/// The charts of the faces of a piece.
class FaceCharts {
 public:
  /// chart_of_face (F,): -1 where a face is in none. Not explicit: it is the same, looked at from both sides.
  FaceCharts(std::vector<int> chart_of_face);

  int operator[](int face) const { return chart_of_face_[static_cast<std::size_t>(face)]; }
  /// The first face of a chart that has one.
  int first_face(int chart) const { return first_face_[static_cast<std::size_t>(chart)]; }

 private:
  std::vector<int> chart_of_face_;
  std::vector<int> first_face_;  ///< per chart, -1 where it has none
};

}  // namespace spectral_conformal
