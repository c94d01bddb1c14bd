#pragma once

namespace spectral_conformal {

// Limits of the spaces in which eigenvectors are sought. They bound the memory: each vector has an entry per vertex.

/// Vectors that a restart keeps.
constexpr int kept_dimension = 12;
/// The dimension that triggers a restart. A whole problem of this dimension is solved densely.
constexpr int max_dimension = 2 * kept_dimension;
/// The number of solves without halving the change after which rounding is the limit: two full spaces.
constexpr int solves_without_progress = 2 * max_dimension;

}  // namespace spectral_conformal
