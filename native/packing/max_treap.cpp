#include "packing/max_treap.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "graph/mixed_bits.h"

namespace spectral_conformal {
namespace {

/// Pseudo-random, and different for different items.
std::uint64_t priority(int item) { return mixed_bits(static_cast<std::uint64_t>(item) + 1); }

}  // namespace

void MaxTreap::insert_before(int at, int item, double value) {
  if (static_cast<std::size_t>(item) >= nodes_.size()) nodes_.resize(static_cast<std::size_t>(item) + 1);
  Node added;
  added.value = added.largest = value;
  // A leaf: beside `at`, or last among those before it.
  int side = 0;
  int parent = at;
  if (at == none || node(at).child[0] != none) {
    side = 1;
    parent = at == none ? root_ : node(at).child[0];
    while (parent != none && node(parent).child[1] != none) parent = node(parent).child[1];
  }
  added.parent = parent;
  node(item) = added;
  if (parent == none) {
    root_ = item;
    return;
  }
  node(parent).child[side] = item;
  update_up(parent);
  while (node(item).parent != none && priority(item) > priority(node(item).parent)) rotate_up(item);
}

void MaxTreap::erase(int item) {
  while (node(item).child[0] != none && node(item).child[1] != none) {
    const int before = node(item).child[0];
    const int behind = node(item).child[1];
    rotate_up(priority(before) > priority(behind) ? before : behind);
  }
  const int parent = node(item).parent;
  replace(item, node(item).child[0] != none ? node(item).child[0] : node(item).child[1]);
  update_up(parent);
}

void MaxTreap::set_value(int item, double value) {
  node(item).value = value;
  update_up(item);
}

int MaxTreap::next_above(int item, double limit) const { return nearest_above(item, limit, 1); }
int MaxTreap::previous_above(int item, double limit) const { return nearest_above(item, limit, 0); }

int MaxTreap::nearest_above(int item, double limit, int side) const {
  const int below = node(item).child[side];
  if (has_above(below, limit)) return outermost_above(below, limit, 1 - side);
  for (; node(item).parent != none; item = node(item).parent) {
    if (side_of(item) == side) continue;
    const int parent = node(item).parent;
    if (node(parent).value > limit) return parent;
    const int beyond = node(parent).child[side];
    if (has_above(beyond, limit)) return outermost_above(beyond, limit, 1 - side);
  }
  return none;
}

int MaxTreap::outermost_above(int item, double limit, int side) const {
  if (!has_above(item, limit)) return none;
  for (;;) {
    if (has_above(node(item).child[side], limit)) {
      item = node(item).child[side];
    } else if (node(item).value > limit) {
      return item;
    } else {
      item = node(item).child[1 - side];
    }
  }
}

double MaxTreap::largest_below(int item) const {
  double largest = node(item).value;
  for (const int child : node(item).child) {
    if (child != none) largest = std::max(largest, node(child).largest);
  }
  return largest;
}

void MaxTreap::update_up(int item) {
  for (; item != none; item = node(item).parent) {
    const double largest = largest_below(item);
    if (largest == node(item).largest) return;
    node(item).largest = largest;
  }
}

void MaxTreap::replace(int item, int by) {
  const int parent = node(item).parent;
  if (by != none) node(by).parent = parent;
  if (parent == none) {
    root_ = by;
  } else {
    node(parent).child[side_of(item)] = by;
  }
}

void MaxTreap::rotate_up(int item) {
  const int parent = node(item).parent;
  const int side = side_of(item);
  const int moved = node(item).child[1 - side];
  replace(parent, item);
  node(parent).child[side] = moved;
  if (moved != none) node(moved).parent = parent;
  node(item).child[1 - side] = parent;
  node(parent).parent = item;
  node(item).largest = node(parent).largest;
  node(parent).largest = largest_below(parent);
}

}  // namespace spectral_conformal
