#pragma once

#include <cstddef>
#include <vector>

#include "spectral_conformal/box_packing.h"

namespace spectral_conformal {

/// The boxes that pack_boxes puts again in trials that exchange two of them: all trials together take a few
/// milliseconds.
constexpr std::size_t all_exchanged_boxes = 50000;

/// pack_boxes with another number of them.
double pack_boxes(std::vector<PackedBox>& boxes, std::size_t exchanged_boxes);

}  // namespace spectral_conformal
