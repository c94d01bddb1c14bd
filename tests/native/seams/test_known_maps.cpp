#include <doctest/doctest.h>

#include "concurrency/work_counter.h"
#include "meshes.h"
#include "seams/known_maps.h"

namespace spectral_conformal::test {
namespace {

/// A map of one face of its own, or of the same one with other vertices.
std::shared_ptr<const TrialMap> map_of(int face, int vertex) {
  TrialMap result;
  result.chart.faces = {face};
  result.chart.vertices = {vertex, vertex + 1, vertex + 2};
  result.chart.triangles = {{0, 1, 2}};
  return std::make_shared<const TrialMap>(result);
}

}  // namespace

TEST_SUITE("known_maps") {
  TEST_CASE("the first map of such a chart is found, and only what was added is contained") {
    const auto one = map_of(3, 0);
    const auto same = map_of(3, 0);
    const auto other = map_of(3, 7);
    KnownMaps maps;
    CHECK(maps.find(one->chart) == nullptr);
    maps.add(one);
    maps.add(same);
    CHECK(maps.find(same->chart) == one);
    CHECK(maps.find(other->chart) == nullptr);
    CHECK(maps.contains(same));
    CHECK_FALSE(maps.contains(other));
  }

  TEST_CASE("however many there are, a look-up costs the same") {
    TrialMaps many;
    for (int face = 0; face < 2000; ++face) many.push_back(map_of(face, 0));
    const KnownMaps maps(many);
    const WorkCounter counter;
    for (const auto& mapped : many) {
      CHECK(maps.contains(mapped));
      CHECK(maps.find(mapped->chart) == mapped);
    }
    CHECK(counter.counts().steps == 4 * many.size());
  }
}

}  // namespace spectral_conformal::test
