#pragma once

#include <cstdint>
#include <memory>
#include <unordered_map>

#include "seams/trial_map.h"

namespace spectral_conformal {

/// The maps of the charts of one piece, looked up by chart in constant time.
class KnownMaps {
 public:
  KnownMaps() = default;
  explicit KnownMaps(const TrialMaps& maps);

  void add(const std::shared_ptr<const TrialMap>& mapped);
  bool contains(const std::shared_ptr<const TrialMap>& mapped) const;
  /// The first that was added of those with such a chart; null where there is none. Every cut makes copies of vertices
  /// or loops: a chart of the same faces with as many of both, by the same triangles, is the same.
  std::shared_ptr<const TrialMap> find(const Chart& chart) const;
  /// Of all charts together.
  std::int64_t n_vertices() const { return n_vertices_; }

 private:
  const TrialMaps* like(const Chart& chart) const;

  std::unordered_map<std::uint64_t, TrialMaps> maps_;  ///< by the first face of their charts and the number of faces
  std::int64_t n_vertices_ = 0;
};

}  // namespace spectral_conformal
