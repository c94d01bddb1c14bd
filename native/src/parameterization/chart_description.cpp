#include "parameterization/chart_description.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>
#include <type_traits>

#include "graph/mixed_bits.h"

namespace spectral_conformal {
namespace {

/// Two chains over the words; each state is a bijection of the previous state and of the word.
class Digest {
 public:
  template <class... Values>
  void add(const Values&... values) {
    (add_value(values), ...);
  }
  std::string bytes() const {
    std::string result(sizeof state_, '\0');
    std::memcpy(result.data(), state_, sizeof state_);
    return result;
  }

 private:
  /// Adds words of eight bytes; the last one is padded with zeros.
  void add_bytes(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const char*>(data);
    for (std::size_t i = 0; i < size; i += sizeof(std::uint64_t)) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes + i, std::min(sizeof word, size - i));
      state_[0] = mixed_bits(state_[0] ^ word);
      state_[1] = mixed_bits(state_[1] + word);
    }
  }
  template <class Value>
  void add_value(const Value& value) {
    // Other types may have padding bytes.
    static_assert(std::is_arithmetic_v<Value> || std::is_enum_v<Value>);
    add_bytes(&value, sizeof value);
  }
  void add_value(const std::optional<double>& value) {
    add_value(value.has_value());
    add_value(value.value_or(0.0));
  }
  template <class Value>
  void add_value(const std::vector<Value>& values) {
    add_value(values.size());
    static_assert(std::has_unique_object_representations_v<Value> || std::is_same_v<Value, double>);
    add_bytes(values.data(), values.size() * sizeof(Value));
  }
  void add_value(const std::vector<std::pair<int, double>>& values) {
    add_value(values.size());
    for (const auto& [first, second] : values) add(first, second);
  }
  void add_value(const std::vector<BoundaryLoop>& loops) {
    add_value(loops.size());
    for (const BoundaryLoop& loop : loops) add_value(loop);
  }
  void add_value(const std::vector<Extender>& extenders) {
    add_value(extenders.size());
    for (const Extender& extender : extenders) {
      const auto& [from, to, strength, half] = extender;
      add(from, to, strength, half);
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
    for (const auto& [vertex, position] : pins) add(vertex, position.real(), position.imag());
  }
  void add_value(const Positions& positions) {
    add_value(positions.rows());
    add_bytes(positions.data(), static_cast<std::size_t>(positions.size()) * sizeof(double));
  }

  std::uint64_t state_[2] = {1, 2};
};

}  // namespace

std::string describe_chart(const Chart& chart, const Positions& positions, const std::vector<TriangleMetric>& metric,
                           const PatchOptions& patch, const SolveOptions& solve, const Pins& pins) {
  Digest digest;
  // Bound by name, so that adding a member requires a change here.
  const auto& [faces, vertices, triangles, triangle_weights, triangle_face, boundary_loops, euler_characteristic,
               orientable, self_intersecting_polygons, reversed_faces, duplicates] = chart;
  digest.add(faces, vertices, triangles.vector(), triangle_weights.vector(), triangle_face, boundary_loops,
             euler_characteristic, orientable, self_intersecting_polygons, reversed_faces, duplicates, positions,
             metric);
  const auto& [weights, boundary, backend, fill_holes, area_blend] = patch;
  digest.add(weights, boundary, backend, fill_holes, area_blend);
  const auto& [method, tolerance, soft_pins, extenders, constraints, hole_rigidity, fallbacks, fold_free, polish,
               second_attempt] = solve;
  const auto& [start, coordinate, coefficient, held] = constraints;
  digest.add(method, tolerance, soft_pins, extenders, start, coordinate, coefficient, held, hole_rigidity, fallbacks,
             fold_free, polish, second_attempt, pins);
  return digest.bytes();
}

}  // namespace spectral_conformal
