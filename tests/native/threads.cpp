// Solves in several threads at once give what they give alone, to the bit; and ThreadSanitizer (flavor "thread") has
// nothing to say. An executable of its own, so that this flavor need not build all suites.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <atomic>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "meshes.h"
#include "spectral_conformal/errors.h"
#include "spectral_conformal/seam_suggestion.h"
#include "spectral_conformal/unwrap.h"

namespace spectral_conformal::test {
namespace {

/// Runs tasks at once, one in each thread, none before all threads are there.
void at_once(const std::vector<std::function<void()>>& tasks) {
  std::atomic<std::size_t> ready{0};
  std::vector<std::thread> threads;
  for (const auto& task : tasks) {
    threads.emplace_back([&ready, &task, n = tasks.size()] {
      ++ready;
      while (ready < n) std::this_thread::yield();
      task();
    });
  }
  for (std::thread& thread : threads) thread.join();
}

PatchOptions with(FactorizationBackend backend) {
  PatchOptions options;
  options.backend = backend;
  return options;
}

}  // namespace

TEST_SUITE_BEGIN("threads");

TEST_CASE("solvers of two threads give what they give alone") {
  const std::vector<Mesh> meshes{perforated_grid(24, 20), bumpy_grid(30, 17)};
  for (const auto backend : backends()) {
    const auto maps = [&](const Mesh& mesh) {
      const Patch patch(mesh);
      Solver solver = Solver::of(patch.chart, patch.positions, with(backend));
      std::vector<ComplexVector> result;
      for (const double strength : {0.0, 0.5, 2.0}) {
        SolveOptions options;
        if (strength > 0) options.extenders = {{{3}, {200}, strength}};
        result.push_back(solver.solve(options, {}).z);
      }
      SolveOptions pinned;
      pinned.method = Method::lscm;
      result.push_back(solver.solve(pinned, {{0, {0, 0}}, {9, {1, 0}}}).z);
      return result;
    };
    std::vector<std::vector<ComplexVector>> alone(2);
    std::vector<std::vector<ComplexVector>> together(2);
    for (int k = 0; k < 2; ++k) alone[k] = maps(meshes[k]);
    at_once({[&] { together[0] = maps(meshes[0]); }, [&] { together[1] = maps(meshes[1]); }});
    CHECK(alone == together);
  }
}

TEST_CASE("a factorization that is shared by threads and small solves at once") {
  // Large enough for SupernodalFactor to begin more threads.
  const Mesh large = bumpy_grid(205, 200);
  const Mesh small = perforated_grid(20, 20);
  const auto map = [&](const Mesh& mesh) {
    const Patch patch(mesh);
    return Solver::of(patch.chart, patch.positions, {}).solve({}, {}).z;
  };
  const ComplexVector expected = map(small);
  const ComplexVector expected_large = map(large);
  const auto repeat_small = [&] {
    for (int k = 0; k < 5; ++k) CHECK(map(small) == expected);
  };
  at_once({[&] { CHECK(map(large) == expected_large); }, repeat_small, repeat_small});
}

TEST_CASE("unwraps of one mesh in two threads") {
  Mesh mesh = quad_grid(15, 12);
  mesh.append(perforated_grid(12, 12));
  UnwrapOptions options;
  options.patch.fill_holes = true;
  options.patch.area_blend = 0.3;
  options.solve.fold_free = true;
  const auto expected = unwrap(mesh.view(), options, {}).uv;
  const auto solve = [&] { CHECK(unwrap(mesh.view(), options, {}).uv == expected); };
  at_once({solve, solve});
}

TEST_CASE("islands that threads share get the maps that they get alone") {
  const Mesh island = quad_grid(13, 12);
  Mesh many = island;
  for (int k = 1; k < 15; ++k) many.append(island);  // enough faces for solve_charts to begin more threads
  const auto alone = unwrap(island.view(), {}, {}).uv;
  const UnwrapOptions options;
  Unwrapper unwrapper = Unwrapper::of(many.view(), options);
  for (const auto& uv : {unwrap(many.view(), {}, {}).uv,
                         unwrapper.solve({}, options.solve.hole_rigidity, options.solve.tolerance, nullptr, {}).uv}) {
    REQUIRE(uv.rows() == 15 * alone.rows());
    for (Eigen::Index k = 0; k < 15; ++k) CHECK(uv.middleRows(k * alone.rows(), alone.rows()) == alone);
  }
}

TEST_CASE("seams of two meshes in two threads") {
  const std::vector<Mesh> meshes{sphere(4), torus(12, 8)};
  std::vector<std::vector<std::array<int, 2>>> expected;
  for (const Mesh& mesh : meshes) expected.push_back(suggest_seams(mesh.view(), {}, {}).edges);
  at_once({[&] { CHECK(suggest_seams(meshes[0].view(), {}, {}).edges == expected[0]); },
           [&] { CHECK(suggest_seams(meshes[1].view(), {}, {}).edges == expected[1]); }});
}

TEST_CASE("an unwrapper that another thread cancels solves as before") {
  Mesh mesh = quad_grid(25, 20);
  mesh.append(perforated_grid(20, 20));
  for (const auto backend : backends()) {
    UnwrapOptions options;
    options.patch = with(backend);
    const auto expected = unwrap(mesh.view(), options, {}).uv;
    Unwrapper unwrapper = Unwrapper::of(mesh.view(), options);
    for (int stop_at = 1; stop_at < 30; stop_at += 4) {
      std::atomic<int> reports{0};
      std::atomic<bool> stop{false};
      at_once({[&] {
                 const Progress listen = [&](double, const char*) {
                   ++reports;
                   return !stop;
                 };
                 try {
                   const auto uv = unwrapper.solve({}, 0, 1e-8, nullptr, listen).uv;
                   CHECK(uv == expected);
                 } catch (const Cancelled&) {
                   CHECK(stop);
                 }
                 reports = stop_at;
               },
               [&] {
                 while (reports < stop_at) std::this_thread::yield();
                 stop = true;
               }});
    }
    CHECK(unwrapper.solve({}, 0, 1e-8, nullptr, {}).uv == expected);
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
