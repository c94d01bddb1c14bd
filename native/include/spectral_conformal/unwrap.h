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

/// An extender (section 4.2) between two mesh vertices. It acts in every chart that has copies of both; where a seam
/// gives a vertex several copies in one chart, on their barycenter, so that symmetric meshes keep symmetric maps.
struct VertexExtender {
  int from = 0;
  int to = 0;
  double strength = 0;  ///< see Extender
};

/// What an unwrap takes besides the mesh.
struct UnwrapOptions {
  PatchOptions patch;
  SolveOptions solve;  ///< its extenders are ignored
  std::vector<VertexExtender> extenders;
  Pins vertex_pins;
  CornerPins corner_pins;
  /// (n_faces,) symmetric positive definite on tangent vectors, or null: the metric of each face (section 4.3).
  const SpaceMetric* metric = nullptr;
};

/// One chart of an unwrap. Of a failed one the record says what was to be solved, and `problem` or the last of `steps`
/// why it failed.
struct UnwrappedChart : SolveRecord {
  /// Not a number: what a failed chart has no value for.
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  std::vector<int> faces;  ///< in the mesh, ascending
  bool solved = false;
  double mean_qc = unknown;  ///< as measure_distortion finds it
  double max_qc = unknown;   ///< the largest of a face, as measure_face_distortion finds it
  int flipped = 0;           ///< faces with a flipped triangle
  int overlapping = 0;       ///< faces that cover part of another face; duplicates are ignored
  int n_pins = 0;            ///< pinned vertices
  int n_vertices = 0;
  double area = 0;      ///< in 3D
  std::string problem;  ///< the condition that its faces or pins break, as InvalidMesh has it; empty where none
  bool reused = false;  ///< whether its map was taken from KeptMaps

  UnwrappedChart() {
    eigenvalue = residual = unknown;
    attempts = 0;
  }
};

struct Unwrap {
  Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor> uv;  ///< (C, 2), 0 where not solved
  std::vector<bool> solved_corners;                              ///< (C,)
  std::vector<int> chart_of_face;                                ///< (n_faces,)
  std::vector<UnwrappedChart> charts;
  /// (n extenders,) those without effect: no solved chart has both vertices as different ones, or it is held by its
  /// pins.
  std::vector<bool> unused_extenders;
  /// Seconds per phase, in order, summed up over the charts, of which several may be solved at once.
  std::vector<std::pair<std::string, double>> timings;
};

/// Cuts a polygon mesh into charts and parameterizes each. What one chart cannot do never stops the others: it is
/// reported as failed, also where there is too little memory for it, unless that is so of all charts; degenerate faces
/// together make one failed chart, the last. Each chart is placed as by place().
/// Pins are those of mesh vertices, on all of their copies, and of corners (which win). A chart with several is solved
/// by pinned LSCM, or, with solve.soft_pins, by the spectral method attracted by them; with one it is solved free and
/// moved onto the pin. With `kept`, charts whose maps are there are not solved, and the maps of the others go there;
/// only timings and UnwrappedChart::reused tell the difference. Throws InvalidMesh for arrays that do not describe a
/// mesh, Cancelled, and std::bad_alloc where there is too little memory for the mesh, or for any of its charts.
Unwrap unwrap(const PolygonMesh& mesh, const UnwrapOptions& options, const Progress& progress,
              KeptMaps* kept = nullptr);

/// The same for several solves that differ in extenders, hole rigidity and tolerance: keeps the charts and their
/// factors. What was solved before counts as little as in Solver::solve.
class Unwrapper {
 public:
  /// The arrays of `mesh` and `options` must outlive this object and not change meanwhile: some are read again later.
  /// Throws InvalidMesh as unwrap does.
  Unwrapper(const PolygonMesh& mesh, const UnwrapOptions& options);
  ~Unwrapper();
  Unwrapper(const Unwrapper&) = delete;
  Unwrapper& operator=(const Unwrapper&) = delete;

  Unwrap solve(const std::vector<VertexExtender>& extenders, std::optional<double> hole_rigidity, double tolerance,
               const Progress& progress);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace spectral_conformal
