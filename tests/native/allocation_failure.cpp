// Every allocation fails in turn: the call must end with std::bad_alloc (or a SolveFailure, or not notice), leave
// nothing allocated, and objects that are kept must solve as before.
//
// An executable of its own, because it replaces operator new. Eigen calls malloc from our object files, where the
// linker puts the functions below in its place (--wrap); CHOLMOD takes its allocator from SuiteSparse_config. What
// OpenBLAS and the C++ library allocate for themselves is left alone.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <atomic>
#include <cstdlib>
#include <functional>
#include <memory>
#include <new>

#include "meshes.h"
#include "seams/handle_cuts.h"
#include "spectral_conformal/distortion.h"
#include "spectral_conformal/errors.h"
#include "spectral_conformal/map_relaxation.h"
#include "spectral_conformal/seam_suggestion.h"
#include "spectral_conformal/unwrap.h"

#ifdef SPECTRAL_CONFORMAL_HAVE_CHOLMOD
#include <SuiteSparse_config.h>
#endif

namespace {

// Of all threads.
std::atomic<long> countdown{0};         // the allocation that fails; 0 or less: none
std::atomic<long> allocations{0};       // allocations since the last reset
std::atomic<long> alive{0};             // allocated and not yet freed
std::atomic<std::size_t> requested{0};  // bytes since the last reset

bool fails(std::size_t size) {
  ++allocations;
  requested += size;
  return countdown > 0 && countdown-- == 1;
}

void* count(void* memory) {
  if (memory != nullptr) ++alive;
  return memory;
}

}  // namespace

extern "C" {
void* __real_malloc(std::size_t size);
void* __real_calloc(std::size_t n, std::size_t size);
void* __real_realloc(void* memory, std::size_t size);
void __real_free(void* memory);

void* __wrap_malloc(std::size_t size) { return fails(size) ? nullptr : count(__real_malloc(size)); }
void* __wrap_calloc(std::size_t n, std::size_t size) {
  return fails(n * size) ? nullptr : count(__real_calloc(n, size));
}
void* __wrap_realloc(void* memory, std::size_t size) {
  if (fails(size)) return nullptr;
  void* const result = __real_realloc(memory, size);
  return memory == nullptr ? count(result) : result;
}
void __wrap_free(void* memory) {
  if (memory != nullptr) --alive;
  __real_free(memory);
}
}

// Through the wrapped functions: this file is linked like all others. The compiler must not see that new is malloc here
// and delete there is free, which it takes for a mismatch.
namespace {
[[gnu::noinline]] void* allocate(std::size_t size) { return std::malloc(size > 0 ? size : 1); }
[[gnu::noinline]] void* allocate_or_throw(std::size_t size) {
  if (void* const memory = allocate(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void release(void* memory) { std::free(memory); }
}  // namespace

void* operator new(std::size_t size) { return allocate_or_throw(size); }
void* operator new[](std::size_t size) { return allocate_or_throw(size); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return allocate(size); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return allocate(size); }
void operator delete(void* memory) noexcept { release(memory); }
void operator delete[](void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }
void operator delete[](void* memory, std::size_t) noexcept { release(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { release(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { release(memory); }

namespace spectral_conformal::test {
namespace {

void use_failing_allocator_in_cholmod() {
#if defined(SUITESPARSE_MAIN_VERSION) && SUITESPARSE_MAIN_VERSION >= 6
  SuiteSparse_config_malloc_func_set(__wrap_malloc);
  SuiteSparse_config_calloc_func_set(__wrap_calloc);
  SuiteSparse_config_realloc_func_set(__wrap_realloc);
  SuiteSparse_config_free_func_set(__wrap_free);
#elif defined(SPECTRAL_CONFORMAL_HAVE_CHOLMOD)
  SuiteSparse_config.malloc_func = __wrap_malloc;
  SuiteSparse_config.calloc_func = __wrap_calloc;
  SuiteSparse_config.realloc_func = __wrap_realloc;
  SuiteSparse_config.free_func = __wrap_free;
#endif
}

enum class End { done, out_of_memory, failed };

/// Runs a task whose n-th allocation fails; 0: none.
End run(const std::function<void()>& task, long n) {
  countdown = n;
  allocations = 0;
  End end = End::done;
  try {
    task();
  } catch (const std::bad_alloc&) {
    end = End::out_of_memory;
  } catch (const SolveFailure&) {
    end = End::failed;
  }
  countdown = 0;
  return end;
}

/// Lets the allocations of a task fail one after the other; `after` is called after each, with all memory
/// available. At least the fraction `least` of them end with std::bad_alloc: most, if the task has one part.
void fail_in_turn(
    const std::function<void()>& task, const std::function<void()>& after = [] {}, double least = 0.9) {
  use_failing_allocator_in_cholmod();
  REQUIRE(run(task, 0) == End::done);  // what is made once
  after();
  REQUIRE(run(task, 0) == End::done);
  const long all = allocations;
  after();
  REQUIRE(all > 10);
  // All of the first, then growing steps: what comes later repeats itself.
  int out_of_memory = 0;
  int tried = 0;
  for (long n = 1; n <= all; n += 1 + n / 10) {
    const long before = alive;
    if (run(task, n) == End::out_of_memory) ++out_of_memory;
    ++tried;
    after();
    if (alive != before) FAIL_CHECK("allocation " << n << " of " << all << ": " << alive - before << " left");
  }
  // std::stable_sort and the like do with less memory.
  CHECK(out_of_memory > least * tried);
}

Mesh with_seams() {
  Mesh mesh = quad_grid(6, 4);
  Mesh other = perforated_grid(4, 4);
  mesh.append(other);
  for (int v = 14; v < 18; ++v) mesh.seams.push_back({v, v + 1});
  return mesh;
}

/// What fails in one of several charts is made up for: it is solved once more, when the others are done.
void fail_in_each_chart(const Mesh& mesh, const UnwrapOptions& options) {
  const Unwrap expected = unwrap(mesh.view(), options, {});
  REQUIRE(expected.charts.size() > 1);
  Unwrap found;
  int solved = 0;
  fail_in_turn([&] { found = unwrap(mesh.view(), options, {}); },
               [&] {
                 if (found.charts.empty()) return;  // The memory was the mesh's.
                 ++solved;
                 CHECK(found.uv == expected.uv);
                 CHECK(found.chart_of_face == expected.chart_of_face);
                 found = {};
               },
               0);
  CHECK(solved > 10);
}

}  // namespace

TEST_SUITE_BEGIN("allocation_failure");

TEST_CASE("unwrap") {
  const Mesh mesh = with_seams();
  for (const auto backend : backends()) {
    UnwrapOptions options;
    options.patch.backend = backend;
    options.patch.fill_holes = true;
    options.solve.hole_rigidity = 0.5;
    options.extenders = {{0, 20, 0.3}};
    fail_in_each_chart(mesh, options);
    UnwrapOptions pinned;
    pinned.patch.backend = backend;
    pinned.vertex_pins = {{0, {0, 0}}, {6, {1, 0}}, {30, {3, 1}}};
    fail_in_each_chart(mesh, pinned);
  }
}

TEST_CASE("every method of a patch") {
  const Patch patch(perforated_grid(4, 5));
  for (const auto backend : backends()) {
    for (const auto method : {Method::spectral, Method::lscm, Method::fiedler, Method::area}) {
      PatchOptions options;
      options.backend = backend;
      SolveOptions solve;
      solve.method = method;
      fail_in_turn([&] { Solver::of(patch.chart, patch.positions, options).solve(solve, {}); });
    }
  }
}

TEST_CASE("linear equations, with held coordinates and without") {
  const Patch patch(bumpy_grid(6, 4));
  const ComplexVector flat = flat_map(patch.positions);
  LinearEquations rows;
  for (int v = 0; v < 6; ++v) rows.add({{2 * v + 1, 1}, {2 * v + 3, -1}});
  LinearEquations held = rows;
  for (const int c : {0, 1, 40, 41}) held.held.emplace_back(c, 0.1 * c);
  for (const auto backend : backends()) {
    PatchOptions options;
    options.backend = backend;
    for (const LinearEquations& equations : {rows, held}) {
      SolveOptions solve;
      solve.constraints = equations;
      fail_in_turn([&] { Solver::of(patch.chart, patch.positions, options).solve(solve, {}); });
      MapRelaxationOptions relaxed;
      relaxed.backend = backend;
      relaxed.constraints = equations;
      fail_in_turn(
          [&] { MapRelaxation::begin(patch.positions, patch.chart.triangles, flat, {}, {}, relaxed).advance(2); });
    }
  }
}

TEST_CASE("a kept solver solves as before") {
  const Mesh mesh = with_seams();
  for (const auto backend : backends()) {
    UnwrapOptions options;
    options.patch.backend = backend;
    options.patch.area_blend = 0.5;
    std::unique_ptr<Unwrapper> kept;
    const auto solve = [&] { return kept->solve({}, 0, 1e-8, nullptr, {}).uv; };
    kept = std::make_unique<Unwrapper>(Unwrapper::of(mesh.view(), options));
    const auto expected = solve();
    fail_in_turn(
        [&] {
          if (!kept) kept = std::make_unique<Unwrapper>(Unwrapper::of(mesh.view(), options));
          solve();
        },
        [&] {
          if (kept) CHECK(solve() == expected);
          kept.reset();
        },
        0);  // There are several charts, as above.
  }
}

TEST_CASE("maps without folds, in place and by an embedding") {
  // Beyond -1 the third triangle folds (Floater 1998); a spike moved aside leaves no room.
  const Mesh floater({{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, -3, 1}}, {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
  Mesh rough = flat_grid(4, 4);
  for (std::size_t v = 0; v < rough.points.size(); ++v) rough.points[v].z() = 1.7 * static_cast<double>(v * v % 5);
  for (const auto backend : backends()) {
    UnwrapOptions options;
    options.patch.backend = backend;
    options.solve.fold_free = true;
    fail_in_turn([&] { unwrap(floater.view(), options, {}); });
    fail_in_turn([&] { unwrap(rough.view(), options, {}); });
  }
}

TEST_CASE("suggested seams") {
  const Mesh mesh = sphere(3);
  for (const auto backend : backends()) {
    SeamSuggestionOptions options;
    options.map.backend = backend;
    // Seams that meet the limits stay if memory runs out for what would shorten them.
    fail_in_turn([&] { suggest_seams(mesh.view(), options, {}); }, [] {}, 0.8);
  }
}

TEST_CASE("seams for looser limits stay if memory runs out for the search that follows") {
  use_failing_allocator_in_cholmod();
  const Mesh mesh = sphere(3);
  SeamSuggestionOptions options;
  options.qc_limit = 1.3;
  SeamSuggestion found;
  const auto search = [&] { found = suggest_seams(mesh.view(), options, {}); };
  REQUIRE(run(search, 0) == End::done);
  const long all = allocations;
  int n_found = 0;
  int n_tried = 0;
  for (long n = 1; n <= all; n += 1 + all / 50) {
    found = {};
    ++n_tried;
    if (run(search, n) != End::done) continue;
    CHECK(found.n_given_up == 0);
    CHECK_FALSE(found.edges.empty());
    ++n_found;
  }
  CHECK(10 * n_found > n_tried);
}

TEST_CASE("distortion") {
  const Mesh mesh = flat_grid(5, 4);
  Positions positions(static_cast<Eigen::Index>(mesh.points.size()), 3);
  for (Eigen::Index v = 0; v < positions.rows(); ++v) positions.row(v) = mesh.points[v].transpose();
  const ComplexVector z = flat_map(positions);
  fail_in_turn([&] { measure_mesh_distortion(mesh.view(), z); });
}

TEST_CASE("handles are cut open without building the charts anew for every loop that is tried") {
  // A plate with 6 x 6 square holes: genus 36, and twice as many generators. Memory stands for work here: charts that
  // are built anew allocate all of theirs.
  const Mesh mesh = cell_surface(13, [](int i, int j, int k) { return k == 0 && (i % 2 == 0 || j % 2 == 0); });
  const SeamGraph graph = SeamGraph::of(mesh.view());
  const auto bytes = [](const std::function<void()>& task) {
    requested = 0;
    task();
    return requested.load();
  };
  std::size_t n_cuts = 0;
  const std::size_t charts = bytes([&] { build_charts(mesh.view()); });
  const std::size_t loops = bytes([&] { generator_loops(graph, mesh.n_faces(), 0); });
  const std::size_t all = bytes([&] { n_cuts = handle_cuts(mesh.view(), graph, [](int) { return -1; }).size(); });
  // At least one per handle, and at most all generators: sharp rims are cheaper than short loops.
  CHECK(n_cuts >= 36);
  CHECK(n_cuts <= 72);
  CHECK(all < 4 * (charts + loops));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
