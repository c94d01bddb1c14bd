#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "packing/cell_spans.h"

namespace spectral_conformal::test {
namespace {

std::vector<OutlineEdge> ring_of(const std::vector<Complex>& points) {
  std::vector<OutlineEdge> edges;
  for (std::size_t i = 0; i < points.size(); ++i) edges.push_back({points[i], points[(i + 1) % points.size()]});
  return edges;
}

bool has_cell(const std::vector<CellSpan>& spans, Complex z) {
  return std::any_of(spans.begin(), spans.end(), [&](const CellSpan& span) {
    return span.row == static_cast<int>(std::floor(z.imag())) && span.begin <= z.real() && z.real() < span.end;
  });
}

}  // namespace

TEST_SUITE_BEGIN("cell_spans");

TEST_CASE("a square on the grid with no border takes its cells, and those that it touches") {
  const auto spans = cell_spans(ring_of({{2.5, 2.5}, {5.5, 2.5}, {5.5, 4.5}, {2.5, 4.5}}), 1, 0, 0, 10);
  REQUIRE(spans.size() == 3);
  for (std::size_t k = 0; k < 3; ++k) CHECK(spans[k] == CellSpan{static_cast<int>(k) + 2, 2, 6});
}

TEST_CASE("a hole stays free, rows beyond the last are left out") {
  auto edges = ring_of({{1, 1}, {19, 1}, {19, 19}, {1, 19}});
  const auto hole = ring_of({{5, 5}, {5, 15}, {15, 15}, {15, 5}});
  edges.insert(edges.end(), hole.begin(), hole.end());
  const auto spans = cell_spans(edges, 1, 0, 0.5, 12);
  CHECK_FALSE(has_cell(spans, {10, 10}));
  CHECK(has_cell(spans, {3, 10}));
  CHECK(spans.back().row == 11);
}

TEST_CASE("no point within the border of a random star is missing") {
  std::mt19937 chance(3);
  const auto next = [&] { return static_cast<double>(chance()) / 4294967296.0; };
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Complex> points;
    const int n = 3 + static_cast<int>(chance() % 9);
    for (int k = 0; k < n; ++k) points.push_back(Complex(25, 25) + std::polar(2 + 12 * next(), 2 * pi * k / n));
    const double border = 4 * next();
    const auto spans = cell_spans(ring_of(points), 1, 0, border, 50);
    for (std::size_t k = 0; k < points.size(); ++k) {
      const Complex a = points[k];
      const Complex b = points[(k + 1) % points.size()];
      for (int sample = 0; sample < 50; ++sample) {
        CHECK(has_cell(spans, a + next() * (b - a) + std::polar(border * next(), 2 * pi * next())));
        CHECK(has_cell(spans, Complex(25, 25) + next() * (a + next() * (b - a) - Complex(25, 25))));
      }
    }
    // And no more than a cell beyond it.
    const double farthest = 14 + border + std::sqrt(2.0);
    for (const CellSpan& span : spans)
      CHECK(std::abs(Complex(span.begin + 0.5, span.row + 0.5) - Complex(25, 25)) < farthest);
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
