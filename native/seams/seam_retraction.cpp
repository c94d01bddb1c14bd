#include "seams/seam_retraction.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "concurrency/parallel_calls.h"

namespace spectral_conformal {
namespace {

/// After so many joint steps that were not allowed, the limits are near: then every step removes one part.
constexpr int max_joint_failures = 2;
/// Least rate of a joint step, as a fraction of that of its best part.
constexpr double least_joint_rate = 0.5;

class SeamRetraction {
 public:
  SeamRetraction(CutPiece& piece, std::int64_t max_vertices, const Progress& progress)
      : piece_(piece), progress_(progress), first_(piece.solved_vertices()), max_vertices_(max_vertices) {}

  bool run() {
    bool any = false;
    while (step()) any = true;
    return any;
  }

 private:
  /// Part of a chain, from one of its ends.
  struct Part {
    int first;  ///< the edge at the end, which names it
    int next;   ///< the edge that will be there without the part; -1 for a whole chain
    std::size_t size;
    SeamEdges removed;  ///< with images
    double rate;        ///< when this end was last tried; infinite if it was not
    double cost;
  };
  /// What is known of an end of a chain.
  struct End {
    double rate;
    std::size_t size;  ///< more cannot be removed
  };
  struct Step {
    Part part;
    SeamTrial trial;
  };

  bool has_time() const { return piece_.solved_vertices() - first_ < max_vertices_; }

  /// Seams saved per distortion added.
  double rate(const SeamTrial& trial) const {
    if (!trial.quality.solved) return 0;
    constexpr double almost_none = 1e-9;
    const double added = std::max(trial.quality.rms_excess - piece_.quality().rms_excess, almost_none);
    return std::max(piece_.seams_value() - trial.seams_value, 0.0) / added;
  }

  bool is_allowed(const SeamTrial& trial) const { return piece_.shortens(trial) && piece_.is_sound(trial); }

  /// Returns whether anything was removed.
  bool step() {
    std::vector<Step> possible;
    double best = -1;
    for (;;) {
      std::vector<Part> parts = worth_trying(possible, best);
      if (parts.empty() || !has_time()) break;
      std::vector<std::array<SeamEdges, 2>> changes;
      changes.reserve(parts.size());
      for (const Part& part : parts) changes.push_back({SeamEdges{}, part.removed});
      std::vector<SeamTrial> trials = piece_.attempt_all(changes, known_, progress_);
      for (std::size_t i = 0; i < trials.size(); ++i) {
        known_.insert(trials[i].charts.begin(), trials[i].charts.end());
        const double found = rate(trials[i]);
        const bool allowed = is_allowed(trials[i]);
        ends_[parts[i].first] = {found, allowed ? parts[i].size : parts[i].size / 2};
        if (!allowed) continue;
        best = std::max(best, found);
        possible.push_back({std::move(parts[i]), std::move(trials[i])});
      }
    }
    if (possible.empty()) return false;
    if (possible.size() > 1 && joint_failures_ < max_joint_failures) {
      if (remove_together(possible, best)) return true;
      ++joint_failures_;
    }
    Step& chosen = *std::max_element(possible.begin(), possible.end(), [&](const Step& a, const Step& b) {
      return ends_.at(a.part.first).rate < ends_.at(b.part.first).rate;
    });
    follow(chosen.part);
    piece_.apply(std::move(chosen.trial));
    return true;
  }

  bool remove_together(const std::vector<Step>& steps, double best) {
    SeamEdges all;
    for (const Step& one : steps) all.insert(all.end(), one.part.removed.begin(), one.part.removed.end());
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    SeamTrial joint = piece_.attempt({}, std::move(all), known_, progress_);
    if (!is_allowed(joint) || rate(joint) < least_joint_rate * best) return false;
    for (const Step& one : steps) follow(one.part);
    piece_.apply(std::move(joint));
    return true;
  }

  /// The edge that comes to the end takes over what is known of it.
  void follow(const Part& part) {
    if (part.next >= 0) ends_[part.next] = ends_.at(part.first);
  }

  /// A few parts whose rates may be above the best one, the most promising first.
  std::vector<Part> worth_trying(const std::vector<Step>& tried, double best) const {
    std::vector<Part> parts = removable();
    parts.erase(std::remove_if(parts.begin(), parts.end(),
                               [&](const Part& part) {
                                 return part.rate <= best ||
                                        std::any_of(tried.begin(), tried.end(),
                                                    [&](const Step& other) { return other.part.first == part.first; });
                               }),
                parts.end());
    std::stable_sort(parts.begin(), parts.end(),
                     [](const Part& a, const Part& b) { return a.rate != b.rate ? a.rate > b.rate : a.cost > b.cost; });
    parts.erase(parts.begin() + std::min<std::ptrdiff_t>(parts.end() - parts.begin(), tries_at_once), parts.end());
    return parts;
  }

  /// The largest part at each end that has not failed.
  std::vector<Part> removable() const {
    std::vector<Part> result;
    for (const SeamChain& chain : piece_.seams().chains()) {
      bool is_whole_there = false;
      for (const std::size_t end : {0, 1}) {
        SeamEdges edges = chain.edges;
        if (end == 1) std::reverse(edges.begin(), edges.end());
        const auto known = ends_.find(edges.front());
        const std::size_t limit = known == ends_.end() ? edges.size() : known->second.size;
        std::size_t size = std::min(edges.size(), limit);
        if (!can_be_parted(chain, end)) {
          if (size < edges.size()) continue;
        } else if (size == edges.size() && is_whole_there) {
          size /= 2;
        }
        if (size == 0 || (size == edges.size() && is_whole_there)) continue;
        is_whole_there = is_whole_there || size == edges.size();
        Part part{edges.front(), size < edges.size() ? edges[size] : -1, size, {}, infinity, 0};
        if (known != ends_.end()) part.rate = known->second.rate;
        edges.resize(size);
        part.removed = piece_.seams().with_cut_images(edges);
        part.cost = piece_.seams().cost(part.removed);
        if (part.cost > 0) result.push_back(std::move(part));
      }
    }
    return result;
  }

  /// Whether the rest would still meet other seams at the other end. Of a chain across the mirror plane, both ends
  /// would go.
  bool can_be_parted(const SeamChain& chain, std::size_t end) const {
    const bool crosses_plane = chain.is_own_image && piece_.seams().with_cut_images({chain.edges.front()}).size() > 1;
    return !chain.is_tip[1 - end] && !crosses_plane;
  }

  CutPiece& piece_;
  const Progress& progress_;
  std::int64_t first_;  ///< solved vertices at the start
  std::int64_t max_vertices_;
  std::map<int, End> ends_;  ///< by the edge at the end
  KnownMaps known_;          ///< of trials
  int joint_failures_ = 0;
};

}  // namespace

bool retract_seams(CutPiece& piece, std::int64_t max_vertices, const Progress& progress) {
  return SeamRetraction(piece, max_vertices, progress).run();
}

}  // namespace spectral_conformal
