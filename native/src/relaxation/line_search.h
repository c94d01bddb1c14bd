#pragma once

namespace spectral_conformal {

// Of the line searches of polish and descent.

/// Leaves each triangle a tenth of its way to a flip, and the boundary a tenth of its way to a contact.
constexpr double fraction_of_max_step = 0.9;
/// Armijo's condition (Nocedal and Wright 2006, Section 3.1): the share of the fall that the slope promises.
constexpr double sufficient = 1e-4;

}  // namespace spectral_conformal
