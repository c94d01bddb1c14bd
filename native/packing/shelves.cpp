#include "packing/shelves.h"

#include <algorithm>
#include <cmath>

#include "concurrency/cancellation_scope.h"
#include "packing/max_treap.h"

namespace spectral_conformal {
namespace {

struct Shelf {
  std::vector<std::size_t> boxes;
  double room;  ///< the width that is left
};

std::vector<Shelf> first_fit(double width, const std::vector<std::size_t>& order, const std::vector<PackedBox>& boxes) {
  std::vector<Shelf> shelves;
  MaxTreap rooms;
  for (const std::size_t i : order) {
    poll();
    // Also rooms of exactly its width.
    int found = rooms.first_above(std::nextafter(boxes[i].width, -1.0));
    if (found == MaxTreap::none) {
      found = static_cast<int>(shelves.size());
      shelves.push_back({{}, width});
      rooms.insert_before(MaxTreap::none, found, width);
    }
    Shelf& shelf = shelves[static_cast<std::size_t>(found)];
    shelf.boxes.push_back(i);
    shelf.room -= boxes[i].width;
    rooms.set_value(found, shelf.room);
  }
  return shelves;
}

}  // namespace

void put_on_shelves(double width, const std::vector<std::size_t>& order, std::vector<PackedBox>& boxes) {
  // The pieces of a shelf from left to right: its boxes and the rest of the strip.
  std::vector<PackedBox> below{{0, 0, width, 0}};
  bool falls_to_the_right = true;
  for (Shelf& shelf : first_fit(width, order, boxes)) {
    if (!falls_to_the_right) std::reverse(shelf.boxes.begin(), shelf.boxes.end());
    std::vector<PackedBox> pieces;
    std::size_t under = 0;
    double x = 0;
    const auto put = [&](PackedBox& box) {
      box.x = x;
      box.y = 0;
      x += box.width;
      while (under + 1 < below.size() && below[under + 1].x <= box.x) ++under;
      for (std::size_t k = under; k < below.size() && (k == under || below[k].x < x); ++k) {
        box.y = std::max(box.y, below[k].y + below[k].height);
      }
      pieces.push_back(box);
    };
    PackedBox rest{0, 0, shelf.room, 0};
    if (!falls_to_the_right) put(rest);
    for (const std::size_t i : shelf.boxes) put(boxes[i]);
    if (falls_to_the_right) put(rest);
    below = std::move(pieces);
    falls_to_the_right = !falls_to_the_right;
  }
}

}  // namespace spectral_conformal
