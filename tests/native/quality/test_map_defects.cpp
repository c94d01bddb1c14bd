#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "meshes.h"
#include "refusal.h"
#include "spectral_conformal/errors.h"
#include "spectral_conformal/map_defects.h"

namespace spectral_conformal::test {
namespace {

/// A mesh and one point of the plane for each of its corners.
struct MappedMesh {
  Mesh mesh;
  std::vector<Complex> uv;

  explicit MappedMesh(const Mesh& of) : mesh(of) {
    for (const int vertex : mesh.corners) uv.emplace_back(mesh.points[vertex].x(), mesh.points[vertex].y());
  }
  /// Moves one mesh vertex at all of its corners.
  void move(int vertex, Complex to) {
    for (std::size_t c = 0; c < uv.size(); ++c) {
      if (mesh.corners[c] == vertex) uv[c] = to;
    }
  }
  void transform(const std::function<Complex(Complex)>& map) {
    for (Complex& p : uv) p = map(p);
  }
  MapDefects defects(bool between_islands = false) const {
    return find_map_defects(mesh.view(), reinterpret_cast<const double*>(uv.data()), between_islands);
  }
};

std::vector<int> marked(const std::vector<bool>& faces) {
  std::vector<int> result;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (faces[f]) result.push_back(static_cast<int>(f));
  }
  return result;
}

using Faces = std::vector<int>;

}  // namespace

TEST_SUITE_BEGIN("map_defects");

TEST_CASE("a flat mesh has none, nor has its mirror image, nor one whose faces are wound both ways") {
  for (Mesh mesh : {flat_grid(6, 5), quad_grid(6, 5), perforated_grid(6, 6)}) {
    for (const bool mixed : {false, true}) {
      if (mixed) {
        for (int face = 0; face < mesh.n_faces(); face += 3) mesh.reverse(face);
      }
      MappedMesh mapped(mesh);
      for (const bool between : {false, true}) {
        CHECK(marked(mapped.defects(between).flipped).empty());
        CHECK(marked(mapped.defects(between).overlapping).empty());
        mapped.transform([](Complex p) { return std::conj(p); });
      }
    }
  }
}

TEST_CASE("a vertex pulled over its neighbors flips faces, and they cover others") {
  for (const bool mirrored : {false, true}) {
    MappedMesh mapped(quad_grid(4, 3));
    mapped.move(6, Complex(2.6, 1.2));  // from (1, 1), past (2, 1)
    if (mirrored) mapped.transform([](Complex p) { return std::conj(p); });
    const MapDefects defects = mapped.defects();
    CHECK(marked(defects.flipped) == Faces{1, 5});
    CHECK(std::count(defects.overlapping.begin(), defects.overlapping.end(), true) >= 3);
    CHECK(defects.overlapping[5]);
    CHECK_FALSE(defects.overlapping[11]);
  }
}

TEST_CASE("concave quads and n-gons are not flipped, those that cross themselves are") {
  Mesh mesh;
  for (const auto& [x, y] : {std::pair<double, double>{0, 0}, {2, 0}, {2, 2}, {0, 2}, {4, 0}, {5, 1}, {4, 2}}) {
    mesh.points.emplace_back(x, y, 0);
  }
  mesh.add({0, 1, 2, 3});
  mesh.add({1, 4, 5, 6, 2});
  MappedMesh mapped(mesh);
  CHECK(marked(mapped.defects().flipped).empty());
  mapped.move(0, Complex(1.5, 1.2));  // inward, still a simple polygon
  mapped.move(5, Complex(2.2, 1));
  CHECK(marked(mapped.defects().flipped).empty());
  CHECK(marked(mapped.defects().overlapping).empty());
  mapped.move(0, Complex(3, 1));
  CHECK(marked(mapped.defects().flipped) == Faces{0});
  CHECK(marked(mapped.defects().overlapping) == Faces{0, 1});
  mapped.move(0, Complex(0, 0));
  mapped.move(5, Complex(1, 1));
  CHECK(marked(mapped.defects().flipped) == Faces{1});
  CHECK(marked(mapped.defects().overlapping) == Faces{0, 1});
}

TEST_CASE("islands end where the maps of neighbors differ") {
  // Two halves, the right one moved onto the left one, mirrored or not.
  MappedMesh mapped(quad_grid(4, 1));
  for (const int face : {2, 3}) {
    for (int c = mapped.mesh.offsets[face]; c < mapped.mesh.offsets[face + 1]; ++c) mapped.uv[c] -= 1.5;
  }
  CHECK(marked(mapped.defects().overlapping).empty());
  CHECK(marked(mapped.defects(true).overlapping) == Faces{0, 1, 2, 3});
  for (const int face : {2, 3}) {
    for (int c = mapped.mesh.offsets[face]; c < mapped.mesh.offsets[face + 1]; ++c) {
      mapped.uv[c] = std::conj(mapped.uv[c]) + Complex(1, 3);
    }
  }
  CHECK(marked(mapped.defects(true).flipped).empty());
  CHECK(marked(mapped.defects(true).overlapping).empty());
}

TEST_CASE("faces folded over at an edge are flipped where they are the smaller part") {
  MappedMesh mapped(quad_grid(5, 1));
  mapped.transform([](Complex p) { return Complex(3 - std::abs(p.real() - 3), p.imag()); });
  CHECK(marked(mapped.defects().flipped) == Faces{3, 4});
  CHECK(marked(mapped.defects().overlapping) == Faces{1, 2, 3, 4});
}

TEST_CASE("an island that winds past itself overlaps without a flip") {
  MappedMesh mapped(flat_grid(40, 4));
  mapped.transform([](Complex p) { return std::polar(8 + p.imag(), -0.2 * p.real()); });
  const MapDefects defects = mapped.defects();
  CHECK(marked(defects.flipped).empty());
  const auto count = std::count(defects.overlapping.begin(), defects.overlapping.end(), true);
  CHECK(count > 80);
  CHECK(count < 240);
}

TEST_CASE("only selected faces count") {
  MappedMesh mapped(quad_grid(5, 1));
  mapped.transform([](Complex p) { return Complex(3 - std::abs(p.real() - 3), p.imag()); });
  const bool selected[] = {true, true, true, false, false};
  PolygonMesh view = mapped.mesh.view();
  view.selected_faces = selected;
  mapped.uv[19] = std::numeric_limits<double>::quiet_NaN();  // of the last face
  const MapDefects defects = find_map_defects(view, reinterpret_cast<const double*>(mapped.uv.data()), true);
  CHECK(marked(defects.flipped).empty());
  CHECK(marked(defects.overlapping).empty());
}

TEST_CASE("collapsed and degenerate faces, and what single precision cannot tell, are no defects") {
  MappedMesh mapped(quad_grid(4, 1));
  mapped.transform([](Complex p) { return Complex(std::min(p.real(), 2.0), p.imag()); });
  CHECK(marked(mapped.defects(true).flipped).empty());
  CHECK(marked(mapped.defects(true).overlapping).empty());
  // The last faces folded back by less than rounding, or by more.
  for (const double back : {1e-8, 1e-3}) {
    MappedMesh folded(quad_grid(4, 1));
    folded.transform([&](Complex p) { return p.real() > 3.5 ? Complex(3 - back, p.imag()) : p; });
    CHECK(marked(folded.defects().flipped) == (back > 1e-6 ? Faces{3} : Faces{}));
    CHECK(marked(folded.defects().overlapping) == (back > 1e-6 ? Faces{2, 3} : Faces{}));
  }
  Mesh degenerate = quad_grid(2, 1);
  degenerate.add({0, 1});
  degenerate.add({0, 0, 1});
  CHECK(marked(MappedMesh(degenerate).defects(true).overlapping).empty());
}

TEST_CASE("nothing to look at") {
  const MapDefects defects = find_map_defects(PolygonMesh{}, nullptr, true);
  CHECK(defects.flipped.empty());
  CHECK(defects.overlapping.empty());
  MappedMesh none(quad_grid(1, 1));
  const bool selected[] = {false};
  PolygonMesh view = none.mesh.view();
  view.selected_faces = selected;
  CHECK(find_map_defects(view, reinterpret_cast<const double*>(none.uv.data()), false).flipped.size() == 1);
}

TEST_CASE("a UV that is not finite is named") {
  MappedMesh mapped(quad_grid(2, 2));
  mapped.uv[9] = Complex(0, std::numeric_limits<double>::infinity());
  const Step step = refusal([&] { mapped.defects(); });
  CHECK((step.reason == Rejection::uv_not_finite && step.count == 9 && step.index == 2));
}

TEST_CASE("islands are numbered by their first face, apart where the map is cut; faces in none have none") {
  MappedMesh mapped(quad_grid(4, 1));
  mapped.mesh.add({0, 1});
  mapped.uv.insert(mapped.uv.end(), {0.0, 1.0});
  // The last two quads elsewhere: the mesh is cut in its map.
  for (std::size_t c = 8; c < 16; ++c) mapped.uv[c] += 10.0;
  CHECK(mapped.defects().island_of_face == Faces{0, 0, 1, 1, -1});
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
