#include <doctest/doctest.h>

#include "spectral_conformal/kept_maps.h"

namespace spectral_conformal::test {
namespace {

KeptMaps::Map map_of(int vertices, double area) {
  KeptMaps::Map map;
  map.z = ComplexVector::Zero(vertices);
  map.report.area = area;
  return map;
}

}  // namespace

TEST_SUITE_BEGIN("kept_maps");

TEST_CASE("a map is found by its whole description") {
  KeptMaps kept(1'000'000);
  kept.keep("one", map_of(3, 1));
  kept.keep("two", map_of(3, 2));
  REQUIRE(kept.find("one"));
  CHECK(kept.find("one")->report.area == 1);
  CHECK(kept.find("two")->report.area == 2);
  CHECK_FALSE(kept.find("on"));
  CHECK_FALSE(kept.find(std::string("one\0", 4)));
}

TEST_CASE("long descriptions that differ anywhere are different") {
  KeptMaps kept(10'000'000);
  std::string description(20'000, 'x');
  kept.keep(std::string(description), map_of(3, 1));
  for (std::size_t place = 0; place < description.size(); place += 97) {
    std::string other = description;
    other[place] = 'y';
    CHECK_FALSE(kept.find(other));
  }
  CHECK(kept.find(description));
  CHECK_FALSE(kept.find(description + 'x'));
}

TEST_CASE("what was kept stays as it was, and counts once") {
  KeptMaps kept(1'000'000);
  kept.keep("one", map_of(3, 1));
  const std::size_t bytes = kept.bytes();
  kept.keep("one", map_of(3, 2));
  CHECK(kept.find("one")->report.area == 1);
  CHECK(kept.size() == 1);
  CHECK(kept.bytes() == bytes);
}

TEST_CASE("those used last are kept, and none that is too large") {
  KeptMaps kept(100'000);
  for (const char* name : {"a", "b", "c"}) kept.keep(name, map_of(2000, 0));
  CHECK(kept.size() == 3);
  kept.keep("a", map_of(2000, 0));
  kept.keep("d", map_of(2000, 0));
  CHECK(kept.find("a"));
  CHECK_FALSE(kept.find("b"));
  CHECK(kept.find("c"));
  CHECK(kept.find("d"));
  CHECK(kept.bytes() <= 100'000);
  kept.keep("large", map_of(20'000, 0));
  CHECK_FALSE(kept.find("large"));
  CHECK(kept.size() == 3);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
