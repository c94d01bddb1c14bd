#include "parameterization/mesh_cut.h"

#include <map>
#include <utility>

namespace spectral_conformal {

MeshCut cut_mesh(const PolygonMesh& given, const CornerPins& corner_pins) {
  MeshCut cut{PinSplitMesh::of(given, corner_pins), {}, {}, {}};
  cut.mesh = cut.split.view();
  cut.decomposition = build_charts(cut.mesh);
  int n_vertices = 0;
  for (const Chart& chart : cut.decomposition.charts) {
    cut.first_vertex.push_back(n_vertices);
    n_vertices += chart.n_vertices();
  }
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
  const ChartDecomposition& charts = cut.decomposition;
  const auto n_charts = static_cast<int>(charts.charts.size());
  if (constraints.empty()) return std::vector<LinearEquations>(charts.charts.size());
  std::vector<int> chart_of_corner;
  for (int face = 0; face < cut.mesh.n_faces; ++face) {
    chart_of_corner.resize(static_cast<std::size_t>(cut.mesh.face_offsets[face + 1]), charts.chart_of_face[face]);
  }
  return constraints.by_part(chart_of_corner, charts.chart_vertex_of_corner, n_charts);
}

}  // namespace spectral_conformal
