#pragma once

#include <cstddef>
#include <list>
#include <string>
#include <string_view>
#include <unordered_map>

#include "spectral_conformal/types.h"
#include "spectral_conformal/unwrap.h"

namespace spectral_conformal {

/// A cache of chart maps, which spares later unwraps the same solves: after a change of a seam or a pin only the
/// affected charts are solved, and after a change of the packing none.
///
/// The key is a digest of everything that determines a chart's map, so results are the same with and without the cache.
/// Only find() may be called from several threads at once.
class KeptMaps {
 public:
  struct Map {
    UnwrappedChart report;
    ComplexVector z;
  };

  /// Keeps the most recently used maps, as many as fit in `max_bytes` with their keys.
  explicit KeptMaps(std::size_t max_bytes) : max_bytes_(max_bytes) {}
  // The lookup table points into the entries.
  KeptMaps(const KeptMaps&) = delete;
  KeptMaps& operator=(const KeptMaps&) = delete;

  /// The map of a chart, or null. Valid until the next call of keep().
  const Map* find(const std::string& description) const;
  /// Stores the map of a chart as the most recently used, in constant time, and drops the least recently used ones
  /// beyond `max_bytes`. A map larger than `max_bytes` is not kept.
  void keep(std::string&& description, Map&& map);
  std::size_t size() const { return by_use_.size(); }
  std::size_t bytes() const { return bytes_; }

 private:
  struct Entry {
    std::string description;
    Map map;
    std::size_t bytes = 0;
  };

  std::size_t max_bytes_;
  std::size_t bytes_ = 0;
  std::list<Entry> by_use_;                                                   ///< most recently used at the end
  std::unordered_map<std::string_view, std::list<Entry>::iterator> entries_;  ///< keyed by the descriptions there
};

}  // namespace spectral_conformal
