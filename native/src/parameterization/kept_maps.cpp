#include "spectral_conformal/kept_maps.h"

#include <iterator>
#include <string>
#include <utility>

namespace spectral_conformal {

const KeptMaps::Map* KeptMaps::find(const std::string& description) const {
  const auto found = entries_.find(description);
  return found == entries_.end() ? nullptr : &found->second->map;
}

void KeptMaps::keep(std::string&& description, Map&& map) {
  if (const auto found = entries_.find(description); found != entries_.end()) {
    by_use_.splice(by_use_.end(), by_use_, found->second);
    return;
  }
  const std::size_t bytes = description.size() + static_cast<std::size_t>(map.z.size()) * sizeof(Complex) +
                            map.report.faces.size() * sizeof(int) + sizeof(Entry);
  if (bytes > max_bytes_) return;
  by_use_.push_back({std::move(description), std::move(map), bytes});
  bytes_ += bytes;
  entries_.emplace(by_use_.back().description, std::prev(by_use_.end()));
  while (bytes_ > max_bytes_) {
    const Entry& oldest = by_use_.front();
    bytes_ -= oldest.bytes;
    entries_.erase(oldest.description);
    by_use_.pop_front();
  }
}

}  // namespace spectral_conformal
