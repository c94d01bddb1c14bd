#include <doctest/doctest.h>

#include <array>
#include <atomic>
#include <new>
#include <numeric>
#include <stdexcept>

#include "parameterization/chart_loop.h"

namespace spectral_conformal::test {
namespace {

ChartSolution numbered(int i) {
  ChartSolution solution;
  solution.report.n_vertices = i;
  return solution;
}

}  // namespace

TEST_SUITE_BEGIN("chart_loop");

TEST_CASE("solutions are written in the order of the charts, progress never falls") {
  const std::vector<std::size_t> n_faces{3, 50000, 1, 40, 30000, 2};
  std::vector<int> written;
  double done = 0;
  ChartWork work;
  work.solve = [](int i, const Progress& progress) {
    report(progress, 1, "solve");
    return numbered(i);
  };
  work.give_up = [](int) -> ChartSolution { throw std::logic_error("no memory was missing"); };
  work.write = [&](ChartSolution&& solution) { written.push_back(solution.report.n_vertices); };
  solve_charts(
      n_faces,
      [&](double fraction, const char*) {
        CHECK(fraction >= done);
        done = fraction;
        return true;
      },
      work);
  std::vector<int> all(n_faces.size());
  std::iota(all.begin(), all.end(), 0);
  CHECK(written == all);
  CHECK(done == 1);
  solve_charts({}, {}, work);
}

TEST_CASE("a chart without memory is solved again alone, then given up; all of them are an error") {
  const std::vector<std::size_t> n_faces{10, 10, 10};
  std::array<std::atomic<int>, 3> solves{};
  std::vector<int> written;
  int failing = 1;  // charts that always fail
  ChartWork work;
  work.solve = [&](int i, const Progress&) {
    const int before = solves[static_cast<std::size_t>(i)]++;
    if (i < failing || (i == 1 && before == 0)) throw std::bad_alloc();
    return numbered(i);
  };
  work.give_up = [](int i) { return numbered(-i - 1); };
  work.write = [&](ChartSolution&& solution) { written.push_back(solution.report.n_vertices); };
  solve_charts(n_faces, {}, work);
  CHECK(written == std::vector<int>{-1, 1, 2});
  CHECK(solves[0] == 2);
  CHECK(solves[1] == 2);
  CHECK(solves[2] == 1);
  failing = 3;
  CHECK_THROWS_AS(solve_charts(n_faces, {}, work), std::bad_alloc);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
