#pragma once

#include <stdexcept>
#include <string>

namespace spectral_conformal {

/// The input breaks a precondition; the message names the condition and what to do about it.
class InvalidMesh : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// The input is valid, but no result passed the numerical checks within the bounded number of attempts.
class SolveFailure : public std::runtime_error {
 public:
  /// what() is "<reason>: <advice>".
  SolveFailure(const std::string& reason, const std::string& advice)
      : std::runtime_error(reason + ": " + advice), reason_(reason) {}
  const std::string& reason() const { return reason_; }

 private:
  std::string reason_;
};

/// The caller's progress function asked to stop.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("cancelled by the caller") {}
};

}  // namespace spectral_conformal
