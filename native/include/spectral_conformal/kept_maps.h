#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_map>

#include "spectral_conformal/types.h"
#include "spectral_conformal/unwrap.h"

namespace spectral_conformal {

/// The maps of charts that unwraps have found, for later ones to take instead of solving the same again: after a change
/// of a seam or a pin only the charts that it reaches are solved, and after a change of the packing none.
///
/// A chart is described by all that its map is made of, byte by byte, and looked up by the whole description, so that
/// results are the same with and without. Not to be used in two threads at once, but for find().
class KeptMaps {
 public:
  struct Map {
    UnwrappedChart report;
    ComplexVector z;
  };

  /// Those used last are kept, as many as `max_bytes` hold with their descriptions.
  explicit KeptMaps(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  /// The map of a chart; null where there is none. Valid until the next call of keep().
  const Map* find(const std::string& description) const;
  /// Keeps the map of a chart, or has it be the one used last, and forgets others for it. One that is too large for
  /// `max_bytes` alone is not kept.
  void keep(std::string&& description, Map&& map);
  std::size_t size() const { return maps_.size(); }
  std::size_t bytes() const { return bytes_; }

 private:
  struct Entry {
    Map map;
    std::size_t bytes = 0;
    std::uint64_t last_use = 0;
  };

  /// Of some of the bytes: descriptions are long, and those that share it are compared.
  struct SampledHash {
    std::size_t operator()(const std::string& description) const;
  };

  std::size_t max_bytes_;
  std::size_t bytes_ = 0;
  std::uint64_t use_ = 0;
  std::unordered_map<std::string, Entry, SampledHash> maps_;
};

}  // namespace spectral_conformal
