#include "meshes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <stdexcept>
#include <utility>

#include "mesh/boundary_loops.h"
#include "mesh/chart_checks.h"
#include "relaxation/distortion_sum.h"
#include "spectral_conformal/parameterize.h"

namespace spectral_conformal::test {
namespace {

/// A grid of points, each moved by up to 0.25 within the plane and lifted by `height` (x, y).
template <class Height>
Mesh grid_points(int columns, int rows, Height&& height) {
  Mesh mesh;
  const ComplexVector moves = random_map(static_cast<Eigen::Index>(columns + 1) * (rows + 1), 7);
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      const Complex p = Complex(i, j) + 0.25 * moves[static_cast<Eigen::Index>(mesh.points.size())];
      mesh.points.emplace_back(p.real(), p.imag(), height(p.real(), p.imag()));
    }
  }
  return mesh;
}

template <class Keep>
void add_triangles(Mesh& mesh, int columns, int rows, Keep&& keep) {
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      if (!keep(i, j)) continue;
      const int a = j * (columns + 1) + i;
      const int b = a + 1;
      const int c = b + columns + 1;
      const int d = c - 1;
      if ((i + j) % 2 == 0) {
        mesh.add({a, b, c});
        mesh.add({a, c, d});
      } else {
        mesh.add({a, b, d});
        mesh.add({b, c, d});
      }
    }
  }
}

double bumps(double x, double y) { return 0.8 * std::sin(0.9 * x) * std::cos(0.7 * y + 0.3) + 0.02 * x * y; }

}  // namespace

Mesh::Mesh(std::vector<Eigen::Vector3d> vertices, std::initializer_list<std::vector<int>> faces)
    : points(std::move(vertices)) {
  for (const auto& face : faces) add(face);
}

void Mesh::add(const std::vector<int>& face) {
  corners.insert(corners.end(), face.begin(), face.end());
  offsets.push_back(static_cast<int>(corners.size()));
}

void Mesh::append(const Mesh& other) {
  const int first_point = static_cast<int>(points.size());
  points.insert(points.end(), other.points.begin(), other.points.end());
  for (int f = 0; f < other.n_faces(); ++f) {
    std::vector<int> face(other.corners.begin() + other.offsets[f], other.corners.begin() + other.offsets[f + 1]);
    for (int& v : face) v += first_point;
    add(face);
  }
}

void Mesh::reverse(int face) { std::reverse(corners.begin() + offsets[face], corners.begin() + offsets[face + 1]); }

PolygonMesh Mesh::view() const {
  PolygonMesh mesh;
  mesh.positions = points.empty() ? nullptr : points.front().data();
  mesh.n_vertices = static_cast<int>(points.size());
  mesh.face_offsets = offsets.data();
  mesh.n_faces = n_faces();
  mesh.corner_vertices = corners.data();
  mesh.seam_edges = seams.data();
  mesh.n_seam_edges = static_cast<int>(seams.size());
  return mesh;
}

std::vector<DistortionElement> Patch::elements() const {
  const ConformalEnergy uniform = energy(Weights::uniform);
  return distortion_elements(uniform.triangles(), uniform.shapes(), uniform.triangle_weights(), 0);
}

Patch::Patch(const Mesh& mesh) : chart(single_chart(mesh.view())), positions(chart.positions(mesh.view())) {}

const BoundaryLoop& Patch::outer() const { return chart.boundary_loops[outer_loop(chart.boundary_loops, positions)]; }

Mesh flat_grid(int columns, int rows) {
  Mesh mesh = grid_points(columns, rows, [](double, double) { return 0.0; });
  add_triangles(mesh, columns, rows, [](int, int) { return true; });
  return mesh;
}

Mesh bumpy_grid(int columns, int rows) {
  Mesh mesh = grid_points(columns, rows, bumps);
  add_triangles(mesh, columns, rows, [](int, int) { return true; });
  return mesh;
}

Mesh rounded_grid(int n, double unit) {
  Mesh mesh;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double x = static_cast<double>(i) / (n - 1);
      const double y = static_cast<double>(j) / (n - 1);
      const Eigen::Vector3d point(x, y, 0.3 * std::sin(3 * x) * std::cos(2 * y));
      mesh.points.push_back(unit * (point / unit).array().round().matrix());
    }
  }
  for (int i = 0; i + 1 < n; ++i) {
    for (int j = 0; j + 1 < n; ++j) {
      const int a = n * i + j;
      mesh.add({a, a + n, a + n + 1});
      mesh.add({a, a + n + 1, a + 1});
    }
  }
  return mesh;
}

Mesh perforated_grid(int columns, int rows) {
  Mesh mesh = grid_points(columns, rows, bumps);
  add_triangles(mesh, columns, rows, [](int i, int j) { return i % 3 != 1 || j % 3 != 1; });
  return mesh;
}

Mesh quad_grid(int columns, int rows) {
  Mesh mesh;
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) mesh.points.emplace_back(i, j, 0);
  }
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const int a = j * (columns + 1) + i;
      mesh.add({a, a + 1, a + columns + 2, a + columns + 1});
    }
  }
  return mesh;
}

Mesh pinched_ring() {
  Mesh pinched = quad_grid(3, 3);
  pinched.offsets = {0};
  pinched.corners.clear();
  for (const auto& quad : {std::vector<int>{0, 1, 5, 4},
                           {1, 2, 6, 5},
                           {2, 3, 7, 6},
                           {6, 7, 11, 10},
                           {4, 5, 9, 8},
                           {8, 9, 13, 12},
                           {9, 10, 14, 13}}) {
    pinched.add(quad);
  }
  return pinched;
}

Mesh ring(int segments, int half_twists) {
  Mesh mesh;
  for (int i = 0; i < segments; ++i) {
    const double angle = 2 * pi * i / segments;
    const double twist = half_twists * angle / 2;
    for (const double side : {-0.3, 0.3}) {
      const double radius = 1 + side * std::sin(twist);
      mesh.points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), side * std::cos(twist));
    }
  }
  for (int i = 0; i < segments; ++i) {
    const int low = 2 * i;
    const bool crossed = i + 1 == segments && half_twists % 2 != 0;
    const int next = 2 * ((i + 1) % segments);
    mesh.add({low, crossed ? next + 1 : next, crossed ? next : next + 1, low + 1});
  }
  return mesh;
}

Mesh torus(int around, int across) {
  Mesh mesh;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const double a = 2 * pi * i / around;
      const double b = 2 * pi * j / across;
      mesh.points.emplace_back((2 + std::cos(b)) * std::cos(a), (2 + std::cos(b)) * std::sin(a), std::sin(b));
    }
  }
  const auto index = [&](int i, int j) { return i % around * across + j % across; };
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) mesh.add({index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)});
  }
  return mesh;
}

Mesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

Mesh cell_surface(int n, const std::function<bool(int, int, int)>& filled) {
  Mesh mesh;
  std::map<std::array<int, 3>, int> index;
  const auto inside = [&](const std::array<int, 3>& c) {
    return std::all_of(c.begin(), c.end(), [&](int x) { return x >= 0 && x < n; }) && filled(c[0], c[1], c[2]);
  };
  const auto add_side = [&](const std::array<int, 3>& cell, int axis, int upper) {
    std::vector<int> face;
    for (const auto& [du, dv] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
      std::array<int, 3> p = cell;
      p[axis] += upper;
      p[(axis + 1) % 3] += du;
      p[(axis + 2) % 3] += dv;
      const auto [place, is_new] = index.emplace(p, static_cast<int>(mesh.points.size()));
      if (is_new) mesh.points.emplace_back(p[0], p[1], p[2]);
      face.push_back(place->second);
    }
    if (upper == 0) std::reverse(face.begin(), face.end());
    mesh.add(face);
  };
  for (int c = 0; c < n * n * n; ++c) {
    const std::array<int, 3> cell{c % n, c / n % n, c / (n * n)};
    if (!inside(cell)) continue;
    for (int axis = 0; axis < 3; ++axis) {
      for (const int upper : {0, 1}) {
        std::array<int, 3> other = cell;
        other[axis] += upper == 1 ? 1 : -1;
        if (!inside(other)) add_side(cell, axis, upper);
      }
    }
  }
  return mesh;
}

Mesh sphere(int n) {
  Mesh mesh = cell_surface(n, [](int, int, int) { return true; });
  for (Eigen::Vector3d& p : mesh.points) p = (p.array() - 0.5 * n).matrix().normalized();
  return mesh;
}

Mesh double_torus() {
  return cell_surface(14, [](int i, int j, int k) {
    const bool hole = j >= 2 && j < 6 && ((i >= 2 && i < 6) || (i >= 8 && i < 12));
    return j < 8 && k < 3 && !hole;
  });
}

Mesh spiky_grid(int n_spikes, double height) {
  Mesh mesh = quad_grid(8 * n_spikes, 8);
  for (Eigen::Vector3d& p : mesh.points) {
    const double across = std::fmod(p.x(), 8.0) - 4;
    const double distance = std::hypot(across, p.y() - 4);
    if (distance < 3) p.z() = height * (1 - distance / 3);
  }
  return mesh;
}

ComplexVector random_map(Eigen::Index n, unsigned seed) {
  std::mt19937_64 engine(seed);
  const auto number = [&] { return static_cast<double>(engine() >> 11) * 0x1.0p-52 - 1.0; };
  ComplexVector z(n);
  for (Complex& entry : z) {
    const double real = number();
    entry = Complex(real, number());
  }
  return z;
}

ComplexVector flat_map(const Positions& positions) {
  return positions.col(0).cast<Complex>() + Complex(0, 1) * positions.col(1).cast<Complex>();
}

Eigen::MatrixXcd dense(const HermitianMatrix& matrix) {
  return Eigen::MatrixXcd(Eigen::MatrixXcd(matrix).selfadjointView<Eigen::Lower>());
}

double difference(const ComplexVector& a, const ComplexVector& b) { return (a - b).norm() / b.norm(); }

double difference_up_to_similarity(const ComplexVector& a, const ComplexVector& b) {
  const ComplexVector from = b.array() - b.mean();
  const ComplexVector to = a.array() - a.mean();
  return (to - from.dot(to) / from.squaredNorm() * from).norm() / to.norm();
}

double shoelace_area(const BoundaryLoop& loop, const ComplexVector& z) {
  double area = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    area += 0.5 * std::imag(std::conj(z[loop[i]]) * z[loop[(i + 1) % loop.size()]]);
  }
  return area;
}

std::vector<FactorizationBackend> backends() {
#ifdef SPECTRAL_CONFORMAL_HAVE_CHOLMOD
  return {FactorizationBackend::cholmod, FactorizationBackend::eigen};
#else
  return {FactorizationBackend::eigen};
#endif
}

Chart only_chart(const Mesh& mesh) {
  std::vector<Chart> charts = build_charts(mesh.view()).charts;
  if (charts.size() != 1) throw std::invalid_argument("not one chart, but " + std::to_string(charts.size()));
  return std::move(charts.front());
}

ComplexVector conformal_map(const Patch& patch) {
  return Solver::of(patch.chart, patch.positions, PatchOptions{}).solve({}, {}).z;
}

int count_flipped(const Patch& patch, const ComplexVector& z) {
  return static_cast<int>(
      std::count_if(patch.chart.triangles.begin(), patch.chart.triangles.end(), [&](const auto& triangle) {
        return !(std::imag(std::conj(z[triangle[1]] - z[triangle[0]]) * (z[triangle[2]] - z[triangle[0]])) > 0);
      }));
}

double energy_of(const std::vector<DistortionElement>& elements, DistortionMeasure measure, const ComplexVector& z) {
  ComplexVector gradient;
  return DistortionSum::of(elements, measure, z.size()).value_and_gradient(z, gradient);
}

HermitianMatrix shifted_energy(int size) {
  HermitianMatrix matrix = Patch(perforated_grid(size, size)).energy(Weights::inverse_area).matrix();
  for (int v = 0; v < matrix.cols(); ++v) matrix.coeffRef(v, v) += 0.01;
  return matrix;
}

std::vector<int> strips_first(int n) {
  const int width = static_cast<int>(std::lround(std::sqrt(n)));
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::stable_partition(order.begin(), order.end(), [width](int v) { return v / width % 5 != 4; });
  return order;
}

SupernodalStructure structure_of(const HermitianMatrix& matrix, const std::vector<int>& order) {
  const int n = static_cast<int>(order.size());
  std::vector<int> place(n);
  for (int i = 0; i < n; ++i) place[order[i]] = i;
  std::vector<std::set<int>> below(n);
  for (int column = 0; column < n; ++column) {
    for (HermitianMatrix::InnerIterator it(matrix, column); it; ++it) {
      const int a = place[it.row()];
      const int b = place[column];
      if (a != b) below[std::min(a, b)].insert(std::max(a, b));
    }
  }
  for (int i = 0; i < n; ++i) {
    if (below[i].empty()) continue;
    const int parent = *below[i].begin();
    below[parent].insert(std::next(below[i].begin()), below[i].end());
  }
  SupernodalStructure result;
  result.order = order;
  result.first_row.push_back(0);
  for (int i = 0; i < n; ++i) {
    const bool joins = i > 0 && below[i - 1].count(i) == 1 && below[i - 1].size() == below[i].size() + 1;
    if (joins) continue;
    result.first_column.push_back(i);
  }
  result.first_column.push_back(n);
  for (std::size_t k = 0; k + 1 < result.first_column.size(); ++k) {
    const int first = result.first_column[k];
    result.rows.push_back(first);
    result.rows.insert(result.rows.end(), below[first].begin(), below[first].end());
    result.first_row.push_back(static_cast<std::ptrdiff_t>(result.rows.size()));
  }
  return result;
}

}  // namespace spectral_conformal::test
