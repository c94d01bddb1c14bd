#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "conformal/conformal_energy.h"
#include "meshes.h"

namespace spectral_conformal::test {
namespace {

using Vector = Eigen::Vector3d;

/// The constant gradients of u and v over a triangle in 3D, from the gradients of its hat functions.
struct Gradients {
  Vector u = Vector::Zero();
  Vector v = Vector::Zero();
  Vector normal;
  double area;

  Gradients(const Positions& positions, const std::array<int, 3>& triangle, const ComplexVector& z) {
    const auto point = [&](int k) -> Vector { return positions.row(triangle[k % 3]).transpose(); };
    const Vector double_area = (point(1) - point(0)).cross(point(2) - point(0));
    area = 0.5 * double_area.norm();
    normal = double_area.normalized();
    for (int k = 0; k < 3; ++k) {
      const Vector hat = normal.cross(point(k + 2) - point(k + 1)) / (2 * area);
      u += z[triangle[k]].real() * hat;
      v += z[triangle[k]].imag() * hat;
    }
  }
  double dirichlet() const { return 0.5 * area * (u.squaredNorm() + v.squaredNorm()); }
  /// Levy et al. 2002: half of |grad v - grad u turned by 90 degrees|^2.
  double lscm() const { return 0.5 * area * (v - normal.cross(u)).squaredNorm(); }
};

Mesh quads_and_triangles() {
  Mesh mesh = bumpy_grid(4, 4);
  mesh.add({24, 19, 25, 26});
  mesh.points.emplace_back(6, 3, 1);
  mesh.points.emplace_back(6, 4.2, 2);
  return mesh;
}

}  // namespace

TEST_SUITE_BEGIN("conformal_energy");

TEST_CASE("L is Hermitian positive semidefinite with the constants in its null space") {
  for (const auto& mesh : {bumpy_grid(6, 5), perforated_grid(7, 7), quads_and_triangles(), quad_grid(4, 3)}) {
    const Patch patch(mesh);
    for (const auto weights : {Weights::uniform, Weights::inverse_area}) {
      const ConformalEnergy energy = patch.energy(weights);
      const Eigen::MatrixXcd matrix = dense(energy.matrix());
      const double size = matrix.norm();
      CHECK((matrix * ComplexVector::Ones(matrix.cols())).norm() < 1e-13 * size);
      const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXcd>(matrix).eigenvalues();
      CHECK(values[0] > -1e-13 * size);
      // The real Laplacian's null space is the constants, so on a patch that is not flat L's is too.
      if (mesh.points.size() != 20) CHECK(values[1] > 1e-8 * size);
    }
  }
}

TEST_CASE("the matrix is stored as the lower triangle with sorted columns, each beginning with its diagonal") {
  const ConformalEnergy energy = Patch(perforated_grid(6, 6)).energy(Weights::inverse_area);
  const HermitianMatrix& matrix = energy.matrix();
  CHECK(matrix.isCompressed());
  for (int column = 0; column < matrix.cols(); ++column) {
    int last = column - 1;
    for (HermitianMatrix::InnerIterator it(matrix, column); it; ++it) {
      CHECK((last < column ? it.row() == column : it.row() > last));
      if (it.row() == column) CHECK(it.value().imag() == 0);
      last = static_cast<int>(it.row());
    }
  }
}

TEST_CASE("uniform weights: imaginary parts remain on boundary edges only") {
  const Patch patch(perforated_grid(6, 6));
  const ConformalEnergy energy = patch.energy(Weights::uniform);
  const HermitianMatrix matrix = energy.matrix();
  int count = 0;
  for (int column = 0; column < energy.n_vertices(); ++column) {
    for (HermitianMatrix::InnerIterator it(matrix, column); it; ++it) count += it.value().imag() != 0 ? 1 : 0;
  }
  std::size_t edges = 0;
  for (const auto& loop : patch.chart.boundary_loops) edges += loop.size();
  CHECK(count == static_cast<int>(edges));
}

TEST_CASE("z^H L z / 2 is the Dirichlet energy minus the area inside the boundary") {
  for (const auto& mesh : {bumpy_grid(6, 5), perforated_grid(7, 7)}) {
    const Patch patch(mesh);
    const ConformalEnergy energy = patch.energy(Weights::uniform);
    const ComplexVector z = random_map(patch.positions.rows());
    double dirichlet = 0;
    for (const auto& triangle : patch.chart.triangles) dirichlet += Gradients(patch.positions, triangle, z).dirichlet();
    double area = 0;
    for (const auto& loop : patch.chart.boundary_loops) area += shoelace_area(loop, z);
    const double expected = dirichlet - area;
    CHECK(0.5 * z.dot(dense(energy.matrix()) * z).real() == doctest::Approx(expected).epsilon(1e-12));
    CHECK(0.5 * energy.value(z) == doctest::Approx(expected).epsilon(1e-12));
    CHECK(0.5 * energy.area_form(z) == doctest::Approx(area).epsilon(1e-12));
  }
}

TEST_CASE("E_C equals the LSCM energy triangle by triangle, with the weights of section 4.1") {
  const Patch patch(bumpy_grid(4, 4));
  const ComplexVector z = random_map(patch.positions.rows());
  double weighted = 0;
  double mean_area = 0;
  for (const auto& triangle : patch.chart.triangles) {
    const Gradients gradients(patch.positions, triangle, z);
    const ConformalEnergy single =
        conformal_energy(patch.positions, {triangle}, std::vector<TriangleWeight>(1), Weights::uniform);
    CHECK(0.5 * single.value(z) == doctest::Approx(gradients.lscm()).epsilon(1e-12));
    CHECK(0.5 * z.dot(dense(single.matrix()) * z).real() == doctest::Approx(gradients.lscm()).epsilon(1e-12));
    weighted += gradients.lscm() / gradients.area;
    mean_area += gradients.area / static_cast<double>(patch.chart.triangles.size());
  }
  const ConformalEnergy energy = patch.energy(Weights::inverse_area);
  CHECK(energy.weight_unit() == doctest::Approx(mean_area).epsilon(1e-13));
  CHECK(0.5 * energy.value(z) == doctest::Approx(mean_area * weighted).epsilon(1e-12));
  CHECK(patch.energy(Weights::uniform).weight_unit() == 1);
}

TEST_CASE("value, apply and area_form agree with the matrix") {
  for (const auto weights : {Weights::uniform, Weights::inverse_area}) {
    const Patch patch(quads_and_triangles());
    const ConformalEnergy energy = patch.energy(weights);
    const Eigen::MatrixXcd matrix = dense(energy.matrix());
    const ComplexVector z = random_map(patch.positions.rows());
    CHECK(energy.value(z) == doctest::Approx(z.dot(matrix * z).real()).epsilon(1e-12));
    ComplexVector product;
    energy.apply(z, product);
    CHECK(difference(product, matrix * z) < 1e-13);
    // A_ij = -i Im L_ij
    const Eigen::MatrixXcd area = matrix.imag().cast<Complex>() * Complex(0, -1);
    CHECK(energy.area_form(z) == doctest::Approx(z.dot(area * z).real()).epsilon(1e-12));
    energy.apply(ComplexVector::Constant(z.size(), Complex(1e8, 3e7)), product);
    CHECK(product.norm() == 0);
  }
}

TEST_CASE("flat positions have energy 0, with either orientation of the axes' names; their mirror image has not") {
  for (const auto& mesh : {flat_grid(7, 6), quad_grid(5, 4)}) {
    const Patch patch(mesh);
    for (const auto weights : {Weights::uniform, Weights::inverse_area}) {
      const ConformalEnergy energy = patch.energy(weights);
      const ComplexVector z = flat_map(patch.positions);
      CHECK(energy.value(z) < 1e-26 * z.squaredNorm());
      CHECK(energy.value(z.conjugate()) > energy.area());
    }
  }
}

TEST_CASE("similarities of the surface leave the energy as it is, similarities of the map scale it") {
  const Patch patch(perforated_grid(7, 7));
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Vector(1, -2, 0.5).normalized()).toRotationMatrix();
  const Positions moved = (3.7 * patch.positions * turn.transpose()).rowwise() + Eigen::RowVector3d(4, -5, 6);
  const ComplexVector z = random_map(patch.positions.rows());
  for (const auto weights : {Weights::uniform, Weights::inverse_area}) {
    const ConformalEnergy energy = patch.energy(weights);
    const ConformalEnergy of_moved =
        conformal_energy(moved, patch.chart.triangles, patch.chart.triangle_weights, weights);
    CHECK((dense(of_moved.matrix()) - dense(energy.matrix())).norm() < 1e-12 * dense(energy.matrix()).norm());
    CHECK(of_moved.area() == doctest::Approx(3.7 * 3.7 * energy.area()).epsilon(1e-13));
    const Complex factor(0.3, -1.7);
    const ComplexVector similar = (factor * z).array() + Complex(5, 6);
    CHECK(energy.value(similar) == doctest::Approx(std::norm(factor) * energy.value(z)).epsilon(1e-12));
  }
}

TEST_CASE("a quad contributes the mean of its two splits") {
  const Mesh quad({{0, 0, 0}, {2, 0, 0.5}, {2.2, 1.4, 0}, {0.1, 1, 0.3}}, {{0, 1, 2, 3}});
  const Patch patch(quad);
  const auto split = [&](std::vector<std::array<int, 3>> triangles) {
    return dense(
        conformal_energy(patch.positions, std::move(triangles), std::vector<TriangleWeight>(2), Weights::uniform)
            .matrix());
  };
  const Eigen::MatrixXcd mean = 0.5 * (split({{0, 1, 2}, {0, 2, 3}}) + split({{0, 1, 3}, {1, 2, 3}}));
  CHECK((dense(patch.energy(Weights::uniform).matrix()) - mean).norm() < 1e-14);
}

TEST_CASE("columns of more than 32 entries are merged like the others") {
  constexpr int n = 60;
  Mesh fan;
  for (int i = 0; i < n; ++i) fan.points.emplace_back(std::cos(0.1 * i), std::sin(0.1 * i), 0.05 * (i % 5));
  fan.points.insert(fan.points.begin(), Vector(0, 0, 1));
  for (int i = 1; i < n; ++i) fan.add({0, i, i + 1});
  const Patch patch(fan);
  const ConformalEnergy energy = patch.energy(Weights::inverse_area);
  const ComplexVector z = random_map(n + 1);
  ComplexVector product;
  energy.apply(z, product);
  CHECK(difference(energy.matrix().selfadjointView<Eigen::Lower>() * z, product) < 1e-13);
  CHECK(energy.matrix().col(0).nonZeros() == n + 1);
}

TEST_CASE("nearly degenerate triangles are clamped, counted and leave the matrix finite") {
  Mesh mesh = flat_grid(3, 3);
  mesh.points[5] = mesh.points[6];
  const Patch patch(mesh);
  for (const auto weights : {Weights::uniform, Weights::inverse_area}) {
    const ConformalEnergy energy = patch.energy(weights);
    CHECK(energy.clamped_triangles() == 2);
    CHECK(dense(energy.matrix()).allFinite());
    double area = 0;
    for (const auto& [a, b, c] : patch.chart.triangles) {
      area += triangle_area(patch.positions.row(a), patch.positions.row(b), patch.positions.row(c));
    }
    CHECK(energy.area() == doctest::Approx(area).epsilon(1e-13));
  }
}

TEST_CASE("clamping gives thin triangles a height in the energy and leaves their measured shape alone") {
  Mesh mesh = flat_grid(3, 3);
  mesh.points[5] = mesh.points[6];
  const Patch patch(mesh);
  ConformalEnergy energy = patch.energy(Weights::uniform);
  const double largest = dense(energy.matrix()).cwiseAbs().maxCoeff();
  CHECK(largest > 1e9);
  CHECK(energy.clamp(1e-5) == 2);
  CHECK(energy.clamp(1e-5) == 0);
  CHECK(dense(energy.matrix()).cwiseAbs().maxCoeff() < 1.1e-5 * largest);
  CHECK(energy.clamped_triangles() == 2);
  const ComplexVector ones = ComplexVector::Ones(energy.n_vertices());
  ComplexVector product;
  energy.apply(ones, product);
  CHECK(product.norm() == 0);
  ConformalEnergy clean = Patch(flat_grid(3, 3)).energy(Weights::uniform);
  CHECK(clean.clamp(1e-5) == 0);
}

TEST_CASE("inverse-area weights of tiny and thin triangles are held back, those of others are not") {
  Mesh mesh = flat_grid(3, 3);
  const Patch clean(mesh);
  const HermitianMatrix before = clean.energy(Weights::inverse_area).matrix();
  mesh.points[5] = mesh.points[6] + Eigen::Vector3d(0, 1e-8, 0);
  const Patch patch(mesh);
  const ConformalEnergy energy = patch.energy(Weights::inverse_area);
  REQUIRE(energy.clamped_triangles() == 0);
  CHECK(dense(energy.matrix()).cwiseAbs().maxCoeff() < 1e13);
  CHECK(dense(energy.matrix()).cwiseAbs().maxCoeff() > 1e11);
  // Triangles of aspect 1e5 keep their weight: L is that of the formula.
  mesh.points[5] = mesh.points[6] + Eigen::Vector3d(0, 1e-5, 0);
  const Patch thin(mesh);
  const ConformalEnergy weighted = thin.energy(Weights::inverse_area);
  double largest = 0;
  for (const auto& [a, b, c] : thin.chart.triangles) {
    const double area =
        triangle_area(thin.positions.row(a), thin.positions.row(b), thin.positions.row(c)) / weighted.weight_unit();
    const double longest = std::max({(thin.positions.row(a) - thin.positions.row(b)).squaredNorm(),
                                     (thin.positions.row(b) - thin.positions.row(c)).squaredNorm(),
                                     (thin.positions.row(c) - thin.positions.row(a)).squaredNorm()});
    largest = std::max(largest, longest / (4 * area * weighted.weight_unit()) / area);
  }
  CHECK(dense(weighted.matrix()).cwiseAbs().maxCoeff() > 0.5 * largest);
}

TEST_CASE("with the metric of a map the energy of that map vanishes, and its area does not change") {
  const Patch patch(quads_and_triangles());
  const ComplexVector flat = flat_map(patch.positions);
  ComplexVector map = flat;
  for (Complex& z : map) z = Complex(2 * z.real() + 0.3 * z.imag() + 0.02 * z.real() * z.imag(), 0.7 * z.imag());
  for (const auto weights : {Weights::uniform, Weights::inverse_area}) {
    ConformalEnergy energy = patch.energy(weights);
    const double plain = energy.value(map);
    const double area = energy.area_form(map);
    std::vector<TriangleMetric> metric;
    for (std::size_t t = 0; t < energy.triangles().size(); ++t) {
      const auto& [a, b, c] = energy.triangles()[t];
      metric.push_back(metric_of_map(energy.shapes()[t], map[b] - map[a], map[c] - map[a]));
    }
    energy.stretch(metric);
    CHECK(energy.value(map) < 1e-26 * plain);
    CHECK(energy.area_form(map) == area);
    CHECK(energy.value(flat) > 1e-3 * plain);
    const ComplexVector z = random_map(map.size());
    CHECK(z.dot(dense(energy.matrix()) * z).real() == doctest::Approx(energy.value(z)).epsilon(1e-12));
    // Other weights keep the metric.
    const ConformalEnergy other = energy.with(Weights::uniform);
    CHECK(other.value(map) < 1e-26 * plain);
    // A second metric comes on top: the identity changes nothing.
    energy.stretch(std::vector<TriangleMetric>(metric.size()));
    CHECK(energy.value(z) == doctest::Approx(z.dot(dense(energy.matrix()) * z).real()).epsilon(1e-12));
    CHECK(energy.value(map) < 1e-26 * plain);
  }
}

TEST_CASE("a triangle with a vertex twice adds no entry beside the diagonal, and the matrix is that of its energy") {
  // Found by libFuzzer: such a column held its diagonal entry twice.
  Positions positions(4, 3);
  positions << 0, 0, 0, 2, 0, 0, 1, 1, 0, 0, 1, 1;
  const ConformalEnergy energy = conformal_energy(positions, {{0, 1, 2}, {0, 2, 3}, {1, 2, 2}, {3, 0, 3}},
                                                  std::vector<TriangleWeight>(4), Weights::uniform);
  const HermitianMatrix& matrix = energy.matrix();
  for (int column = 0; column < 4; ++column) {
    int last = -1;
    for (HermitianMatrix::InnerIterator entry(matrix, column); entry; ++entry) {
      CHECK(entry.row() == (last < 0 ? column : std::max(last + 1, static_cast<int>(entry.row()))));
      last = static_cast<int>(entry.row());
    }
  }
  for (unsigned seed = 1; seed < 4; ++seed) {
    const ComplexVector z = random_map(4, seed);
    const ComplexVector product = matrix.selfadjointView<Eigen::Lower>() * z;
    CHECK(z.dot(product).real() == doctest::Approx(energy.value(z)));
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
