#pragma once

#include <stdexcept>

#include "spectral_conformal/step.h"

namespace spectral_conformal {

/// The input violates a precondition; the step names the condition. Callers put it into words.
class InvalidMesh : public std::invalid_argument {
 public:
  explicit InvalidMesh(Rejection reason, int count = 0, int index = 0, int limit = 0)
      : InvalidMesh(rejected(reason, count, index, limit)) {}
  explicit InvalidMesh(const Step& step) : std::invalid_argument("the input violates a condition"), step_(step) {}
  const Step& step() const { return step_; }  ///< of StepKind::rejected

 private:
  Step step_;
};

/// The input is valid, but no result passed the numerical checks within the bounded number of attempts.
class SolveFailure : public std::runtime_error {
 public:
  explicit SolveFailure(const Step& step) : std::runtime_error("no map passed its checks"), step_(step) {}
  const Step& step() const { return step_; }  ///< of StepKind::rejected

 private:
  Step step_;
};

/// The caller's progress function asked to stop.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("canceled by the caller") {}
};

}  // namespace spectral_conformal
