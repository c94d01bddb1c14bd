#pragma once

#include <cstddef>
#include <new>
#include <utility>
#include <vector>

namespace spectral_conformal {

/// Allocates memory for arrays; large ones request large pages where available (Linux). Otherwise a factor of a
/// gigabyte takes a quarter of a million page faults. Throws std::bad_alloc.
void* allocate_pages(std::size_t size);
/// size: as requested.
void free_pages(void* memory, std::size_t size) noexcept;

/// An allocator based on these functions. Default-constructed numbers stay uninitialized, so that the thread that
/// writes them first touches their pages.
template <class T>
struct LargePages {
  using value_type = T;

  LargePages() = default;
  template <class Other>
  LargePages(const LargePages<Other>&) noexcept {}  // NOLINT(google-explicit-constructor): allocators are converted

  T* allocate(std::size_t n) {
    if (n > static_cast<std::size_t>(-1) / sizeof(T)) throw std::bad_alloc();
    return static_cast<T*>(allocate_pages(n * sizeof(T)));
  }
  void deallocate(T* memory, std::size_t n) noexcept { free_pages(memory, n * sizeof(T)); }

  template <class U>
  void construct(U* place) {
    ::new (static_cast<void*>(place)) U;
  }
  template <class U, class... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
  }

  friend bool operator==(const LargePages&, const LargePages&) { return true; }
  friend bool operator!=(const LargePages&, const LargePages&) { return false; }
};

template <class T>
using LargeVector = std::vector<T, LargePages<T>>;

}  // namespace spectral_conformal
