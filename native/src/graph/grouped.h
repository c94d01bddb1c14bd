#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

namespace spectral_conformal {

/// Values grouped by keys from 0 to n_keys - 1 (compressed sparse rows). The values of a key keep their input order.
template <class T>
class Grouped {
 public:
  template <class Iterator>
  struct Range {
    Iterator first;
    Iterator last;
    Iterator begin() const { return first; }
    Iterator end() const { return last; }
    int size() const { return static_cast<int>(last - first); }
    bool empty() const { return first == last; }
  };

  Grouped() = default;
  /// `for_each(visit)` calls visit(key, value) for every value. It is called twice and must visit the same values in
  /// the same order.
  template <class ForEach>
  Grouped(int n_keys, const ForEach& for_each) : start_(static_cast<std::size_t>(n_keys) + 1, 0) {
    for_each([&](int key, const T&) { ++start_[static_cast<std::size_t>(key) + 1]; });
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    values_.resize(static_cast<std::size_t>(start_.back()));
    std::vector<int> next(start_.begin(), start_.end() - 1);
    for_each([&](int key, const T& value) { values_[next[key]++] = value; });
  }

  int n_keys() const { return static_cast<int>(start_.size()) - 1; }
  /// All values, key by key.
  const std::vector<T>& values() const { return values_; }
  /// The values [first(key), first(key + 1)) belong to the key.
  int first(int key) const { return start_[key]; }
  Range<const T*> operator[](int key) const { return {values_.data() + start_[key], values_.data() + end(key)}; }
  Range<T*> operator[](int key) { return {values_.data() + start_[key], values_.data() + end(key)}; }

 private:
  int end(int key) const { return start_[static_cast<std::size_t>(key) + 1]; }

  std::vector<int> start_{0};
  std::vector<T> values_;
};

}  // namespace spectral_conformal
