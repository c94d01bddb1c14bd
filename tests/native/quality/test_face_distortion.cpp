#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "meshes.h"
#include "spectral_conformal/distortion.h"
#include "spectral_conformal/errors.h"
#include "spectral_conformal/face_distortion.h"

namespace spectral_conformal::test {
namespace {

/// One point of the plane for every corner, by the map of the mesh's vertices.
std::vector<Complex> at_corners(const Mesh& mesh, const ComplexVector& z) {
  std::vector<Complex> uv;
  for (const int vertex : mesh.corners) uv.push_back(z[vertex]);
  return uv;
}

FaceDistortion measure(const PolygonMesh& mesh, const std::vector<Complex>& uv) {
  return measure_face_distortion(mesh, reinterpret_cast<const double*>(uv.data()));
}

/// Bent, without flips.
ComplexVector bent(const Mesh& mesh) {
  ComplexVector z(static_cast<Eigen::Index>(mesh.points.size()));
  for (Eigen::Index v = 0; v < z.size(); ++v) {
    const auto& p = mesh.points[static_cast<std::size_t>(v)];
    z[v] = Complex(p.x() + 0.1 * std::sin(p.y()), 1.3 * p.y() + 0.02 * p.x() * p.x());
  }
  return z;
}

/// What the triangles of a patch say of its faces.
void check_against_triangles(const Mesh& mesh, const ComplexVector& z) {
  const ChartDecomposition decomposition = build_charts(mesh.view());
  const FaceDistortion faces = measure(mesh.view(), at_corners(mesh, z));
  for (const Chart& chart : decomposition.charts) {
    ComplexVector own(chart.n_vertices());
    for (int v = 0; v < chart.n_vertices(); ++v) own[v] = z[chart.vertices[v]];
    const Distortion triangles =
        measure_distortion(chart.positions(mesh.view()), chart.triangles, chart.triangle_weights, own);
    double total = 0;
    double mean = 0;
    Eigen::VectorXd area = Eigen::VectorXd::Zero(mesh.n_faces());
    Eigen::VectorXd image = area;
    for (const int t : triangles.triangulation) {
      const int face = chart.faces[chart.triangle_face[t]];
      area[face] += triangles.area[t];
      image[face] += triangles.image_area[t];
    }
    for (const int face : chart.faces) {
      CHECK(faces.area[face] == doctest::Approx(area[face]));
      CHECK(faces.image_area[face] == doctest::Approx(image[face]));
      CHECK(faces.log2_scale[face] == doctest::Approx(0.5 * std::log2(std::abs(image[face]) / area[face])));
      total += area[face];
      mean += area[face] * faces.qc[face];
    }
    CHECK(mean / total == doctest::Approx(triangles.mean_qc));
  }
}

}  // namespace

TEST_SUITE_BEGIN("face_distortion");

TEST_CASE("faces are what their triangles are, of quads those that the map is measured by, mirrored or not") {
  Mesh rough = quad_grid(5, 4);
  for (std::size_t v = 0; v < rough.points.size(); ++v)
    rough.points[v].z() = 0.2 * std::sin(3.0 * static_cast<double>(v));
  for (const Mesh& mesh : {bumpy_grid(6, 5), rough}) {
    check_against_triangles(mesh, bent(mesh));
    check_against_triangles(mesh, bent(mesh).conjugate());
  }
}

TEST_CASE("a polygon of more corners counts as a whole") {
  const Mesh mesh({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 0.5, 0}, {0, 2, 0}}, {{0, 1, 2, 3, 4}});
  std::vector<Complex> uv;
  for (const int v : mesh.corners) uv.emplace_back(3 * mesh.points[v].x(), 6 * mesh.points[v].y());
  const FaceDistortion faces = measure(mesh.view(), uv);
  CHECK(faces.qc[0] == doctest::Approx(2));
  CHECK(faces.area[0] == doctest::Approx(2.5));
  CHECK(faces.image_area[0] == doctest::Approx(45));
  CHECK(faces.log2_scale[0] == doctest::Approx(0.5 * std::log2(18)));
}

TEST_CASE("units do not matter, up to the largest and the smallest there are") {
  const Mesh mesh = bumpy_grid(4, 4);
  const FaceDistortion plain = measure(mesh.view(), at_corners(mesh, bent(mesh)));
  Mesh large = mesh;
  for (auto& p : large.points) p *= 0x1p600;
  const FaceDistortion scaled = measure(large.view(), at_corners(mesh, bent(mesh) * 0x1p-700));
  CHECK(scaled.qc == plain.qc);
  CHECK((scaled.log2_scale.array() + 1300 - plain.log2_scale.array()).abs().maxCoeff() < 1e-9);
}

TEST_CASE("single precision is read as it is, and faces of any size are measured beside one another") {
  const Mesh mesh = quad_grid(3, 2);
  const std::vector<Complex> uv = at_corners(mesh, bent(mesh));
  std::vector<float> single;
  std::vector<Complex> rounded;
  for (const Complex z : uv) {
    for (const double x : {z.real(), z.imag()}) single.push_back(static_cast<float>(x));
    rounded.emplace_back(single[single.size() - 2], single.back());
  }
  const FaceDistortion expected = measure(mesh.view(), rounded);
  CHECK(measure_face_distortion(mesh.view(), single.data()).qc == expected.qc);

  Mesh both = mesh;
  Mesh large = mesh;
  for (auto& p : large.points) p *= 0x1p600;
  both.append(large);
  std::vector<Complex> both_uv = rounded;
  for (const Complex z : rounded) both_uv.push_back(z * 0x1p-700);
  const FaceDistortion found = measure(both.view(), both_uv);
  CHECK(found.qc.head(mesh.n_faces()) == expected.qc);
  CHECK(found.qc.tail(mesh.n_faces()) == expected.qc);
}

TEST_CASE("faces without area, without image, without a finite point, and those that are not selected") {
  const Mesh mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}},
                  {{0, 1, 2}, {0, 1, 3}, {0, 1, 2}, {0, 1, 2}, {0, 1, 2}, {0, 1}});
  std::vector<Complex> uv = {0, 1, {0, 1}, 0, 1, {0, 1}, 0, 1, 2, 0, std::nan(""), 1, 0, 1, 5, 0, 1};
  const bool selected[] = {true, true, true, true, false, true};
  PolygonMesh view = mesh.view();
  view.selected_faces = selected;
  const FaceDistortion faces = measure(view, uv);
  CHECK(faces.qc[0] == doctest::Approx(1));
  for (const int without : {1, 4, 5}) {
    CHECK(faces.qc[without] == 1);
    CHECK(faces.log2_scale[without] == 0);
    CHECK(faces.area[without] == 0);
  }
  CHECK(faces.qc[2] == std::numeric_limits<double>::infinity());
  CHECK(faces.log2_scale[2] == -std::numeric_limits<double>::infinity());
  CHECK(faces.area[2] == doctest::Approx(0.5));
  CHECK(std::isnan(faces.qc[3]));
  CHECK(faces.area[3] == 0);
  PolygonMesh bad = mesh.view();
  bad.n_vertices = 2;
  CHECK_THROWS_AS(measure(bad, uv), InvalidMesh);
  CHECK(measure(PolygonMesh{}, {}).qc.size() == 0);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
