#pragma once

#include "spectral_conformal/types.h"

namespace spectral_conformal {

// Limits of the spaces in which eigenvectors are sought. They bound the memory: each vector has an entry per vertex.

/// The dimension that triggers a restart, which keeps half. A whole problem of this dimension is solved densely.
constexpr int max_dimension = 24;

/// Whether the change of an iterate still halves. Rounding is the limit once two full spaces of solves do not halve it.
class Halving {
 public:
  explicit Halving(int solves) : halved_at_(solves) {}
  void add(double change, int solves) {
    if (!(change < 0.5 * halved_)) return;
    halved_ = change;
    halved_at_ = solves;
  }
  double least() const { return halved_; }  ///< the last change that was halved
  bool goes_on(int solves) const { return solves - halved_at_ <= 2 * max_dimension; }

 private:
  double halved_ = infinity;
  int halved_at_;
};

}  // namespace spectral_conformal
