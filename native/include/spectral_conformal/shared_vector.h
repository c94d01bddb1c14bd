#pragma once

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

namespace spectral_conformal {

/// An immutable vector that its copies share, so that objects on one surface hold its data once. Copies may be made and
/// used in several threads at once.
template <class T>
class SharedVector {
 public:
  SharedVector() : SharedVector(std::vector<T>{}) {}
  SharedVector(std::vector<T> values)  // NOLINT(google-explicit-constructor): a drop-in for a vector
      : values_(std::make_shared<const std::vector<T>>(std::move(values))) {}
  SharedVector(std::initializer_list<T> values) : SharedVector(std::vector<T>(values)) {}

  operator const std::vector<T>&() const { return *values_; }  // NOLINT(google-explicit-constructor): as above
  const std::vector<T>& vector() const { return *values_; }
  const T& operator[](std::size_t i) const { return (*values_)[i]; }
  std::size_t size() const { return values_->size(); }
  auto begin() const { return values_->begin(); }
  auto end() const { return values_->end(); }

  friend bool operator==(const SharedVector& a, const SharedVector& b) { return *a.values_ == *b.values_; }

 private:
  std::shared_ptr<const std::vector<T>> values_;
};

}  // namespace spectral_conformal
