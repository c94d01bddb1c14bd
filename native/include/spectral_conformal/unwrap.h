#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "spectral_conformal/parameterize.h"
#include "spectral_conformal/polygon_mesh.h"

namespace spectral_conformal {

class KeptMaps;

/// An extender (section 4.2) between two mesh vertices. It acts in every chart that has copies of both. Where a seam
/// gives a vertex several copies in one chart, it acts on their barycenter, so symmetric meshes keep symmetric maps.
struct VertexExtender {
  int from = 0;
  int to = 0;
  double strength = 0;  ///< see Extender
  double half = 1;
};

/// The options of an unwrap.
struct UnwrapOptions {
  PatchOptions patch;
  SolveOptions solve;  ///< its extenders and constraints are ignored
  /// On corners instead of vertices. An equation with corners in several charts, or in none, has no effect.
  LinearEquations constraints;
  std::vector<VertexExtender> extenders;
  Pins vertex_pins;
  CornerPins corner_pins;
  /// (n_faces,) metric of each face, positive definite on tangent vectors (section 4.3), or null.
  const SpaceMetric* metric = nullptr;
};

/// One chart of an unwrap. For a failed chart the record says what was to be solved, and the last of `steps` why
/// it failed.
struct UnwrappedChart : SolveRecord {
  std::vector<int> faces;  ///< in the mesh, ascending
  bool solved = false;
  double mean_qc = unmeasured;  ///< see measure_distortion
  double max_qc = unmeasured;   ///< largest of a face, see measure_face_distortion
  int flipped = 0;              ///< faces with a flipped triangle; -1 if solved and not measured
  int overlapping = 0;          ///< faces that cover part of another face, duplicates aside; -1 likewise
  int n_pins = 0;               ///< pinned vertices
  int n_vertices = 0;
  double area = 0;                          ///< in 3D
  double image_area = unmeasured;           ///< of its faces in the map, each unsigned, duplicates aside
  Complex low = {unmeasured, unmeasured};   ///< corner of the map's bounding box with the least coordinates
  Complex high = {unmeasured, unmeasured};  ///< the opposite corner
  bool reused = false;                      ///< whether its map comes from KeptMaps

  UnwrappedChart() {
    eigenvalue = residual = unmeasured;
    attempts = 0;
  }
};

struct Unwrap {
  Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor> uv;  ///< (C, 2), 0 where not solved
  std::vector<bool> solved_corners;                              ///< (C,)
  std::vector<int> chart_of_face;                                ///< (n_faces,)
  /// (C,) the chart vertex of each corner, numbered chart after chart, so that charts[k] begins after the n_vertices of
  /// those before it; -1 where not solved. Corners with the same one have the same UV.
  std::vector<int> vertex_of_corner;
  std::vector<UnwrappedChart> charts;
  /// (n extenders,) whether the extender had no effect: no solved chart has its two vertices as distinct ones, or pins
  /// hold the chart.
  std::vector<bool> unused_extenders;
  /// Seconds per phase, in order, summed over the charts (several may be solved in parallel).
  std::vector<std::pair<std::string, double>> timings;
};

/// Cuts a polygon mesh into charts and parameterizes each. A chart that fails never stops the others: it is reported as
/// failed, also for lack of memory, unless memory is too small for every chart. All degenerate faces form one failed
/// chart, the last. Each chart is placed by place(). Vertex pins hold all copies of their mesh vertex; corner pins take
/// precedence. A chart with several pins is solved by pinned LSCM, or, with solve.soft_pins, by the spectral method
/// with attraction. A chart with one pin is solved free and moved onto it. With `kept`, maps found there are reused and
/// new maps are stored there; only timings and UnwrappedChart::reused show the difference. Throws InvalidMesh for
/// arrays that do not describe a mesh, Cancelled, and std::bad_alloc where memory is too small for the mesh or for
/// every chart.
Unwrap unwrap(const PolygonMesh& mesh, const UnwrapOptions& options, const Progress& progress,
              KeptMaps* kept = nullptr);

/// The same for several solves that differ in extenders, hole rigidity, tolerance and the positions of pins: keeps the
/// charts and their factors. Earlier solves affect a result no more than in Solver::solve.
class Unwrapper {
 public:
  /// The arrays of `mesh` and `options` must outlive this object and must not change: some are read again later. Throws
  /// InvalidMesh as unwrap does.
  static Unwrapper of(const PolygonMesh& mesh, const UnwrapOptions& options);
  ~Unwrapper();
  Unwrapper(Unwrapper&& other) noexcept;

  /// corner_uv: new positions of the pinned corners, (C, 2), or null for the given ones. The set of pinned corners, and
  /// which of them share a vertex, must not change. A chart with a pin that is not finite fails. measures: whether to
  /// measure distortion, flips and overlaps of the maps, which may take longer than a solve with moved pins.
  Unwrap solve(const std::vector<VertexExtender>& extenders, std::optional<double> hole_rigidity, double tolerance,
               const double* corner_uv, const Progress& progress, bool measures = true);

 private:
  struct State;
  explicit Unwrapper(std::unique_ptr<State> state);

  std::unique_ptr<State> state_;
};

}  // namespace spectral_conformal
