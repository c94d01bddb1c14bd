#include "conformal/pin_attraction.h"

#include <cmath>

namespace spectral_conformal {
namespace {

Complex allowed(Complex factor, bool may_turn) { return may_turn ? factor : factor.real(); }

}  // namespace

ComplexVector PinAttraction::deviation(const ComplexVector& z) const {
  ComplexVector pinned(shape.size());
  for (Eigen::Index i = 0; i < pinned.size(); ++i) pinned[i] = z[vertices[static_cast<std::size_t>(i)]];
  const Complex mean = pinned.mean();
  pinned.array() -= mean;
  const Complex along = allowed(shape.dot(pinned), may_turn);
  pinned -= along * shape;
  return pinned;
}

double PinAttraction::value(const ComplexVector& z) const { return weight * deviation(z).squaredNorm(); }

void PinAttraction::subtract(const ComplexVector& z, ComplexVector& result) const {
  const ComplexVector pinned = deviation(z);
  for (Eigen::Index i = 0; i < pinned.size(); ++i) {
    result[vertices[static_cast<std::size_t>(i)]] -= weight * pinned[i];
  }
}

PinAttraction pin_attraction(const Pins& pins, const BoundaryForm& form, double strength, bool may_turn) {
  PinAttraction result;
  result.may_turn = may_turn;
  result.shape.resize(static_cast<Eigen::Index>(pins.size()));
  for (const auto& [vertex, position] : pins) {
    result.shape[static_cast<Eigen::Index>(result.vertices.size())] = position;
    result.vertices.push_back(vertex);
  }
  const Complex mean = result.shape.mean();
  result.shape.array() -= mean;
  const double norm = result.shape.stableNorm();
  if (norm > 0) {
    result.shape /= norm;
  } else {
    result.shape.setZero();
  }
  result.weight = strength * form.total() / static_cast<double>(pins.size());
  return result;
}

bool fit_to_pins(ComplexVector& z, const Pins& pins, bool may_turn) {
  const double count = static_cast<double>(pins.size());
  Complex from = 0;
  Complex to = 0;
  for (const auto& [vertex, position] : pins) {
    from += z[vertex] / count;
    to += position / count;
  }
  Complex factor = 1;
  if (pins.size() > 1) {
    double square = 0;
    Complex product = 0;
    for (const auto& [vertex, position] : pins) {
      square += std::norm(z[vertex] - from);
      product += std::conj(z[vertex] - from) * (position - to);
    }
    product = allowed(product, may_turn);
    if (!(square > 0) || !(std::abs(product) > 0) || !std::isfinite(std::abs(product) / square)) return false;
    factor = product / square;
  }
  z = (factor * (z.array() - from) + to).matrix();
  return true;
}

}  // namespace spectral_conformal
