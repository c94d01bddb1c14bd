#pragma once

#include <cstddef>
#include <list>
#include <string>
#include <string_view>
#include <unordered_map>

#include "spectral_conformal/types.h"
#include "spectral_conformal/unwrap.h"

namespace spectral_conformal {

/// The maps of charts that unwraps have found, for later ones to take instead of solving the same again: after a change
/// of a seam or a pin only the charts that it reaches are solved, and after a change of the packing none.
///
/// A chart is looked up by a digest of all that its map is made of, so that results are the same with and without. Only
/// find() may be called by two threads at once.
class KeptMaps {
 public:
  struct Map {
    UnwrappedChart report;
    ComplexVector z;
  };

  /// Those used last are kept, as many as `max_bytes` hold with their descriptions.
  explicit KeptMaps(std::size_t max_bytes) : max_bytes_(max_bytes) {}
  // Entries are found through pointers to them.
  KeptMaps(const KeptMaps&) = delete;
  KeptMaps& operator=(const KeptMaps&) = delete;

  /// The map of a chart; null where there is none. Valid until the next call of keep().
  const Map* find(const std::string& description) const;
  /// Keeps the map of a chart as the one used last, in constant time, and drops those that then are too many. A map
  /// that takes more than `max_bytes` by itself is not kept.
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
  std::list<Entry> by_use_;                                                   ///< the one used last at the end
  std::unordered_map<std::string_view, std::list<Entry>::iterator> entries_;  ///< by descriptions there
};

}  // namespace spectral_conformal
