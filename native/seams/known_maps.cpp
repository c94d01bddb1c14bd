#include "seams/known_maps.h"

#include <algorithm>

#include "concurrency/work_counter.h"

namespace spectral_conformal {
namespace {

std::uint64_t key_of(const Chart& chart) {
  return (static_cast<std::uint64_t>(chart.faces.size()) << 32U) + static_cast<std::uint32_t>(chart.faces.front());
}

}  // namespace

KnownMaps::KnownMaps(const TrialMaps& maps) {
  for (const auto& mapped : maps) add(mapped);
}

void KnownMaps::add(const std::shared_ptr<const TrialMap>& mapped) { maps_[key_of(mapped->chart)].push_back(mapped); }

bool KnownMaps::contains(const std::shared_ptr<const TrialMap>& mapped) const {
  const TrialMaps* const some = like(mapped->chart);
  return some != nullptr && std::find(some->begin(), some->end(), mapped) != some->end();
}

std::shared_ptr<const TrialMap> KnownMaps::find(const Chart& chart) const {
  const TrialMaps* const some = like(chart);
  if (some == nullptr) return nullptr;
  const auto same = std::find_if(some->begin(), some->end(), [&](const auto& mapped) {
    const Chart& other = mapped->chart;
    return other.vertices == chart.vertices && other.boundary_loops.size() == chart.boundary_loops.size() &&
           other.faces == chart.faces && other.triangles == chart.triangles;
  });
  return same == some->end() ? nullptr : *same;
}

const TrialMaps* KnownMaps::like(const Chart& chart) const {
  const auto some = maps_.find(key_of(chart));
  count_steps(1);
  if (some == maps_.end()) return nullptr;
  count_steps(static_cast<double>(some->second.size()));
  return &some->second;
}

}  // namespace spectral_conformal
