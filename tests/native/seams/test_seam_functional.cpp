#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <tuple>

#include "seams/seam_functional.h"

namespace spectral_conformal::test {
namespace {

/// A map of faces with these areas, scales and QC.
std::shared_ptr<const TrialMap> map_of(std::vector<double> area, std::vector<double> log2_scale,
                                       std::vector<double> qc) {
  TrialMap map;
  map.solved = true;
  map.area = std::move(area);
  map.log2_scale = std::move(log2_scale);
  map.qc = std::move(qc);
  return std::make_shared<const TrialMap>(std::move(map));
}

}  // namespace

TEST_SUITE_BEGIN("seam_functional");

TEST_CASE("an isometry costs its seams and islands alone") {
  const SeamSuggestionOptions options;
  const SeamFunctional functional(options);
  const auto isometry = map_of({2, 7}, {0, 0}, {1, 1});
  const auto value = [&](double cost, const TrialMaps& maps) {
    return functional(cost, 0, maps.size(), map_quality(maps, 2));
  };
  CHECK(value(0, {isometry}) == doctest::Approx(0.05));
  CHECK(value(0, {isometry, isometry}) == doctest::Approx(0.1));
  CHECK(value(6, {isometry}) == doctest::Approx(0.05 + 6.0 / 3));
  const MapQuality quality = map_quality({isometry}, 2);
  CHECK(SeamFunctional(options, 0.1)(6, 0, 1, quality) == doctest::Approx(0.5 + 6.0 / 3));  // of the mesh's sheet
  CHECK_FALSE(functional.exceeds_limits(map_quality({isometry}, 2)));
}

TEST_CASE("what islands have beyond the side of the sheet costs as a seam of that length") {
  const SeamSuggestionOptions options;
  SeamFunctional functional(options);
  const auto island = [](double side) {
    TrialMap map;
    map.solved = true;
    map.chart.boundary_loops = {{0, 1, 2, 3}};
    map.z.resize(4);
    map.z << 0, side, Complex(side, 1), Complex(0, 1);
    return std::make_shared<const TrialMap>(std::move(map));
  };
  const TrialMaps islands{island(3), island(5), island(7)};
  CHECK(functional.beyond_sheet(islands) == 0);
  functional.set_sheet_side(4);
  CHECK(functional.beyond_sheet(islands) == 1 + 3);
}

TEST_CASE("an island costs three times as much if seams are organic") {
  SeamSuggestionOptions options;
  options.style = SeamStyle::organic;
  const TrialMaps maps{map_of({4}, {0}, {1})};
  CHECK(SeamFunctional(options)(2, 0, 1, map_quality(maps, 2)) == doctest::Approx(0.15 + 2.0 / 2));
}

TEST_CASE("two islands are cheaper than one on a narrow hinge") {
  const SeamSuggestionOptions options;
  const SeamFunctional functional(options);
  const MapQuality quality = map_quality({map_of({2, 7}, {0, 0}, {1, 1})}, 2);
  CHECK(functional(0, 0.9, 1, quality) == doctest::Approx(0.05 + 0.18));
  CHECK(functional(0, 0, 2, quality) < functional(0, 0.9, 1, quality));
}

TEST_CASE("distortion counts by the rate of its limit, the worst faces most") {
  const auto sheared = map_of({1}, {0}, {2});
  const double excess = 2 * (2 + 0.5) - 4;
  const auto distortion = [&](double energy_limit, const TrialMaps& maps) {
    SeamSuggestionOptions options;
    options.energy_limit = energy_limit;
    options.qc_limit = 10;
    return SeamFunctional(options).distortion(map_quality(maps, 2));
  };
  CHECK(distortion(6, {sheared}) == doctest::Approx(excess / 2));
  CHECK(distortion(5, {sheared}) == doctest::Approx(excess));
  // A tenth of the area: more than a tenth of the distortion.
  const auto partly = map_of({9, 1}, {0, 0}, {1, 2});
  CHECK(distortion(5, {partly}) == doctest::Approx(excess * std::sqrt(0.1)));
  // Beyond the limit each part of what it allows costs three times as much.
  CHECK(distortion(4.5, {sheared}) == doctest::Approx(2 * excess + 3 * (excess - 0.5) / 0.5));
}

TEST_CASE("a share of the limits is exceeded earlier than they are") {
  SeamSuggestionOptions options;
  options.energy_limit = 6;
  options.qc_limit = 3;
  const SeamFunctional functional(options);
  MapQuality quality;
  quality.area = 1;
  for (const auto& [energy, qc, share, exceeds] : {std::tuple{5.9, 2.9, 1.0, false},
                                                   {6.1, 2.9, 1.0, true},
                                                   {5.9, 3.1, 1.0, true},
                                                   {4.9, 1.9, 0.5, false},
                                                   {5.1, 1.9, 0.5, true},
                                                   {4.9, 2.1, 0.5, true}}) {
    quality.energy = energy;
    quality.mean_qc = qc;
    CHECK(functional.exceeds_limits(quality, share) == exceeds);
    if (share == 1) CHECK((functional.beyond_limits(quality) > 0) == exceeds);
  }
  quality.within_limit = 0.9;
  CHECK(functional.exceeds_limits(quality, 1));
}

TEST_CASE("QC beyond its limit costs what the options say, of the whole mesh") {
  SeamSuggestionOptions options;
  options.energy_limit = 1e9;
  options.qc_limit = 1.5;
  options.qc_gain = 0.25;
  const TrialMaps maps{map_of({1}, {0}, {2})};
  const MapQuality quality = map_quality(maps, 2);
  CHECK(SeamFunctional(options).distortion(quality) == doctest::Approx(0.5 / 0.25));
  CHECK(SeamFunctional(options, 0.5).distortion(quality) == doctest::Approx(0.5 * 0.5 / 0.25));
  CHECK(SeamFunctional(options).exceeds_limits(quality));
}

TEST_CASE("a chart without a map costs more than anything") {
  const SeamSuggestionOptions options;
  const TrialMaps maps{std::make_shared<const TrialMap>()};
  CHECK(SeamFunctional(options)(0, 0, maps.size(), map_quality(maps, 2)) == std::numeric_limits<double>::infinity());
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
