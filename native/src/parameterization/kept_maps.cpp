#include "spectral_conformal/kept_maps.h"

#include <algorithm>
#include <utility>

namespace spectral_conformal {

const KeptMaps::Map* KeptMaps::find(const std::string& description) const {
  const auto found = maps_.find(description);
  return found == maps_.end() ? nullptr : &found->second.map;
}

void KeptMaps::keep(std::string&& description, Map&& map) {
  const std::size_t bytes = description.size() + static_cast<std::size_t>(map.z.size()) * sizeof(Complex) +
                            map.report.faces.size() * sizeof(int) + sizeof(Entry);
  if (bytes > max_bytes_) return;
  const auto [place, is_new] = maps_.try_emplace(std::move(description));
  Entry& entry = place->second;
  entry.last_use = ++use_;
  if (!is_new) return;
  entry.map = std::move(map);
  entry.bytes = bytes;
  bytes_ += bytes;
  while (bytes_ > max_bytes_) {
    const auto oldest = std::min_element(
        maps_.begin(), maps_.end(), [](const auto& a, const auto& b) { return a.second.last_use < b.second.last_use; });
    bytes_ -= oldest->second.bytes;
    maps_.erase(oldest);
  }
}

}  // namespace spectral_conformal
