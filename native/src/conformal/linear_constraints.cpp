#include "spectral_conformal/linear_constraints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "geometry/tolerances.h"
#include "graph/numbering.h"

namespace spectral_conformal {
namespace {

using Terms = std::vector<std::pair<int, double>>;

/// Gaussian elimination: some coordinates are expressed by others.
class Elimination {
 public:
  /// Of n coordinates, and a last one that is always 1.
  explicit Elimination(int n) : one_(n), expression_of_(static_cast<std::size_t>(n) + 1, -1) {}

  int one() const { return one_; }
  /// Expresses a coordinate of this equation by the others, unless former equations imply it. Returns false if they
  /// contradict it.
  bool add(Terms equation) {
    double largest = 0;
    for (const auto& [coordinate, coefficient] : equation) largest = std::max(largest, std::abs(coefficient));
    substitute(equation);
    // The rounding of terms that cancel.
    const auto is_rounding = [&](const auto& term) {
      return term.first != one_ && std::abs(term.second) <= sum_rounding * largest;
    };
    equation.erase(std::remove_if(equation.begin(), equation.end(), is_rounding), equation.end());
    if (equation.empty()) return true;
    // Terms ascend.
    // Held UVs are rounded relative to their distance from the origin, here up to a thousand of their extents.
    if (equation.front().first == one_) return std::abs(equation.front().second) <= 1000 * single_epsilon * largest;
    const auto is_smaller = [this](const auto& a, const auto& b) {
      if (a.first == one_ || b.first == one_) return a.first == one_ && b.first != one_;
      // If equal up to rounding, the later coordinate is eliminated.
      const double excess = std::abs(b.second) - std::abs(a.second);
      return std::abs(excess) > sum_rounding * std::abs(a.second) ? excess > 0 : a.first < b.first;
    };
    const auto pivot = *std::max_element(equation.begin(), equation.end(), is_smaller);
    Terms expression;
    for (const auto& [coordinate, coefficient] : equation) {
      if (coordinate != pivot.first) expression.emplace_back(coordinate, -coefficient / pivot.second);
    }
    expression_of_[static_cast<std::size_t>(pivot.first)] = static_cast<int>(expressions_.size());
    expressions_.push_back(std::move(expression));
    return true;
  }

  bool is_eliminated(int coordinate) const { return expression_of_[static_cast<std::size_t>(coordinate)] >= 0; }
  /// A coordinate by those that are not eliminated.
  Terms resolved(int coordinate) {
    Terms terms{{coordinate, 1}};
    substitute(terms);
    return terms;
  }

 private:
  /// Replaces eliminated coordinates, ascending; first in their expressions, so that chains of them stay short.
  void substitute(Terms& terms) {
    std::vector<int> open;
    for (const auto& term : terms) {
      if (is_eliminated(term.first)) open.push_back(term.first);
    }
    while (!open.empty()) {
      Terms& expression = expressions_[static_cast<std::size_t>(expression_of_[open.back()])];
      const std::size_t before = open.size();
      for (const auto& [coordinate, factor] : expression) {
        if (is_eliminated(coordinate) && !is_resolved(coordinate)) open.push_back(coordinate);
      }
      if (open.size() > before) continue;
      open.pop_back();
      replace_once(expression);
    }
    replace_once(terms);
  }

  const Terms& expression_of(int coordinate) const {
    return expressions_[static_cast<std::size_t>(expression_of_[coordinate])];
  }
  bool is_resolved(int coordinate) const {
    const Terms& expression = expression_of(coordinate);
    return std::none_of(expression.begin(), expression.end(), [&](const auto& t) { return is_eliminated(t.first); });
  }

  void replace_once(Terms& terms) const {
    const auto concerns = [&](const auto& term) { return is_eliminated(term.first); };
    if (terms.size() < 2 && std::none_of(terms.begin(), terms.end(), concerns)) return;
    Terms all;
    for (const auto& [coordinate, factor] : terms) {
      if (!is_eliminated(coordinate)) {
        all.emplace_back(coordinate, factor);
        continue;
      }
      for (const auto& [other, of_other] : expression_of(coordinate)) {
        all.emplace_back(other, factor * of_other);
      }
    }
    std::sort(all.begin(), all.end());
    terms.clear();
    for (const auto& [coordinate, factor] : all) {
      if (terms.empty() || terms.back().first != coordinate) {
        terms.emplace_back(coordinate, factor);
      } else {
        terms.back().second += factor;
      }
    }
    const auto vanishes = [](const auto& term) { return term.second == 0; };
    terms.erase(std::remove_if(terms.begin(), terms.end(), vanishes), terms.end());
  }

  int one_;
  std::vector<int> expression_of_;  ///< the number of each coordinate's expression, or -1
  std::vector<Terms> expressions_;  ///< of eliminated coordinates
};

}  // namespace

void LinearEquations::add(const std::vector<std::pair<int, double>>& terms) {
  for (const auto& [c, a] : terms) {
    coordinate.push_back(c);
    coefficient.push_back(a);
  }
  start.push_back(static_cast<int>(coordinate.size()));
}

std::vector<LinearEquations> LinearEquations::by_part(const std::vector<int>& part, const std::vector<int>& number,
                                                      int n_parts) const {
  std::vector<LinearEquations> result(static_cast<std::size_t>(n_parts));
  Terms terms;
  for (int e = 0; e < size(); ++e) {
    if (start[e] == start[e + 1]) continue;
    const int own = part[coordinate[start[e]] / 2];
    terms.clear();
    for (int k = start[e]; k < start[e + 1] && own >= 0 && part[coordinate[k] / 2] == own; ++k) {
      terms.emplace_back(2 * number[coordinate[k] / 2] + coordinate[k] % 2, coefficient[k]);
    }
    if (static_cast<int>(terms.size()) == start[e + 1] - start[e]) result[own].add(terms);
  }
  for (const auto& [c, value] : held) {
    if (part[c / 2] >= 0) result[part[c / 2]].held.emplace_back(2 * number[c / 2] + c % 2, value);
  }
  return result;
}

LinearEquations LinearEquations::renumbered(const std::vector<int>& number) const {
  std::vector<int> part = number;
  for (int& of_vertex : part) of_vertex = std::min(of_vertex, 0);
  return std::move(by_part(part, number, 1).front());
}

LinearConstraints LinearConstraints::of(const LinearEquations& equations, int n_vertices) {
  LinearConstraints result;
  const int origin = 2 * n_vertices;
  if (origin <= 0) return result;
  const bool is_held = !equations.held.empty();
  Elimination elimination(origin + 2);
  for (const auto& [coordinate, value] : equations.held) {
    if (!elimination.add({{coordinate, 1}, {elimination.one(), -value}})) ++result.n_unmet_;
  }
  for (int e = 0; e < equations.size(); ++e) {
    Terms terms;
    double sum[2] = {0, 0};
    double largest = 0;
    for (auto k = static_cast<std::size_t>(equations.start[e]); k < static_cast<std::size_t>(equations.start[e + 1]);
         ++k) {
      terms.emplace_back(equations.coordinate[k], equations.coefficient[k]);
      sum[equations.coordinate[k] % 2] += equations.coefficient[k];
      largest = std::max(largest, std::abs(equations.coefficient[k]));
    }
    // sum_k a_k (x[c_k] - origin)
    for (int axis = 0; is_held && axis < 2; ++axis) {
      if (std::abs(sum[axis]) > sum_rounding * largest) terms.emplace_back(origin + axis, -sum[axis]);
    }
    if (!elimination.add(std::move(terms))) ++result.n_unmet_;
  }

  std::vector<Terms> rows;  // of eliminated coordinates, ascending
  std::size_t n_terms = 0;
  std::array<bool, 2> uses_origin{};
  for (int c = 0; c < origin; ++c) {
    if (!elimination.is_eliminated(c)) continue;
    rows.push_back(elimination.resolved(c));
    n_terms += rows.back().size();
    for (const auto& [coordinate, factor] : rows.back()) {
      if (coordinate >= origin && coordinate != elimination.one()) uses_origin[coordinate - origin] = true;
    }
  }
  std::vector<int> unknown(static_cast<std::size_t>(origin) + 2, -1);
  for (int c = 0; c < origin + 2; ++c) {
    if (c < origin ? !elimination.is_eliminated(c) : uses_origin[c - origin]) unknown[c] = 0;
  }
  result.coordinates_ = number_marked(unknown);
  const auto p = std::make_shared<Expansion>(origin, static_cast<Eigen::Index>(result.coordinates_.size()));
  p->resizeNonZeros(static_cast<Eigen::Index>(result.coordinates_.size() + n_terms));
  result.offset_ = ComplexVector::Zero(n_vertices);
  int n = 0;
  const auto add = [&](int coordinate, double factor) {
    p->innerIndexPtr()[n] = unknown[coordinate];
    p->valuePtr()[n++] = factor;
  };
  auto row = rows.cbegin();
  for (int c = 0; c < origin; ++c) {
    if (!elimination.is_eliminated(c)) {
      add(c, 1);
    } else {
      // Terms ascend, and so do their unknowns.
      for (const auto& [coordinate, factor] : *row++) {
        if (coordinate == elimination.one()) {
          result.offset_[c / 2] += c % 2 == 0 ? Complex(factor, 0) : Complex(0, factor);
        } else {
          add(coordinate, factor);
        }
      }
    }
    p->outerIndexPtr()[c + 1] = n;
  }
  p->resizeNonZeros(n);
  result.p_ = p;
  return result;
}

ComplexVector LinearConstraints::expanded(const Eigen::VectorXd& w) const {
  const Eigen::VectorXd x = *p_ * w;
  return Eigen::Map<const ComplexVector>(reinterpret_cast<const Complex*>(x.data()), x.size() / 2);
}

Eigen::VectorXd LinearConstraints::gathered(const ComplexVector& z) const {
  return p_->transpose() * Eigen::Map<const Eigen::VectorXd>(reinterpret_cast<const double*>(z.data()), 2 * z.size());
}

Eigen::VectorXd LinearConstraints::translation(int axis) const {
  // Held coordinates do not move.
  for (int c = axis; c < p_->rows(); c += 2) {
    if (p_->outerIndexPtr()[c] == p_->outerIndexPtr()[c + 1]) return {};
  }
  // Each unknown is the value of one coordinate.
  Eigen::VectorXd along(n_unknowns());
  for (Eigen::Index k = 0; k < along.size(); ++k) {
    along[k] = coordinates_[static_cast<std::size_t>(k)] % 2 == axis ? 1 : 0;
  }
  const ComplexVector z = expanded(along);
  const Complex step = axis == 0 ? Complex(1, 0) : Complex(0, 1);
  if (z.size() == 0 || !((z.array() - step).abs2().maxCoeff() < insignificant * insignificant)) return {};
  return along;
}

}  // namespace spectral_conformal
