#include "geometry/triangle_sweep.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <set>

#include "concurrency/cancellation_scope.h"
#include "geometry/orientation.h"

namespace spectral_conformal {
namespace {

/// A triangle as seen by the sweep line.
struct SweptTriangle {
  Complex first;
  Complex middle;
  Complex last;
  bool bends_up;  ///< the middle corner lies above the long side, from the first to the last one
};

SweptTriangle swept(std::array<Complex, 3> corners) {
  std::sort(corners.begin(), corners.end(), is_left_of);
  return {corners[0], corners[1], corners[2], orientation(corners[0], corners[2], corners[1]) > 0};
}

/// Whether the interiors of two counterclockwise triangles meet: no side of either separates them.
bool interiors_meet(const std::array<Complex, 3>& a, const std::array<Complex, 3>& b) {
  const auto has_side_between = [](const std::array<Complex, 3>& triangle, const std::array<Complex, 3>& other) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto is_beyond = [&](Complex p) { return orientation(triangle[k], triangle[(k + 1) % 3], p) <= 0; };
      if (std::all_of(other.begin(), other.end(), is_beyond)) return true;
    }
    return false;
  };
  return !has_side_between(a, b) && !has_side_between(b, a);
}

class TriangleSweep {
 public:
  TriangleSweep(const std::vector<std::array<Complex, 3>>& triangles,
                const std::function<int(int first, int second)>& leave_out)
      : triangles_(triangles), leave_out_(leave_out), line_(Above{this}), places_(triangles.size(), line_.end()) {
    swept_.reserve(triangles.size());
    for (const auto& corners : triangles) swept_.push_back(swept(corners));
  }

  void run() {
    std::vector<Event> events;
    events.reserve(2 * swept_.size());
    for (std::size_t t = 0; t < swept_.size(); ++t) {
      events.push_back({swept_[t].first, true, static_cast<int>(t)});
      events.push_back({swept_[t].last, false, static_cast<int>(t)});
    }
    std::sort(events.begin(), events.end());
    for (const Event& event : events) {
      poll();
      event.begins ? begin(event.triangle) : end(event.triangle);
      if (is_ended_) return;
    }
  }

 private:
  /// A start or end of a triangle. At the same point ends come first: triangles that meet only there have disjoint
  /// interiors.
  struct Event {
    Complex point;
    bool begins;
    int triangle;

    bool operator<(const Event& other) const {
      if (point != other.point) return is_left_of(point, other.point);
      return begins != other.begins ? other.begins : triangle < other.triangle;
    }
  };

  /// The order along the line.
  struct Above {
    const TriangleSweep* sweep;
    bool operator()(int t, int other) const {
      return t == sweep->begun_ ? sweep->begins_below(sweep->swept_[static_cast<std::size_t>(other)])
                                : !sweep->begins_below(sweep->swept_[static_cast<std::size_t>(t)]);
    }
  };
  using Line = std::multiset<int, Above>;

  /// Whether the starting triangle lies below another on the line. If the two meet there, either answer will do.
  bool begins_below(const SweptTriangle& other) const {
    const SweptTriangle& own = swept_[static_cast<std::size_t>(begun_)];
    const Complex p = own.first;
    if (p == other.first) {
      const int middle = orientation(other.first, other.last, own.middle);
      const int last = orientation(other.first, other.last, own.last);
      return other.bends_up ? middle <= 0 && last <= 0 : middle < 0 || last < 0;
    }
    const int beside_long_side = orientation(other.first, other.last, p);
    const auto beside_short_sides = [&] {
      return is_left_of(p, other.middle) ? orientation(other.first, other.middle, p)
                                         : orientation(other.middle, other.last, p);
    };
    if (other.bends_up) return beside_long_side <= 0 || beside_short_sides() < 0;
    return beside_long_side < 0 && beside_short_sides() <= 0;
  }

  void begin(int t) {
    begun_ = t;
    const auto place = line_.insert(t);
    places_[static_cast<std::size_t>(t)] = place;
    clear_below(place);
    if (is_on_line(t)) clear_below(std::next(place));
  }

  void end(int t) {
    if (is_on_line(t)) clear_below(take_out(places_[static_cast<std::size_t>(t)]));
  }

  bool is_on_line(int t) const { return places_[static_cast<std::size_t>(t)] != line_.end(); }
  Line::iterator take_out(Line::iterator place) {
    places_[static_cast<std::size_t>(*place)] = line_.end();
    return line_.erase(place);
  }

  /// Removes triangles until the one at this position of the line does not meet the one below it.
  void clear_below(Line::iterator place) {
    while (!is_ended_ && place != line_.end() && place != line_.begin()) {
      const auto below = std::prev(place);
      if (!interiors_meet(at(below), at(place))) return;
      const int out = leave_out_(*below, *place);
      is_ended_ = out < 0;
      if (is_ended_) return;
      if (out == *place) {
        place = take_out(place);
      } else {
        take_out(below);
      }
    }
  }

  const std::array<Complex, 3>& at(Line::iterator place) const { return triangles_[static_cast<std::size_t>(*place)]; }

  const std::vector<std::array<Complex, 3>>& triangles_;
  const std::function<int(int first, int second)>& leave_out_;
  std::vector<SweptTriangle> swept_;
  int begun_ = -1;                      ///< the last triangle that began
  Line line_;                           ///< triangles that meet the line, from below
  std::vector<Line::iterator> places_;  ///< per triangle; end() if not on the line
  bool is_ended_ = false;
};

}  // namespace

void sweep_triangles(const std::vector<std::array<Complex, 3>>& triangles,
                     const std::function<int(int first, int second)>& leave_out) {
  TriangleSweep(triangles, leave_out).run();
}

}  // namespace spectral_conformal
