#include "conformal/mirrored_energy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "spectral_conformal/metric.h"

namespace spectral_conformal {
namespace {

using Pair = std::pair<int, int>;
using Triangle = std::array<int, 3>;

/// The dot products of the sides a and b from the first of three corners to the others, scaled to determinant 1.
struct SideProducts {
  double aa;
  double ab;
  double bb;
};

/// corners: the triangle's corners 0 to 2, in some order.
SideProducts side_products(const TriangleShape& shape, const Triangle& corners) {
  const std::array<Complex, 3> at{Complex(0), Complex(shape.x1), Complex(shape.x2, shape.y2)};
  const double unit = 2 * shape.area();
  const Complex a = at[corners[1]] - at[corners[0]];
  const Complex b = at[corners[2]] - at[corners[0]];
  return {std::norm(a) / unit, (a.real() * b.real() + a.imag() * b.imag()) / unit, std::norm(b) / unit};
}

/// The metric, up to scale, in which a triangle with the sides E has these products: E^-T products E^-1.
TriangleMetric metric_with(const TriangleShape& shape, const SideProducts& products) {
  const double xx = products.aa / (shape.x1 * shape.x1);
  const double ab = (products.ab / shape.x1 - shape.x2 * xx) / shape.y2;
  const double yy = (products.bb - shape.x2 * (shape.x2 * xx + 2 * shape.y2 * ab)) / (shape.y2 * shape.y2);
  return {xx, ab, yy};
}

}  // namespace

std::vector<int> mirror_images(const LinearEquations& equations, int n_vertices) {
  std::vector<int> image;
  std::vector<Pair> opposite;  // in u, ascending
  std::vector<Pair> level;     // in v
  for (int e = 0; e < equations.size(); ++e) {
    std::array<Pair, 2> terms{};  // axis and vertex; then their coefficients
    std::array<double, 2> factors{};
    std::size_t n = 0;
    for (int k = equations.start[e]; k < equations.start[e + 1] && n < 3; ++k) {
      if (equations.coefficient[k] == 0) continue;
      if (n < 2) {
        terms[n] = {equations.coordinate[k] % 2, equations.coordinate[k] / 2};
        factors[n] = equations.coefficient[k];
      }
      ++n;
    }
    if (n == 0 || n > 2) continue;
    const bool is_alone = n == 1 || terms[0] == terms[1];
    if (!is_alone && terms[0].first != terms[1].first) continue;
    const bool is_u = terms[0].first == 0;
    const Pair vertices = std::minmax(terms[0].second, terms[is_alone ? 0 : 1].second);
    if (is_alone) {
      if (!is_u || (n == 2 && factors[0] + factors[1] == 0)) continue;
      image.resize(static_cast<std::size_t>(n_vertices), -1);
      image[vertices.first] = vertices.first;
    } else if (factors[0] == (is_u ? factors[1] : -factors[1])) {
      (is_u ? opposite : level).push_back(vertices);
    }
  }
  for (std::vector<Pair>* pairs : {&opposite, &level}) std::sort(pairs->begin(), pairs->end());
  std::vector<Pair> mirrored;
  std::set_intersection(opposite.begin(), opposite.end(), level.begin(), level.end(), std::back_inserter(mirrored));
  if (mirrored.empty()) return {};
  image.resize(static_cast<std::size_t>(n_vertices), -1);
  for (const auto& [a, b] : mirrored) {
    image[a] = b;
    image[b] = a;
  }
  return image;
}

ConformalEnergy mirrored_energy(const ConformalEnergy& energy, const Positions& positions,
                                const std::vector<int>& image) {
  const std::vector<Triangle>& triangles = energy.triangles();
  const std::vector<TriangleShape>& shapes = energy.energy_shapes();
  const auto images_of = [&](const Triangle& t) { return Triangle{image[t[0]], image[t[1]], image[t[2]]}; };
  std::vector<std::pair<Triangle, int>> by_vertices;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    Triangle corners = triangles[t];
    const Triangle images = images_of(corners);
    if (energy.shapes()[t].clamped || std::find(images.begin(), images.end(), -1) != images.end()) continue;
    std::sort(corners.begin(), corners.end());
    by_vertices.emplace_back(corners, static_cast<int>(t));
  }
  std::sort(by_vertices.begin(), by_vertices.end());
  std::vector<TriangleMetric> metric(triangles.size());
  for (const auto& entry : by_vertices) {
    const auto t = static_cast<std::size_t>(entry.second);
    const Triangle images = images_of(triangles[t]);
    Triangle key = images;
    std::sort(key.begin(), key.end());
    const auto found = std::lower_bound(by_vertices.begin(), by_vertices.end(), std::pair(key, -1));
    SideProducts mirrored{};
    if (found != by_vertices.end() && found->first == key) {
      const auto other = static_cast<std::size_t>(found->second);
      const Triangle& corners = triangles[other];
      Triangle order{};
      for (std::size_t k = 0; k < 3; ++k) {
        order[k] = static_cast<int>(std::find(corners.begin(), corners.end(), images[k]) - corners.begin());
      }
      mirrored = side_products(shapes[other], order);
    } else {
      const TriangleShape shape =
          local_isometric_frame(positions.row(images[0]), positions.row(images[1]), positions.row(images[2]));
      if (shape.clamped) continue;
      mirrored = side_products(shape, {0, 1, 2});
    }
    const SideProducts own = side_products(shapes[t], {0, 1, 2});
    // The scale of a metric has no effect.
    const TriangleMetric mean =
        metric_with(shapes[t], {own.aa + mirrored.aa, own.ab + mirrored.ab, own.bb + mirrored.bb});
    if (is_positive_definite(mean)) metric[t] = mean;
  }
  ConformalEnergy result = energy;
  result.stretch(metric);
  return result;
}

}  // namespace spectral_conformal
