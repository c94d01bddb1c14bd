#pragma once

#include <cstdint>

namespace spectral_conformal {

/// The increment of SplitMix64, 2^64 over the golden ratio: consecutive multiples are spread evenly.
constexpr std::uint64_t golden_increment = 0x9e3779b97f4a7c15U;

/// A bijection in which each bit of x flips about half of the result's bits: the finalizer of SplitMix64 (Steele, Lea
/// and Flood, "Fast splittable pseudorandom number generators", 2014). It turns consecutive multiples of
/// golden_increment into pseudo-random numbers, the same on every platform.
constexpr std::uint64_t mixed_bits(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31);
}

/// The k-th pseudo-random number of a seed, in [-1, 1).
constexpr double pseudo_random(std::uint64_t k, std::uint64_t seed = 0) {
  return static_cast<double>(mixed_bits(seed + k * golden_increment) >> 11) * 0x1.0p-52 - 1.0;
}

}  // namespace spectral_conformal
