#include "spectral_conformal/linear_constraints.h"

#include <cstddef>

namespace spectral_conformal {

ComplexVector LinearConstraints::expanded(const Eigen::VectorXd& w) const {
  ComplexVector z(static_cast<Eigen::Index>(unknown.size() / 2));
  const auto value = [&](std::size_t c) { return unknown[c] < 0 ? 0.0 : sign[c] * w[unknown[c]]; };
  for (std::size_t v = 0; v < unknown.size() / 2; ++v) {
    z[static_cast<Eigen::Index>(v)] = Complex(value(2 * v), value(2 * v + 1));
  }
  return z;
}

Eigen::VectorXd LinearConstraints::gathered(const ComplexVector& z) const {
  Eigen::VectorXd w = Eigen::VectorXd::Zero(n_unknowns);
  for (std::size_t c = 0; c < unknown.size(); ++c) {
    const Complex point = z[static_cast<Eigen::Index>(c / 2)];
    if (unknown[c] >= 0) w[unknown[c]] += sign[c] * (c % 2 == 0 ? point.real() : point.imag());
  }
  return w;
}

Eigen::VectorXd LinearConstraints::translation(int axis) const {
  Eigen::VectorXd along = Eigen::VectorXd::Zero(n_unknowns);
  for (auto c = static_cast<std::size_t>(axis); c < unknown.size(); c += 2) {
    if (unknown[c] < 0 || along[unknown[c]] == -sign[c]) return {};
    along[unknown[c]] = sign[c];
  }
  return along;
}

LinearConstraints LinearConstraints::restricted(const std::vector<int>& vertices, int n_free) const {
  LinearConstraints result;
  std::vector<int> renumbered(static_cast<std::size_t>(n_unknowns), -1);
  for (const int vertex : vertices) {
    for (const int c : {2 * vertex, 2 * vertex + 1}) {
      const auto i = static_cast<std::size_t>(c);
      int number = unknown[i];
      if (number >= 0) {
        int& next = renumbered[static_cast<std::size_t>(number)];
        if (next < 0) next = result.n_unknowns++;
        number = next;
      }
      result.unknown.push_back(number);
      result.sign.push_back(sign[i]);
    }
  }
  for (int i = 0; i < 2 * n_free; ++i) {
    result.unknown.push_back(result.n_unknowns++);
    result.sign.push_back(1);
  }
  return result;
}

}  // namespace spectral_conformal
