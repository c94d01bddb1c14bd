#pragma once

#include <cstddef>
#include <vector>

namespace spectral_conformal {

/// (n,) the index of each of 0, 1, ..., n - 1 in `order`, or -1. order: each number at most once.
std::vector<int> indices_in(const std::vector<int>& order, std::size_t n);

/// The indices of the marks that are not negative, ascending. Replaces these marks by 0, 1, 2, ...
std::vector<int> number_marked(std::vector<int>& marks);

}  // namespace spectral_conformal
