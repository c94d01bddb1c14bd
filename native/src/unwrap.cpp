#include "spectral_conformal/unwrap.h"

#include <algorithm>
#include <array>

namespace spectral_conformal {
namespace {

/// Fills in mean_qc, max_qc, flipped and area of a solved chart. They are those of one triangulation: where the energy
/// has both splits of a quad, of the one that is distorted less (a symmetric map can collapse a triangle of the other).
void measure(const Chart& chart, const ConformalEnergy& energy, const ComplexVector& z, double scale,
             UnwrappedChart& report) {
  struct Triangle {
    double qc = 1;
    double area = 0;
    double image = 0;
  };
  const auto measured = [&](std::size_t t) {
    const auto& [a, b, c] = chart.triangles[t];
    const TriangleShape& shape = energy.shapes()[t];
    Triangle result;
    if (shape.clamped) return result;
    result.qc = shape.quasi_conformal_distortion(z[b] - z[a], z[c] - z[a]);
    result.area = shape.area();
    result.image = 0.5 * std::imag(std::conj(z[b] - z[a]) * (z[c] - z[a]));
    return result;
  };
  report.max_qc = 1;
  double weighted = 0;
  double area = 0;
  int last_flipped = -1;
  const auto take = [&](const Triangle& triangle, std::size_t t) {
    weighted += triangle.area * triangle.qc;
    area += triangle.area;
    report.max_qc = std::max(report.max_qc, triangle.qc);
    // The whole map is positively oriented (place), so a flipped triangle is a negative one.
    if (triangle.image < 0 && chart.triangle_face[t] != last_flipped) {
      last_flipped = chart.triangle_face[t];
      ++report.flipped;
    }
  };
  for (std::size_t t = 0; t < chart.triangles.size(); ++t) {
    if (chart.coverage[t] == 1.0) {
      take(measured(t), t);
      continue;
    }
    // triangulate_polygon puts the four triangles of the two splits in a row.
    const std::array<Triangle, 4> splits{measured(t), measured(t + 1), measured(t + 2), measured(t + 3)};
    const auto worst = [&](int first) { return std::max(splits[first].qc, splits[first + 1].qc); };
    const int better = worst(0) <= worst(2) ? 0 : 2;
    take(splits[better], t);
    take(splits[better + 1], t);
    t += 3;
  }
  report.mean_qc = area > 0 ? weighted / area : 1;
  report.area = energy.area() * scale * scale;
}

/// Adds the pins of mesh vertices, on the copies that a chart has of them, where corners have none.
void add_vertex_pins(const PinSplitMesh& split, const Chart& chart, const Pins& vertex_pins, Pins& pins) {
  if (vertex_pins.empty()) return;
  for (int v = 0; v < chart.n_vertices(); ++v) {
    const auto pin = vertex_pins.find(split.original_vertex(chart.vertices[static_cast<std::size_t>(v)]));
    if (pin != vertex_pins.end()) pins.emplace(v, pin->second);
  }
}

/// Solves one chart and fills in its report; the map goes to `z`. `find_pins` returns the chart's pins.
template <class FindPins>
void solve_chart(const PolygonMesh& mesh, const Chart& chart, const ParameterizeOptions& options,
                 const FindPins& find_pins, const Progress& progress, UnwrappedChart& report, ComplexVector& z) {
  const Positions positions = chart.positions(mesh);
  report.method = options.method;
  try {
    const Pins pins = find_pins();
    report.n_pins = static_cast<int>(pins.size());
    const bool soft = options.method == Method::spectral && options.soft_pins > 0;
    if (pins.size() > 1 && !soft) report.method = Method::lscm;
    Solver solver(chart, positions, options.weights, options.boundary, options.backend, options.fill_holes);
    Parameterization solution =
        solver.solve({report.method, options.tolerance, soft ? options.soft_pins : 0}, pins, progress);
    z = std::move(solution.z);
    report.solved = true;
    measure(chart, solver.energy(), z, solver.scale(), report);
    report.message = solution.message;
    report.eigenvalue = solution.eigenvalue;
    report.residual = solution.residual;
    report.iterations = solution.iterations;
    report.turning_number = solution.turning_number;
  } catch (const InvalidMesh& problem) {
    report.message = problem.what();
  } catch (const SolveFailure& problem) {
    report.message = problem.what();
  }
}

}  // namespace

Unwrap unwrap(const PolygonMesh& given, const ParameterizeOptions& options, const Pins& vertex_pins,
              const CornerPins& corner_pins, const Progress& progress) {
  report(progress, 0.0, "charts");
  const PinSplitMesh split(given, corner_pins);
  const PolygonMesh mesh = split.view();
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
    const auto find_pins = [&] {
      Pins pins = chart_pins(mesh, chart, decomposition.chart_vertex_of_corner, corner_pins);
      add_vertex_pins(split, chart, vertex_pins, pins);
      return pins;
    };
    solve_chart(mesh, chart, options, find_pins, part(progress, 0.05 + 0.95 * done, 0.05 + 0.95 * (done + share)),
                unwrapped, z);
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
