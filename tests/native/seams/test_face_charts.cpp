#include <doctest/doctest.h>

#include "seams/face_charts.h"

namespace spectral_conformal::test {

TEST_SUITE("face_charts") {
  TEST_CASE("each face's chart, and each chart's first face") {
    const FaceCharts charts({-1, 2, 0, 2, 0});
    CHECK(charts[0] == -1);
    CHECK(charts[3] == 2);
    CHECK(charts.first_face(0) == 2);
    CHECK(charts.first_face(1) == -1);
    CHECK(charts.first_face(2) == 1);
  }
}

}  // namespace spectral_conformal::test
