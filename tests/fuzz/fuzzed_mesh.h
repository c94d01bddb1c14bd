#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "mesh/charts.h"

namespace spectral_conformal::fuzz {

/// Takes numbers from libFuzzer's bytes; zeros when they are used up.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), end_(data + size) {}
  bool empty() const { return data_ == end_; }
  int byte() { return empty() ? 0 : *data_++; }
  /// 0 to limit - 1.
  int below(int limit) { return limit > 0 ? byte() % limit : 0; }
  bool flag() { return (byte() & 1) != 0; }
  /// Mostly small integers and their neighbors, sometimes any double at all.
  double number() {
    const int kind = byte();
    if (kind < 200) return (kind % 16) - 8 + 0.0625 * (kind / 16);
    if (kind < 230) return (kind - 215) * std::pow(10.0, byte() % 24 - 12);
    std::array<std::uint8_t, sizeof(double)> raw{};
    for (std::uint8_t& part : raw) part = static_cast<std::uint8_t>(byte());
    double result = 0;
    std::memcpy(&result, raw.data(), sizeof result);
    return result;
  }

 private:
  const std::uint8_t* data_;
  const std::uint8_t* end_;
};

/// A polygon mesh made from bytes: a grid of quads or loose faces, then faces of random vertices, seams and a
/// selection.
struct FuzzedMesh {
  std::vector<double> positions;
  std::vector<int> offsets{0};
  std::vector<int> corners;
  std::vector<std::array<int, 2>> seams;
  std::vector<char> selected;

  explicit FuzzedMesh(Bytes& bytes) {
    const int columns = bytes.below(9);
    const int rows = bytes.below(9);
    const int n = (columns + 1) * (rows + 1) + bytes.below(8);
    const bool flat = bytes.flag();
    for (int v = 0; v < n; ++v) {
      const bool regular = flat || bytes.flag();
      positions.push_back(regular ? v % (columns + 1) : bytes.number());
      positions.push_back(regular ? v / (columns + 1) : bytes.number());
      positions.push_back(flat ? 0 : bytes.number());
    }
    const int missing = bytes.below(columns * rows + 1);
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j < columns; ++j) {
        const int a = i * (columns + 1) + j;
        if (i * columns + j == missing) continue;
        add({a, a + 1, a + columns + 2, a + columns + 1});
      }
    }
    for (int face = bytes.below(12); face > 0; --face) {
      std::vector<int> vertices(static_cast<std::size_t>(bytes.below(7)));
      for (int& vertex : vertices) vertex = bytes.below(n);
      add(vertices);
    }
    for (int seam = bytes.below(16); seam > 0; --seam) {
      const int a = bytes.below(n);
      seams.push_back({a, bytes.flag() ? (a + 1) % n : bytes.below(n)});
    }
    if (bytes.flag()) {
      for (int face = 0; face < n_faces(); ++face) selected.push_back(bytes.flag() ? 1 : 0);
    }
  }

  int n_faces() const { return static_cast<int>(offsets.size()) - 1; }
  int n_vertices() const { return static_cast<int>(positions.size() / 3); }

  PolygonMesh view() const {
    static_assert(sizeof(bool) == sizeof(char));
    PolygonMesh mesh;
    mesh.positions = positions.data();
    mesh.n_vertices = n_vertices();
    mesh.face_offsets = offsets.data();
    mesh.n_faces = n_faces();
    mesh.corner_vertices = corners.data();
    mesh.seam_edges = seams.data();
    mesh.n_seam_edges = static_cast<int>(seams.size());
    if (!selected.empty()) mesh.selected_faces = reinterpret_cast<const bool*>(selected.data());
    return mesh;
  }

 private:
  void add(const std::vector<int>& face) {
    corners.insert(corners.end(), face.begin(), face.end());
    offsets.push_back(static_cast<int>(corners.size()));
  }
};

/// Ends the process where something that must hold does not: libFuzzer then keeps the input.
inline void require(bool holds) {
  if (!holds) __builtin_trap();
}

}  // namespace spectral_conformal::fuzz
