#include "linear_algebra/large_pages.h"

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace spectral_conformal {
namespace {

#ifdef MADV_HUGEPAGE
/// The size of Linux's large pages on common processors.
constexpr std::size_t page = std::size_t{1} << 21;
/// Smaller arrays gain little.
constexpr bool is_large(std::size_t size) { return size >= 2 * page; }
#endif

}  // namespace

void* allocate_pages(std::size_t size) {
#ifdef MADV_HUGEPAGE
  if (is_large(size)) {
    void* const memory = ::operator new(size, std::align_val_t(page));
    // Only a hint: if the system declines it, pages are small.
    madvise(memory, size / page * page, MADV_HUGEPAGE);
    return memory;
  }
#endif
  return ::operator new(size);
}

void free_pages(void* memory, [[maybe_unused]] std::size_t size) noexcept {
#ifdef MADV_HUGEPAGE
  if (is_large(size)) {
    ::operator delete(memory, std::align_val_t(page));
    return;
  }
#endif
  ::operator delete(memory);
}

}  // namespace spectral_conformal
