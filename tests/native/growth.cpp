// Work in which one thing is huge, for tests/native/test_growth.py, which counts its instructions at several sizes: the
// name of a case and a size. What each makes ready before is not counted.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "conformal/boundary_form.h"
#include "conformal/start_vector.h"
#include "geometry/ear_clipping.h"
#include "injective/fold_free_map.h"
#include "layout/congruent_islands.h"
#include "layout/upright.h"
#include "mesh/charts.h"
#include "mesh/corner_pins.h"
#include "mesh/mirror_symmetry.h"
#include "meshes.h"
#include "spectral_conformal/box_packing.h"
#include "spectral_conformal/kept_maps.h"
#include "spectral_conformal/map_defects.h"
#include "spectral_conformal/thread_limit.h"

namespace {

/// The work that is counted; its name is what Callgrind goes by.
std::function<void()> counted;

}  // namespace

extern "C" __attribute__((noinline)) void counted_work() { counted(); }

namespace spectral_conformal::test {
namespace {

Eigen::Vector3d on_circle(int k, int n, double radius = 1, double height = 0) {
  const double angle = 2 * pi * k / n;
  return {radius * std::cos(angle), radius * std::sin(angle), height};
}

/// Triangles around a vertex, the last one.
Mesh fan(int n) {
  Mesh mesh;
  for (int k = 0; k < n; ++k) mesh.points.push_back(on_circle(k, n));
  mesh.points.emplace_back(0, 0, 0.5);
  for (int k = 0; k < n; ++k) mesh.add({n, k, (k + 1) % n});
  return mesh;
}

/// Copies of a polygon.
Mesh polygons(int n_corners, int times) {
  Mesh mesh;
  std::vector<int> polygon;
  for (int k = 0; k < n_corners; ++k) {
    mesh.points.push_back(on_circle(k, n_corners));
    polygon.push_back(k);
  }
  for (int k = 0; k < times; ++k) mesh.add(polygon);
  return mesh;
}

/// A cube, and quads with `n` vertices in the spot in its middle, one in eight where the tolerance resolves them.
Mesh cube_with_spot(int n) {
  Mesh mesh = cell_surface(1, [](int, int, int) { return true; });
  for (Eigen::Vector3d& p : mesh.points) p -= Eigen::Vector3d::Constant(0.5);
  Mesh spot = quad_grid(static_cast<int>(std::sqrt(n)), static_cast<int>(std::sqrt(n)));
  for (Eigen::Vector3d& p : spot.points) p *= 1e-7;
  mesh.append(spot);
  return mesh;
}

std::function<void()> eviction(int n) {
  const std::size_t one = 1000;
  const auto kept = std::make_shared<KeptMaps>(static_cast<std::size_t>(n) * one);
  const auto keep = [kept](int k) {
    std::string description(800, 'x');
    description += std::to_string(k);
    kept->keep(std::move(description), {});
  };
  for (int k = 0; k < n; ++k) keep(k);
  return [=] {
    for (int k = n; k < 2 * n; ++k) keep(k);
  };
}

std::function<void()> found_among_much_alike(int n) {
  // Like the charts of a mesh while one vertex is dragged.
  const auto kept = std::make_shared<KeptMaps>(std::size_t{1} << 40);
  const auto description = [](int k) {
    std::string result(20'000, 'x');
    result.replace(10'000, 8, std::to_string(10'000'000 + k));
    return result;
  };
  for (int k = 0; k < n; ++k) kept->keep(description(k), {});
  return [=] {
    for (int k = 0; k < 100; ++k) kept->find(description(n + k));
  };
}

std::function<void()> upright_hull(int n) {
  const auto patch = std::make_shared<Patch>(fan(n));
  const auto energy = std::make_shared<ConformalEnergy>(patch->energy(Weights::uniform));
  const ComplexVector z = flat_map(patch->positions);
  return [=] { upright_turn(z, *energy, patch->outer(), patch->positions); };
}

std::function<void()> start_of_long_border(int n) {
  const auto patch = std::make_shared<Patch>(fan(n));
  const BoundaryForm form = boundary_form(patch->outer(), patch->positions, BoundaryMeasure::length);
  return [=] { start_vector(form, 0); };
}

std::function<void()> mirror_symmetry(Mesh&& made) {
  const auto mesh = std::make_shared<Mesh>(std::move(made));
  return [=] { find_mirror_symmetry(mesh->view()); };
}

/// A prism without its bottom, every second corner of whose cap lies so near the next that the tolerance cannot tell
/// them apart.
Mesh prism(int n) {
  Mesh mesh;
  std::vector<int> cap;
  for (const double height : {1.0, -1.0}) {
    for (int k = 0; k < n; ++k) {
      // Mirrored, ends of pairs are ends of pairs.
      const double angle = 2 * pi * (k / 2) / (n / 2) + (k % 2 == 0 ? -1e-5 : 1e-5);
      mesh.points.emplace_back(std::cos(angle), std::sin(angle), height);
    }
  }
  for (int k = 0; k < n; ++k) cap.push_back(k);
  mesh.add(cap);
  for (int k = 0; k < n; ++k) mesh.add({k, n + k, n + (k + 1) % n, (k + 1) % n});
  return mesh;
}

std::function<void()> pins_at_pole(int n) {
  const auto mesh = std::make_shared<Mesh>(fan(n));
  const auto pinned = std::make_shared<std::vector<char>>(mesh->corners.size(), 0);
  const auto uv = std::make_shared<std::vector<double>>();
  for (int c = 0; c < 3 * n; ++c) {
    (*pinned)[static_cast<std::size_t>(c)] = c % 2 == 0 ? 1 : 0;
    uv->insert(uv->end(), {std::sin(1.0 * c), std::sin(0.7 * c)});
  }
  return [=] { PinSplitMesh::of(mesh->view(), {reinterpret_cast<const bool*>(pinned->data()), uv->data()}); };
}

std::function<void()> duplicate_polygons(int n) {
  // Two alone would be a closed surface.
  const auto mesh = std::make_shared<Mesh>(polygons(n, 3));
  return [=] { build_charts(mesh->view()); };
}

/// Boxes of random sizes; where one is far longer than all others, it lies in a strip of its own length.
std::function<void()> packing(int n, double longest) {
  std::mt19937 generator(1);
  const auto size = [&] { return 0.1 + static_cast<double>(generator()) / 4294967296.0; };
  std::vector<PackedBox> boxes(static_cast<std::size_t>(n));
  for (PackedBox& box : boxes) {
    box.width = size();
    box.height = size();
  }
  boxes.front().width = std::max(boxes.front().width, longest);
  return [=]() mutable { pack_boxes(boxes); };
}

/// Quads with vertices of their own in a row, each as long as all of them, aslant, so that their boxes meet; spaced
/// such that they touch up to rounding, or do not.
std::function<void()> slanting_islands(int n, double width) {
  const auto mesh = std::make_shared<Mesh>();
  const auto uv = std::make_shared<std::vector<double>>();
  for (int k = 0; k < n; ++k) {
    const Complex across(0.7, -0.7);
    const Complex along(0.7 * n, 0.7 * n);
    const Complex from = (1.0 * k) * across;
    const Complex to = (k + width) * across;
    for (const Complex p : {from, to, to + along, from + along}) {
      mesh->points.emplace_back(p.real(), p.imag(), 0);
      uv->insert(uv->end(), {static_cast<double>(static_cast<float>(p.real() / n)), p.imag() / n});
    }
    mesh->add({4 * k, 4 * k + 1, 4 * k + 2, 4 * k + 3});
  }
  return [=] { find_map_defects(mesh->view(), uv->data(), true); };
}

/// Triangles about one point, up to rounding.
std::function<void()> covering_once(int n) {
  std::vector<Complex> points;
  std::vector<std::array<int, 3>> triangles;
  for (int k = 0; k < n; ++k) {
    const Complex at = std::polar(1e-9, 1.0 * k);
    points.insert(points.end(), {at, std::polar(1.0, 2 * pi * k / n), std::polar(1.0, 2 * pi * (k + 1) / n)});
    triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
  }
  return [=] { covers_once(points, triangles, 1e-6); };
}

/// Rectangles of one diameter, each of another area.
std::function<void()> islands_of_one_diameter(int n) {
  std::vector<IslandOutline> islands;
  for (int k = 0; k < n; ++k) {
    const Complex p = std::polar(0.5, 0.25 * pi * (k + 1) / (n + 1));
    islands.push_back(
        {{{p, -std::conj(p)}, {-std::conj(p), -p}, {-p, std::conj(p)}, {std::conj(p), p}}, 4 * p.real() * p.imag()});
  }
  return [=] { congruent_islands(islands, Congruence::mirrored, 1e-9); };
}

/// A ribbon that winds three times around an axis, which its map does too until its parts are moved apart.
std::function<void()> coil_moved_apart(int n) {
  Mesh mesh;
  for (int k = 0; k <= n; ++k) {
    const double radius = n / (6 * pi);
    mesh.points.push_back(on_circle(3 * k, n, radius, 0.1 * k));
    mesh.points.push_back(on_circle(3 * k, n, radius + 1, 0.1 * k));
    if (k > 0) mesh.add({2 * k - 2, 2 * k - 1, 2 * k + 1, 2 * k});
  }
  const auto patch = std::make_shared<Patch>(mesh);
  const auto energy = std::make_shared<ConformalEnergy>(patch->energy(Weights::uniform));
  return [=] {
    const std::vector<char> held;
    fold_free_map(
        {*energy, patch->positions, patch->chart.boundary_loops, held, FactorizationBackend::automatic, false, true, 0},
        flat_map(patch->positions));
  };
}

const std::map<std::string, std::function<std::function<void()>(int)>> cases = {
    {"boxes", [](int n) { return packing(16 * n, 0); }},  // a tree takes over from a list of 100 segments
    {"boxes, one of them long", [](int n) { return packing(n, n); }},
    {"eviction of kept maps", eviction},
    {"kept maps that are much alike", found_among_much_alike},
    {"upright: corners of the hull", upright_hull},
    {"start vector: border", start_of_long_border},
    {"mirror symmetry: one spot", [](int n) { return mirror_symmetry(cube_with_spot(n)); }},
    {"mirror symmetry: valence", [](int n) { return mirror_symmetry(fan(n)); }},
    {"mirror symmetry: corners of a polygon", [](int n) { return mirror_symmetry(prism(n)); }},
    {"mirror symmetry: duplicates", [](int n) { return mirror_symmetry(polygons(5, n)); }},
    {"pins at a pole", pins_at_pole},
    {"duplicate polygons", duplicate_polygons},
    {"map defects: islands that touch aslant", [](int n) { return slanting_islands(n, 1); }},
    {"map defects: islands apart aslant", [](int n) { return slanting_islands(n, 0.5); }},
    {"covers once: triangles about one point", covering_once},
    {"congruent islands: one diameter", islands_of_one_diameter},
    {"fold-free map: a coil moved apart", [](int n) { return coil_moved_apart(n / 4); }},
};

}  // namespace
}  // namespace spectral_conformal::test

int main(int argc, char** argv) {
  using spectral_conformal::test::cases;
  if (argc == 1) {
    for (const auto& each : cases) std::printf("%s\n", each.first.c_str());
    return 0;
  }
  if (argc != 3 || cases.count(argv[1]) == 0) return 1;
  // Callgrind counts by thread.
  const spectral_conformal::ThreadLimit one_thread(1);
  counted = cases.at(argv[1])(std::atoi(argv[2]));
  counted_work();
  return 0;
}
