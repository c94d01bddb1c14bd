#include "spectral_conformal/kept_maps.h"

#include <algorithm>
#include <functional>
#include <string>
#include <utility>

namespace spectral_conformal {

std::size_t KeptMaps::SampledHash::operator()(const std::string& description) const {
  constexpr std::size_t n_samples = 64;
  constexpr std::size_t sample_size = 64;
  if (description.size() <= n_samples * sample_size) return std::hash<std::string>()(description);
  std::string samples = std::to_string(description.size());
  const std::size_t last = description.size() - sample_size;
  for (std::size_t k = 0; k < n_samples; ++k) samples.append(description, last / (n_samples - 1) * k, sample_size);
  return std::hash<std::string>()(samples);
}

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
