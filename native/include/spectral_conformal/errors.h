#pragma once

#include <optional>
#include <stdexcept>

#include "spectral_conformal/step.h"

namespace spectral_conformal {

/// The input violates a precondition; the message names the condition and what to do about it.
class InvalidMesh : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
  explicit InvalidMesh(const Step& step) : std::invalid_argument("no map of the mesh can be made"), step_(step) {}
  /// The condition that a chart violates (chart_checks.h), of StepKind::rejected; empty if only the message names it.
  const std::optional<Step>& step() const { return step_; }

 private:
  std::optional<Step> step_;
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
  Cancelled() : std::runtime_error("cancelled by the caller") {}
};

}  // namespace spectral_conformal
