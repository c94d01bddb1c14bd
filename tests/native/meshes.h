#pragma once

#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

#include "conformal/conformal_energy.h"
#include "linear_algebra/factorization.h"
#include "linear_algebra/symbolic_factor.h"
#include "mesh/charts.h"
#include "relaxation/distortion_energy.h"

namespace spectral_conformal::test {

/// A polygon mesh that owns its arrays.
struct Mesh {
  std::vector<Eigen::Vector3d> points;
  std::vector<int> offsets{0};
  std::vector<int> corners;
  std::vector<std::array<int, 2>> seams;

  Mesh() = default;
  Mesh(std::vector<Eigen::Vector3d> vertices, std::initializer_list<std::vector<int>> faces);
  void add(const std::vector<int>& face);
  void append(const Mesh& other);
  void reverse(int face);
  int n_faces() const { return static_cast<int>(offsets.size()) - 1; }
  /// Valid while the mesh is neither changed nor destroyed.
  PolygonMesh view() const;
};

/// A mesh that is one disk-like patch.
struct Patch {
  Chart chart;
  Positions positions;
  explicit Patch(const Mesh& mesh);
  ConformalEnergy energy(Weights weights) const {
    return conformal_energy(positions, chart.triangles, chart.triangle_weights, weights);
  }
  std::vector<DistortionElement> elements() const;
  /// The longest loop.
  const BoundaryLoop& outer() const;
};

/// Triangles on the rectangle columns x rows (cells of size 1), moved irregularly within the plane.
Mesh flat_grid(int columns, int rows);
/// The same with bumps, so that no conformal map of it is an isometry. No symmetry.
Mesh bumpy_grid(int columns, int rows);
/// A saddle over n x n vertices, rounded to multiples of `unit`: triangles without area, vertices that coincide.
Mesh rounded_grid(int n, double unit);
/// A bumpy grid without the cells (1 + 3 i, 1 + 3 j): (columns / 3) x (rows / 3) holes.
Mesh perforated_grid(int columns, int rows);
/// Quads on the flat grid of unit cells.
Mesh quad_grid(int columns, int rows);
/// Quads of a 3 x 3 grid that form a ring closed at vertex 10 only: one chart with two copies of it.
Mesh pinched_ring();
/// A strip of quads around a ring, closed with the given number of half twists.
Mesh ring(int segments, int half_twists);
/// A grid of quads, periodic in both directions, bent to a torus.
Mesh torus(int around, int across);
Mesh tetrahedron();

/// The surface of those unit cells of an n x n x n grid that `filled(i, j, k)` names: quads, outward.
Mesh cell_surface(int n, const std::function<bool(int, int, int)>& filled);
/// A cube of n x n x n cells blown up to a unit sphere.
Mesh sphere(int n);
/// A plate of cells with two square holes: genus 2, and its own mirror image in x, y and z.
Mesh double_torus();
/// A grid of quads with `n_spikes` spikes on a line, each as high as wide; its own mirror image in x.
Mesh spiky_grid(int n_spikes, double height);

/// Deterministic numbers in the square (-1, 1) x (-1, 1), the same on every platform.
ComplexVector random_map(Eigen::Index n, unsigned seed = 1);
/// The first two coordinates.
ComplexVector flat_map(const Positions& positions);
Eigen::MatrixXcd dense(const HermitianMatrix& matrix);
/// |a - b| / |b|.
double difference(const ComplexVector& a, const ComplexVector& b);
/// The same after a similarity has taken b as near to a as possible.
double difference_up_to_similarity(const ComplexVector& a, const ComplexVector& b);
/// The area inside a loop of the map, positive when it runs counterclockwise.
double shoelace_area(const BoundaryLoop& loop, const ComplexVector& z);

/// The chart of a mesh that has one.
Chart only_chart(const Mesh& mesh);

/// The least conformal map by the default method.
ComplexVector conformal_map(const Patch& patch);
/// Triangles of the chart, of quads those of both splits, whose image is not counterclockwise.
int count_flipped(const Patch& patch, const ComplexVector& z);
double energy_of(const std::vector<DistortionElement>& elements, DistortionMeasure measure, const ComplexVector& z);
/// L + 0.01 I of a perforated grid: positive definite, complex away from the boundary too.
HermitianMatrix shifted_energy(int size);
/// Every fifth row of a square grid of n vertices last: what lies between falls apart into subtrees.
std::vector<int> strips_first(int n);
/// The rows of each column of the factor by eliminating on sets; a column joins the one before where only that one's
/// own row is missing from it.
SupernodalStructure structure_of(const HermitianMatrix& matrix, const std::vector<int>& order);

/// The backends of this build.
std::vector<FactorizationBackend> backends();

}  // namespace spectral_conformal::test
