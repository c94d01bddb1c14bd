#include "parameterization/chart_description.h"

#include <optional>
#include <type_traits>

namespace spectral_conformal {
namespace {

/// Bytes of values, one after the other.
class Description {
 public:
  template <class... Values>
  void add(const Values&... values) {
    (add_value(values), ...);
  }
  std::string bytes;

 private:
  template <class Value>
  void add_value(const Value& value) {
    // Others may have bytes that mean nothing between their members.
    static_assert(std::is_arithmetic_v<Value> || std::is_enum_v<Value>);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void add_value(const std::optional<double>& value) {
    add_value(value.has_value());
    add_value(value.value_or(0.0));
  }
  template <class Value>
  void add_value(const std::vector<Value>& values) {
    add_value(values.size());
    static_assert(std::has_unique_object_representations_v<Value> || std::is_same_v<Value, double>);
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value));
  }
  void add_value(const std::vector<BoundaryLoop>& loops) {
    add_value(loops.size());
    for (const BoundaryLoop& loop : loops) add_value(loop);
  }
  void add_value(const std::vector<Extender>& extenders) {
    add_value(extenders.size());
    for (const Extender& extender : extenders) {
      const auto& [from, to, strength] = extender;
      add(from, to, strength);
    }
  }
  void add_value(const std::vector<TriangleMetric>& metric) {
    add_value(metric.size());
    for (const TriangleMetric& each : metric) {
      const auto& [xx, xy, yy] = each;
      add(xx, xy, yy);
    }
  }
  void add_value(const Pins& pins) {
    add_value(pins.size());
    for (const auto& [vertex, place] : pins) add(vertex, place.real(), place.imag());
  }
  void add_value(const Positions& positions) {
    add_value(positions.rows());
    bytes.append(reinterpret_cast<const char*>(positions.data()),
                 static_cast<std::size_t>(positions.size()) * sizeof(double));
  }
};

}  // namespace

std::string describe_chart(const Chart& chart, const Positions& positions, const std::vector<TriangleMetric>& metric,
                           const PatchOptions& patch, const SolveOptions& solve, const Pins& pins) {
  Description description;
  description.bytes.reserve(static_cast<std::size_t>(positions.size()) * sizeof(double) +
                            chart.triangles.size() * (sizeof(chart.triangles[0]) + 2 * sizeof(double)) +
                            chart.vertices.size() * sizeof(int) + 1024);
  // Bound by name, so that a member that is added must be added here.
  const auto& [faces, vertices, triangles, triangle_weights, triangle_face, boundary_loops, euler_characteristic,
               orientable, self_intersecting_polygons, reversed_faces, duplicates] = chart;
  description.add(faces, vertices, triangles.vector(), triangle_weights.vector(), triangle_face, boundary_loops,
                  euler_characteristic, orientable, self_intersecting_polygons, reversed_faces, duplicates, positions,
                  metric);
  const auto& [weights, boundary, backend, fill_holes, area_blend, fold_free, polish] = patch;
  description.add(weights, boundary, backend, fill_holes, area_blend, fold_free, polish);
  const auto& [method, tolerance, soft_pins, extenders, hole_rigidity, fallbacks, second_attempt] = solve;
  description.add(method, tolerance, soft_pins, extenders, hole_rigidity, fallbacks, second_attempt, pins);
  return std::move(description.bytes);
}

}  // namespace spectral_conformal
