#include "parameterization/mesh_cut.h"

#include <map>
#include <utility>

namespace spectral_conformal {

MeshCut cut_mesh(const PolygonMesh& given, const CornerPins& corner_pins) {
  MeshCut cut{PinSplitMesh::of(given, corner_pins), {}, {}};
  cut.mesh = cut.split.view();
  cut.decomposition = build_charts(cut.mesh);
  return cut;
}

std::vector<ChartExtenders> extenders_of_charts(const MeshCut& cut, const std::vector<VertexExtender>& extenders) {
  const std::vector<Chart>& charts = cut.decomposition.charts;
  std::vector<ChartExtenders> result(charts.size());
  if (extenders.empty()) return result;
  // For each mesh vertex at an end, its copies in each chart.
  std::map<int, std::map<std::size_t, std::vector<int>>> copies;
  for (const VertexExtender& extender : extenders) {
    copies[extender.from];
    copies[extender.to];
  }
  for (std::size_t c = 0; c < charts.size(); ++c) {
    for (std::size_t v = 0; v < charts[c].vertices.size(); ++v) {
      const auto end = copies.find(cut.split.original_vertex(charts[c].vertices[v]));
      if (end != copies.end()) end->second[c].push_back(static_cast<int>(v));
    }
  }
  for (std::size_t k = 0; k < extenders.size(); ++k) {
    const auto& [from, to, strength, half] = extenders[k];
    if (from == to) continue;
    const auto& tails = copies[from];
    const auto& heads = copies[to];
    // Loop over the end in fewer charts: many extenders may share the other one.
    for (const auto& [c, unused] : heads.size() < tails.size() ? heads : tails) {
      const auto tail = tails.find(c);
      const auto head = heads.find(c);
      if (tail == tails.end() || head == heads.end()) continue;
      result[c].extenders.push_back({tail->second, head->second, strength, half});
      result[c].numbers.push_back(k);
    }
  }
  return result;
}

std::vector<LinearEquations> equations_of_charts(const MeshCut& cut, const LinearEquations& constraints) {
  std::vector<LinearEquations> result(cut.decomposition.charts.size());
  if (constraints.empty()) return result;
  std::vector<int> chart_of_corner;
  for (int face = 0; face < cut.mesh.n_faces; ++face) {
    const int chart = cut.decomposition.chart_of_face[static_cast<std::size_t>(face)];
    chart_of_corner.resize(static_cast<std::size_t>(cut.mesh.face_offsets[face + 1]), chart);
  }
  std::vector<std::pair<int, double>> terms;
  for (int e = 0; e < constraints.size(); ++e) {
    terms.clear();
    int chart = -1;
    for (int k = constraints.start[e]; k < constraints.start[e + 1]; ++k) {
      const int corner = constraints.coordinate[k] / 2;
      const int of_corner = chart_of_corner[static_cast<std::size_t>(corner)];
      if (of_corner < 0 || (chart >= 0 && of_corner != chart)) {
        chart = -1;
        break;
      }
      chart = of_corner;
      terms.emplace_back(2 * cut.decomposition.chart_vertex_of_corner[corner] + constraints.coordinate[k] % 2,
                         constraints.coefficient[k]);
    }
    if (chart >= 0) result[static_cast<std::size_t>(chart)].add(terms);
  }
  for (const auto& [coordinate, value] : constraints.held) {
    const int chart = chart_of_corner[static_cast<std::size_t>(coordinate / 2)];
    const int vertex = cut.decomposition.chart_vertex_of_corner[coordinate / 2];
    if (chart >= 0) result[static_cast<std::size_t>(chart)].held.emplace_back(2 * vertex + coordinate % 2, value);
  }
  return result;
}

}  // namespace spectral_conformal
