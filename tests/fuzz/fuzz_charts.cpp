// libFuzzer on the chart builder, once with a mesh made from the bytes and once with the bytes as its arrays.
#include <algorithm>

#include "fuzzed_mesh.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal::fuzz {
namespace {

/// What must hold of every decomposition.
void check(const PolygonMesh& mesh, const ChartDecomposition& result) {
  require(static_cast<int>(result.chart_of_face.size()) == mesh.n_faces);
  std::vector<int> faces(result.charts.size(), 0);
  for (const int chart : result.chart_of_face) {
    require(chart >= -1 && chart < static_cast<int>(result.charts.size()));
    if (chart >= 0) ++faces[chart];
  }
  for (std::size_t i = 0; i < result.charts.size(); ++i) {
    const Chart& chart = result.charts[i];
    require(faces[i] == static_cast<int>(chart.faces.size() + chart.duplicates.size()));
    require(std::is_sorted(chart.vertices.begin(), chart.vertices.end()));
    require(chart.triangles.size() == chart.triangle_weights.size() &&
            chart.triangles.size() == chart.triangle_face.size());
    std::vector<int> used(chart.vertices.size(), 0);
    for (const auto& triangle : chart.triangles) {
      for (const int v : triangle) {
        require(v >= 0 && v < chart.n_vertices());
        used[v] = 1;
      }
    }
    require(std::find(used.begin(), used.end(), 0) == used.end());
    std::vector<int> passed(chart.vertices.size(), 0);
    for (const BoundaryLoop& loop : chart.boundary_loops) {
      for (const int v : loop) require(++passed[v] == 1 || !chart.orientable);
    }
    if (chart.orientable) {
      require(chart.genus() >= 0);
      require(2 - 2 * chart.genus() - static_cast<int>(chart.boundary_loops.size()) == chart.euler_characteristic);
    }
  }
}

void build(const PolygonMesh& mesh) {
  try {
    check(mesh, build_charts(mesh));
  } catch (const InvalidMesh&) {
    return;  // said so
  }
}

/// The bytes as arrays that need not describe a mesh.
void build_from_raw(Bytes& bytes) {
  FuzzedMesh mesh(bytes);
  for (int k = bytes.below(6); k > 0; --k) {
    const int value = bytes.flag() ? -bytes.byte() : bytes.byte() << bytes.below(24);
    switch (bytes.below(3)) {
      case 0:
        // The last offset is the length of the corners, which the caller vouches for.
        if (mesh.n_faces() > 0) mesh.offsets[bytes.below(mesh.n_faces())] = value;
        break;
      case 1:
        if (!mesh.corners.empty()) mesh.corners[bytes.below(static_cast<int>(mesh.corners.size()))] = value;
        break;
      default:
        if (!mesh.seams.empty()) mesh.seams.back()[0] = value;
    }
  }
  build(mesh.view());
}

}  // namespace
}  // namespace spectral_conformal::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace spectral_conformal::fuzz;
  Bytes bytes(data, size);
  if (bytes.flag()) {
    build_from_raw(bytes);
  } else {
    build(FuzzedMesh(bytes).view());
  }
  return 0;
}
