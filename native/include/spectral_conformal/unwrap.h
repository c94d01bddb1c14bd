#pragma once

#include <limits>
#include <string>

#include "spectral_conformal/charts.h"
#include "spectral_conformal/corner_pins.h"
#include "spectral_conformal/parameterize.h"

namespace spectral_conformal {

struct UnwrappedChart {
  /// Not a number: what a failed chart has no value for.
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  std::vector<int> faces;  ///< in the mesh, ascending
  bool solved = false;
  std::string message;  ///< why it failed and what to do, or what had to be done to solve it; may be empty
  double eigenvalue = unknown;
  double residual = unknown;
  int iterations = 0;
  int turning_number = 0;
  double mean_qc = unknown;  ///< of one triangulation: of a quad's two splits the less distorted one
  double max_qc = unknown;
  int flipped = 0;                   ///< faces with a flipped triangle
  Method method = Method::spectral;  ///< the one used: Method::lscm for a chart with several pins
  int n_pins = 0;                    ///< pinned vertices
  int n_vertices = 0;
  double area = 0;  ///< in 3D
};

struct Unwrap {
  Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor> uv;  ///< (C, 2), 0 where not solved
  std::vector<bool> solved_corners;                              ///< (C,)
  std::vector<int> chart_of_face;                                ///< (n_faces,)
  std::vector<UnwrappedChart> charts;
};

/// Cuts a polygon mesh into charts and parameterises each. What one chart cannot do never stops the others: it is
/// reported as failed; degenerate faces together make one failed chart, the last. Each chart is placed as by place().
/// Pins are those of mesh vertices, on all of their copies, and of corners (which win). A chart with several is solved
/// by pinned LSCM, or, with options.soft_pins, by the spectral method attracted by them; with one it is solved free and
/// moved onto the pin. Throws InvalidMesh for arrays that do not describe a mesh, and Cancelled.
Unwrap unwrap(const PolygonMesh& mesh, const ParameterizeOptions& options, const Pins& vertex_pins,
              const CornerPins& corner_pins, const Progress& progress);

}  // namespace spectral_conformal
