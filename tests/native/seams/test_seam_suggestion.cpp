#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <set>

#include "mesh/mirror_symmetry.h"
#include "meshes.h"
#include "seams/seam_graph.h"
#include "seams/trial_map.h"
#include "spectral_conformal/errors.h"
#include "spectral_conformal/seam_suggestion.h"
#include "spectral_conformal/thread_limit.h"
#include "spectral_conformal/unwrap.h"

namespace spectral_conformal::test {
namespace {

double length(const Mesh& mesh, const std::vector<std::array<int, 2>>& edges) {
  double sum = 0;
  for (const auto& [a, b] : edges) sum += (mesh.points[a] - mesh.points[b]).norm();
  return sum;
}

/// Limits that let a face be twice as large as another.
SeamSuggestionOptions twice_as_large() {
  SeamSuggestionOptions options;
  options.scale_limit = 2;
  options.energy_limit = 4.3;
  return options;
}

/// What must hold for every suggestion: new edges of the mesh, in whole cuts.
SeamSuggestion suggested(const Mesh& mesh, const SeamSuggestionOptions& options = {}) {
  SeamSuggestion result = suggest_seams(mesh.view(), options, {});
  std::set<std::array<int, 2>> old;
  for (const auto& [a, b] : mesh.seams) old.insert({std::min(a, b), std::max(a, b)});
  const SeamGraph graph = SeamGraph::of(mesh.view());
  for (const auto& edge : result.edges) {
    CHECK(edge[0] < edge[1]);
    CHECK(graph.find_edge(edge[0], edge[1]) >= 0);
    CHECK(old.insert(edge).second);
  }
  CHECK(result.cut_offsets.front() == 0);
  CHECK(result.cut_offsets.back() == static_cast<int>(result.edges.size()));
  CHECK(std::is_sorted(result.cut_offsets.begin(), result.cut_offsets.end()));
  return result;
}

MapQuality quality_with(Mesh mesh, const std::vector<std::array<int, 2>>& seams) {
  mesh.seams.insert(mesh.seams.end(), seams.begin(), seams.end());
  TrialMaps charts;
  for (Chart& chart : build_charts(mesh.view()).charts) {
    charts.push_back(std::make_shared<const TrialMap>(solve_trial_map(mesh.view(), std::move(chart), {}, false, {})));
  }
  return map_quality(charts, 2);
}

bool symmetric(const Mesh& mesh, const std::vector<std::array<int, 2>>& edges) {
  const MirrorSymmetry symmetry = find_mirror_symmetry(mesh.view());
  const std::set<std::array<int, 2>> known(edges.begin(), edges.end());
  return std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
    const int a = symmetry.vertex[edge[0]], b = symmetry.vertex[edge[1]];
    return known.count({std::min(a, b), std::max(a, b)}) == 1;
  });
}

}  // namespace

TEST_SUITE_BEGIN("seam_suggestion");

TEST_CASE("surfaces of every topology come within the limits, symmetric ones by symmetric seams") {
  for (const Mesh& mesh : {sphere(6), torus(24, 12), double_torus(), spiky_grid(2, 8), ring(20, 0)}) {
    const SeamSuggestion suggestion = suggested(mesh, twice_as_large());
    const MapQuality quality = quality_with(mesh, suggestion.edges);
    CHECK(quality.solved);
    CHECK(quality.within_limit >= 0.95);
    CHECK(quality.mean_qc <= twice_as_large().qc_limit);
    CHECK(quality.energy <= twice_as_large().energy_limit);
    // Within a length, no rigid unfolding takes the place of the search.
    SeamSuggestionOptions limited;
    limited.max_length = 0.9 * length(mesh, suggested(mesh).edges);
    CHECK(symmetric(mesh, suggested(mesh, limited).edges));
  }
}

TEST_CASE("a scan full of small holes gets the seams of one with few (large)") {
  const int n = 36;
  const Mesh ball = sphere(n);  // of 7778 vertices, so that there are coarse copies
  const double edge = pi / 2 / n;
  const ComplexVector moved = random_map(static_cast<Eigen::Index>(ball.points.size()));
  // Irregular triangles: where seams may follow whole edge loops, more local optima are far apart.
  const auto torn = [&](int every) {
    Mesh mesh;
    for (std::size_t v = 0; v < ball.points.size(); ++v) {
      const std::complex<double> by = 0.3 * edge * moved[static_cast<Eigen::Index>(v)];
      mesh.points.push_back((ball.points[v] + Eigen::Vector3d(by.real(), by.imag(), 0)).normalized());
    }
    for (int f = 0; f < ball.n_faces(); ++f) {
      if (f % every == 6) continue;
      const int* const c = &ball.corners[ball.offsets[f]];
      mesh.add({c[0], c[1], c[2]});
      mesh.add({c[0], c[2], c[3]});
    }
    return mesh;
  };
  const Mesh few = torn(4000);
  const double usual = length(few, suggested(few, twice_as_large()).edges);
  int n_longer = 0;
  for (const int every : {83, 97, 113}) {
    const Mesh many = torn(every);
    const SeamSuggestion seams = suggested(many, twice_as_large());
    const SeamGraph graph = SeamGraph::of(many.view());
    for (const auto& [a, b] : seams.edges) CHECK_FALSE(graph.edges()[graph.find_edge(a, b)].cut);
    if (!(length(many, seams.edges) < 1.2 * usual)) ++n_longer;
    const MapQuality quality = quality_with(many, seams.edges);
    CHECK(quality.solved);
    // The limit is a price: to exceed it by this costs as much as a seam across flat faces of a quarter of the root of
    // the area.
    CHECK(quality.energy < twice_as_large().energy_limit + 0.05);
  }
  // The search ends in one of many local optima: of nine such scans, one takes 1.4 times the length, the others less.
  CHECK(n_longer <= 1);
}

TEST_CASE("a body whose vertices are all on edges of four faces is parted through its middle") {
  Mesh finned = tetrahedron();
  for (const auto& [a, b] : {std::pair{0, 1}, {2, 3}}) {
    for (const double side : {3.0, -3.0}) {
      finned.points.emplace_back(0.5 * side, 0.3 * a, side);
      finned.add({a, b, static_cast<int>(finned.points.size()) - 1});
    }
  }
  CHECK_FALSE(quality_with(finned, {}).solved);
  CHECK(quality_with(finned, suggested(finned).edges).solved);
}

TEST_CASE("a one-sided strip is cut to a disk") {
  const Mesh mesh = ring(24, 1);
  CHECK(quality_with(mesh, suggested(mesh).edges).solved);
}

TEST_CASE("a good map gets no seams") {
  CHECK(suggested(quad_grid(5, 5)).edges.empty());
  CHECK(suggested(bumpy_grid(6, 6)).edges.empty());
}

TEST_CASE("components that mirror each other get mirrored seams") {
  Mesh mesh = sphere(5);
  for (Eigen::Vector3d& p : mesh.points) p.x() -= 2;
  Mesh other = mesh;
  for (Eigen::Vector3d& p : other.points) p.x() *= -1;
  for (int f = 0; f < other.n_faces(); ++f) other.reverse(f);
  mesh.append(other);
  const SeamSuggestion suggestion = suggested(mesh);
  CHECK(quality_with(mesh, suggestion.edges).solved);
  CHECK(symmetric(mesh, suggestion.edges));
}

TEST_CASE("the limit of the length holds, but for what topology needs") {
  SeamSuggestionOptions options;
  const Mesh spikes = spiky_grid(2, 8);
  const double whole = length(spikes, suggested(spikes).edges);
  double last_distortion = quality_with(spikes, {}).distortion();
  for (const double part : {0.4, 0.7, 1.0}) {
    options.max_length = part * whole * (1 + 1e-12);
    const SeamSuggestion limited = suggested(spikes, options);
    CHECK(length(spikes, limited.edges) <= options.max_length);
    const double distortion = quality_with(spikes, limited.edges).distortion();
    CHECK(distortion <= last_distortion);
    last_distortion = distortion;
  }
  options.max_length = 0;
  CHECK(suggested(spikes, options).edges.empty());
  CHECK(quality_with(torus(12, 8), suggested(torus(12, 8), options).edges).solved);
}

TEST_CASE("a limit of the length that is not reached changes nothing") {
  for (const Mesh& mesh : {sphere(6), torus(24, 12), double_torus()}) {
    SeamSuggestionOptions options;
    const SeamSuggestion whole = suggested(mesh);
    options.max_length = length(mesh, whole.edges) * (1 + 1e-12);
    CHECK(suggested(mesh, options).edges == whole.edges);
  }
}

TEST_CASE("seams that exist stay and are not repeated") {
  Mesh mesh = spiky_grid(2, 8);
  const SeamSuggestion all = suggested(mesh);
  mesh.seams.assign(all.edges.begin(), all.edges.end());
  suggested(mesh);  // checks that none is repeated
  mesh.seams = {{8, 25}, {42, 25}};
  CHECK(quality_with(mesh, suggested(mesh).edges).distortion() < quality_with(mesh, {}).distortion());
}

TEST_CASE("only edges between selected faces are proposed") {
  const Mesh mesh = spiky_grid(2, 8);
  PolygonMesh view = mesh.view();
  std::unique_ptr<bool[]> selected(new bool[static_cast<std::size_t>(mesh.n_faces())]);
  for (int f = 0; f < mesh.n_faces(); ++f) selected[f] = f % 16 < 8;
  view.selected_faces = selected.get();
  const SeamSuggestion suggestion = suggest_seams(view, {}, {});
  CHECK_FALSE(suggestion.edges.empty());
  for (const auto& edge : suggestion.edges) {
    CHECK(std::min(mesh.points[edge[0]].x(), mesh.points[edge[1]].x()) < 8);
  }
}

TEST_CASE("a cube is unfolded to one net") {
  const Mesh cube = cell_surface(1, [](int, int, int) { return true; });
  const SeamSuggestion suggestion = suggested(cube);
  CHECK(suggestion.edges.size() == 7);
  const MapQuality quality = quality_with(cube, suggestion.edges);
  CHECK(quality.solved);
  CHECK(quality.energy == doctest::Approx(4));
}

TEST_CASE("seams keep out of the viewer's sight and go where weights want them") {
  const Mesh ball = sphere(6);
  const auto mean = [&](const SeamSuggestionOptions& options, int axis) {
    const SeamSuggestion suggestion = suggested(ball, options);
    double sum = 0;
    for (const auto& [a, b] : suggestion.edges) sum += 0.5 * (ball.points[a] + ball.points[b])[axis];
    return sum / static_cast<double>(suggestion.edges.size());
  };
  SeamSuggestionOptions options;
  // For opposite wishes: the seams of each are those of a local optimum, which has no center.
  options.front = {0, -6, 0};
  const double behind = mean(options, 1);
  options.front = {0, 6, 0};
  CHECK(behind - mean(options, 1) > 0.15);
  options.front = {0, 0, 0};
  std::vector<double> upper;
  for (const Eigen::Vector3d& p : ball.points) upper.push_back(p.z() > 0 ? 1 : -1);
  options.vertex_preference = upper.data();
  const double above = mean(options, 2);
  for (double& value : upper) value = -value;
  CHECK(above - mean(options, 2) > 0.15);
}

TEST_CASE("the same input gives the same seams") {
  const Mesh mesh = torus(24, 12);
  CHECK(suggested(mesh).edges == suggested(mesh).edges);
}

TEST_CASE("bodies that are searched at once get the seams that they get one after the other") {
  Mesh mesh = spiky_grid(2, 8);
  for (const int n : {4, 5, 6, 7}) {
    Mesh other = sphere(n);
    for (Eigen::Vector3d& p : other.points) p.x() += 10 * n;
    mesh.append(other);
  }
  const ThreadLimit one(1);
  const SeamSuggestion alone = suggested(mesh);
  const ThreadLimit many(4);
  const SeamSuggestion at_once = suggested(mesh);
  CHECK(alone.edges == at_once.edges);
  CHECK(alone.cut_offsets == at_once.cut_offsets);
}

TEST_CASE("bad parts get no seams and do not stop the others") {
  Mesh mesh = spiky_grid(1, 8);
  Mesh broken = sphere(3);
  broken.points[4].x() = std::numeric_limits<double>::quiet_NaN();
  mesh.append(broken);
  Mesh flat = sphere(3);
  for (Eigen::Vector3d& p : flat.points) p *= 0;
  mesh.append(flat);
  mesh.append(Mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}}, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}));
  mesh.add({0, 0, 1});
  const int spikes = 81;
  const SeamSuggestion suggestion = suggested(mesh);
  CHECK_FALSE(suggestion.edges.empty());
  for (const auto& edge : suggestion.edges) CHECK(edge[1] < spikes);
  CHECK(suggest_seams(Mesh().view(), {}, {}).edges.empty());
}

TEST_CASE("progress rises, ends at 1 and can cancel at any call") {
  const Mesh mesh = spiky_grid(2, 8);
  std::vector<double> fractions;
  suggest_seams(mesh.view(), {}, [&](double fraction, const char*) {
    fractions.push_back(fraction);
    return true;
  });
  CHECK(std::is_sorted(fractions.begin(), fractions.end()));
  CHECK(fractions.back() == 1);
  for (const std::size_t last : {std::size_t{1}, fractions.size() / 2, fractions.size()}) {
    std::size_t calls = 0;
    bool cancelled = false;
    try {
      suggest_seams(mesh.view(), {}, [&](double, const char*) { return ++calls < last; });
    } catch (const Cancelled&) {
      cancelled = true;
    }
    // Threads share the solves, of which only those of the caller's report: sometimes there are fewer.
    CHECK(cancelled == (calls == last));
    if (last == 1) CHECK(cancelled);
  }
}

TEST_CASE("arrays that are no mesh are refused") {
  Mesh mesh = quad_grid(2, 2);
  mesh.corners[3] = -1;
  CHECK_THROWS_AS(suggest_seams(mesh.view(), {}, {}), InvalidMesh);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
