#include "spectral_conformal/unwrap.h"

#include <algorithm>

#include "spectral_conformal/distortion.h"

namespace spectral_conformal {
namespace {

std::string count(int n, const char* one, const char* many) { return std::to_string(n) + " " + (n == 1 ? one : many); }

/// What was done to the chart's faces before it could be solved; "" for a clean chart.
std::string repairs(const Chart& chart, int clamped) {
  std::string text;
  if (chart.reversed_faces > 0) {
    text += count(chart.reversed_faces, "face", "faces") + " wound the other way: turned. ";
  }
  if (!chart.duplicates.empty()) {
    text += count(static_cast<int>(chart.duplicates.size()), "duplicate face", "duplicate faces") +
            ": placed on the first of the same vertices. ";
  }
  if (chart.self_intersecting_polygons > 0) {
    text += count(chart.self_intersecting_polygons, "self-intersecting polygon", "self-intersecting polygons") +
            ": split as a fan. ";
  }
  if (clamped > 0) text += count(clamped, "degenerate triangle", "degenerate triangles") + ": given a minimal height. ";
  return text;
}

/// One triangulation of the chart to report on: where the energy has both splits of a quad, the one that is distorted
/// less. (A symmetric map can collapse a triangle of the other.)
struct Triangulation {
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> face;  ///< index into the chart's faces
};

Triangulation better_splits(const Chart& chart, const Eigen::VectorXd& qc) {
  Triangulation result;
  const auto take = [&](std::size_t t) {
    result.triangles.push_back(chart.triangles[t]);
    result.face.push_back(chart.triangle_face[t]);
  };
  for (std::size_t t = 0; t < chart.triangles.size(); ++t) {
    if (chart.coverage[t] == 1.0) {
      take(t);
      continue;
    }
    const auto worst = [&](std::size_t first) {
      const auto i = static_cast<Eigen::Index>(first);
      return std::max(qc[i], qc[i + 1]);
    };
    const std::size_t better = worst(t) <= worst(t + 2) ? t : t + 2;
    take(better);
    take(better + 1);
    t += 3;  // triangulate_polygon puts the four triangles of the two splits in a row
  }
  return result;
}

/// The pins of the mesh on the copies that a chart has of their vertices.
Pins pins_of(const Chart& chart, const Pins& pins) {
  Pins result;
  if (pins.empty()) return result;
  for (int v = 0; v < chart.n_vertices(); ++v) {
    const auto pin = pins.find(chart.vertices[v]);
    if (pin != pins.end()) result[v] = pin->second;
  }
  return result;
}

/// Solves one chart and fills in its report; the map goes to `z`.
void solve_chart(const PolygonMesh& mesh, const Chart& chart, const ParameterizeOptions& options, const Pins& pins,
                 const Progress& progress, UnwrappedChart& report, ComplexVector& z) {
  const Positions positions = chart.positions(mesh);
  try {
    Solver solver(chart, positions, options.weights, options.boundary, options.backend);
    Parameterization solution = solver.solve(options.method, pins_of(chart, pins), options.tolerance, progress);
    z = std::move(solution.z);
    report.solved = true;
    report.message = solution.message + repairs(chart, solver.energy().clamped_triangles());
    if (!report.message.empty()) report.message.pop_back();
    report.eigenvalue = solution.eigenvalue;
    report.residual = solution.residual;
    report.iterations = solution.iterations;
    report.turning_number = solution.turning_number;
  } catch (const InvalidMesh& problem) {
    report.message = problem.what();
  } catch (const SolveFailure& problem) {
    report.message = problem.what();
  }
  if (!report.solved) return;
  Distortion distortion = measure_distortion(positions, chart.triangles, chart.coverage, z);
  Triangulation reported{chart.triangles, chart.triangle_face};
  if (std::any_of(chart.coverage.begin(), chart.coverage.end(), [](double share) { return share != 1.0; })) {
    reported = better_splits(chart, distortion.qc);
    distortion = measure_distortion(positions, reported.triangles, {}, z);
  }
  report.mean_qc = distortion.mean_qc;
  report.max_qc = distortion.max_qc;
  int last = -1;
  for (std::size_t t = 0; t < reported.triangles.size(); ++t) {
    if (!distortion.flipped[t] || reported.face[t] == last) continue;
    last = reported.face[t];
    ++report.flipped;
  }
  for (std::size_t t = 0; t < chart.triangles.size(); ++t) {
    const auto& [a, b, c] = chart.triangles[t];
    report.area += chart.coverage[t] * triangle_area(positions.row(a), positions.row(b), positions.row(c));
  }
}

}  // namespace

Unwrap unwrap(const PolygonMesh& mesh, const ParameterizeOptions& options, const Pins& pins, const Progress& progress) {
  report(progress, 0.0, "charts");
  ChartDecomposition decomposition = build_charts(mesh);
  const int n_corners = mesh.n_faces == 0 ? 0 : mesh.face_offsets[mesh.n_faces];
  Unwrap result;
  result.uv.setZero(n_corners, 2);
  result.solved_corners.assign(static_cast<std::size_t>(n_corners), false);
  result.charts.reserve(decomposition.charts.size() + 1);
  double total_faces = 1e-9;
  for (const Chart& chart : decomposition.charts) total_faces += static_cast<double>(chart.faces.size());

  double done = 0;
  for (Chart& chart : decomposition.charts) {
    UnwrappedChart unwrapped;
    unwrapped.n_vertices = chart.n_vertices();
    const double share = static_cast<double>(chart.faces.size()) / total_faces;
    ComplexVector z;
    solve_chart(mesh, chart, options, pins, part(progress, 0.05 + 0.95 * done, 0.05 + 0.95 * (done + share)), unwrapped,
                z);
    done += share;
    unwrapped.faces = std::move(chart.faces);
    unwrapped.faces.insert(unwrapped.faces.end(), chart.duplicates.begin(), chart.duplicates.end());
    std::sort(unwrapped.faces.begin(), unwrapped.faces.end());
    if (unwrapped.solved) {
      for (const int face : unwrapped.faces) {
        for (int c = mesh.face_offsets[face]; c < mesh.face_offsets[face + 1]; ++c) {
          const Complex uv = z[decomposition.chart_vertex_of_corner[c]];
          result.uv.row(c) << uv.real(), uv.imag();
          result.solved_corners[c] = true;
        }
      }
    }
    chart = Chart{};  // gives its memory back before the next solve
    result.charts.push_back(std::move(unwrapped));
  }
  result.chart_of_face = std::move(decomposition.chart_of_face);
  if (!decomposition.degenerate_faces.empty()) {
    for (const int face : decomposition.degenerate_faces) {
      result.chart_of_face[face] = static_cast<int>(result.charts.size());
    }
    UnwrappedChart unusable;
    unusable.faces = std::move(decomposition.degenerate_faces);
    unusable.message =
        "Faces with fewer than three different vertices, or with the same vertex twice in a row, cannot be unwrapped; "
        "delete them or merge their vertices.";
    result.charts.push_back(std::move(unusable));
  }
  return result;
}

}  // namespace spectral_conformal
