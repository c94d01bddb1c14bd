#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "seams/distortion_sums.h"

namespace spectral_conformal::test {
namespace {

struct DistortedFaces {
  std::vector<double> area;
  std::vector<double> log2_scale;
  std::vector<double> qc;

  DistortedFaces(unsigned seed, int n, double spread) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < n; ++i) {
      area.push_back(1e-3 + unit(random));
      log2_scale.push_back(std::clamp(spread * (unit(random) - 0.4), -16.0, 16.0));
      qc.push_back(1 + 9 * unit(random) * unit(random));
    }
  }
  DistortionSums sums() const { return {area, log2_scale, qc}; }
};

}  // namespace

TEST_SUITE_BEGIN("distortion_sums");

TEST_CASE("sums are those over the faces, about any scale, near and far") {
  for (const double spread : {0.0, 0.5, 6.0, 50.0}) {
    const DistortedFaces faces(7, 300, spread);
    const DistortionSums sums = faces.sums();
    for (const double unit : {-16.0, -1.3, 0.0, 0.6, 9.0, 16.0}) {
      double energy = 0, shear = 0, qc = 0, area = 0, below = 0, up_to = 0;
      for (std::size_t f = 0; f < faces.area.size(); ++f) {
        const double by_angles = bounded_cosh(std::log(faces.qc[f]));
        energy += faces.area[f] * by_angles * bounded_cosh(2 * std::log(2.0) * (faces.log2_scale[f] - unit));
        shear += faces.area[f] * 2 * (by_angles - 2);
        qc += faces.area[f] * faces.qc[f];
        area += faces.area[f];
        below += faces.log2_scale[f] < unit ? faces.area[f] : 0;
        up_to += faces.log2_scale[f] <= unit ? faces.area[f] : 0;
      }
      CHECK(sums.energy(unit) == doctest::Approx(energy).epsilon(1e-10));
      CHECK(sums.shear() == doctest::Approx(shear));
      CHECK(sums.qc() == doctest::Approx(qc));
      CHECK(sums.area() == doctest::Approx(area));
      CHECK(sums.area_below(unit) == doctest::Approx(below));
      CHECK(sums.area_up_to(unit) == doctest::Approx(up_to));
    }
  }
}

TEST_CASE("the median of several charts is that of all their faces, also where many have one scale") {
  for (const double spread : {0.0, 1e-12, 0.5, 50.0}) {
    const std::vector<DistortedFaces> charts{{1, 40, spread}, {2, 1, spread}, {3, 77, spread}};
    std::vector<DistortionSums> sums;
    std::vector<std::pair<double, double>> faces;
    for (const DistortedFaces& chart : charts) {
      sums.push_back(chart.sums());
      for (std::size_t f = 0; f < chart.area.size(); ++f) faces.emplace_back(chart.log2_scale[f], chart.area[f]);
    }
    double total = 0;
    for (const auto& [scale, area] : faces) total += area;
    std::sort(faces.begin(), faces.end());
    double area = 0;
    const auto median = std::find_if(faces.begin(), faces.end(), [&](const auto& face) {
      area += face.second;
      return 2 * area >= total;
    });
    CHECK(DistortionSums::median_log2_scale({&sums[0], &sums[1], &sums[2]}, total) == median->first);
  }
  CHECK(DistortionSums::median_log2_scale({}, 0) == 0);
}

TEST_CASE("no faces have no sums") {
  const DistortionSums none;
  CHECK((none.area() == 0 && none.shear() == 0 && none.energy(0.5) == 0 && none.n_faces() == 0));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
