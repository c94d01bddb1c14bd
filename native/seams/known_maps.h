#pragma once

#include <cstdint>
#include <memory>
#include <unordered_map>

#include "seams/trial_map.h"

namespace spectral_conformal {

/// Maps of one piece's charts, with lookup by chart in constant time.
class KnownMaps {
 public:
  KnownMaps() = default;
  explicit KnownMaps(const TrialMaps& maps);

  void add(const std::shared_ptr<const TrialMap>& mapped);
  bool contains(const std::shared_ptr<const TrialMap>& mapped) const;
  /// The first map added with an equal chart; null if there is none. Every cut duplicates vertices or changes the
  /// number of loops, so charts with equal faces, vertices, triangles and numbers of loops are equal.
  std::shared_ptr<const TrialMap> find(const Chart& chart) const;

 private:
  const TrialMaps* like(const Chart& chart) const;

  std::unordered_map<std::uint64_t, TrialMaps> maps_;  ///< by their charts' first face and number of faces
};

}  // namespace spectral_conformal
