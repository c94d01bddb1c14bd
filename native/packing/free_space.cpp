#include "packing/free_space.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "concurrency/cancellation_scope.h"

namespace spectral_conformal {
namespace {

int lowest_bit(std::uint64_t word) { return std::ilogb(static_cast<double>(word & (~word + 1))); }

}  // namespace

FreeSpace::FreeSpace(int width, int height)
    : width_(width),
      height_(height),
      // One more word: a shifted read takes its bits from two.
      n_words_((width + bits - 1) / bits + 1),
      n_levels_(std::ilogb(std::max(1, width)) + 1),
      words_(static_cast<std::size_t>(height) * static_cast<std::size_t>(n_levels_) *
             static_cast<std::size_t>(n_words_)),
      highest_free_(static_cast<std::size_t>(height), n_levels_ - 1) {
  // Beyond the width, all is taken.
  for (int row = 0; row < height; ++row) {
    Word* const word = words(row, 0);
    for (int x = width; x < n_words_ * bits; ++x) word[x / bits] |= Word{1} << (x % bits);
    update_levels(row, width, n_words_ * bits);
  }
}

std::vector<CellSpan> FreeSpace::taken() const {
  std::vector<CellSpan> spans;
  for (int row = 0; row < height_; ++row) {
    const Word* const word = words(row, 0);
    const auto is_taken = [&](int x) { return (word[x / bits] >> (x % bits) & 1) != 0; };
    for (int x = 0; x < width_; ++x) {
      if (!is_taken(x)) continue;
      const int begin = x;
      while (x < width_ && is_taken(x)) ++x;
      spans.push_back({row, begin, x});
    }
  }
  return spans;
}

void FreeSpace::occupy(const std::vector<CellSpan>& spans, CellPosition at) {
  for (const CellSpan& span : spans) {
    const int row = at.y + span.row;
    const int begin = std::max(0, at.x + span.begin);
    const int end = std::min(width_, at.x + span.end);
    if (row < 0 || row >= height_ || begin >= end) continue;
    Word* const word = words(row, 0);
    for (int x = begin; x < end;) {
      const int stop = std::min(end, (x / bits + 1) * bits);
      const Word ones = stop - x == bits ? ~Word{0} : (Word{1} << (stop - x)) - 1;
      word[x / bits] |= ones << (x % bits);
      x = stop;
    }
    update_levels(row, begin, end);
  }
}

void FreeSpace::update_levels(int row, int begin, int end) {
  const int last = std::min(n_words_ - 1, (end - 1) / bits);
  for (int level = 1; level < n_levels_; ++level) {
    const int step = 1 << (level - 1);
    const Word* const below = words(row, level - 1);
    Word* const word = words(row, level);
    const int first = std::max(0, begin - 2 * step + 1) / bits;
    const int skip = step / bits;
    const int shift = step % bits;
    for (int i = first; i <= last; ++i) {
      // Beyond the last word, all is taken.
      const Word low = i + skip < n_words_ ? below[i + skip] : ~Word{0};
      const Word high = i + skip + 1 < n_words_ ? below[i + skip + 1] : ~Word{0};
      word[i] = below[i] | (shift == 0 ? low : low >> shift | high << (bits - shift));
    }
  }
  int& highest = highest_free_[static_cast<std::size_t>(row)];
  const auto is_full = [&](int level) {
    const Word* const word = words(row, level);
    return std::all_of(word, word + n_words_, [](Word w) { return w == ~Word{0}; });
  };
  while (highest >= 0 && is_full(highest)) --highest;
}

FreeSpace::Window FreeSpace::window(const IslandRaster& raster, int bottom, int top) const {
  return {0, width_ - raster.width(), bottom, top - raster.height()};
}

std::optional<CellPosition> FreeSpace::lowest(const IslandRaster& raster, const Window& window,
                                              double& all_looks) const {
  if (window.x_begin > window.x_end) return std::nullopt;
  const auto& spans = raster.longest_first();
  // Rows without room for a span are skipped without reading their words.
  const int first_word = window.x_begin / bits;
  const int last_word = window.x_end / bits;
  double looks = 0;
  std::optional<CellPosition> found;
  for (int y = window.y_begin; y <= window.y_end && !found; ++y) {
    looks += 1;
    const auto has_room = [&](const CoveredSpan& span) {
      const int row = y + span.row;
      return highest_free_[static_cast<std::size_t>(row)] >= span.level;
    };
    if (!std::all_of(spans.begin(), spans.end(), has_room)) continue;
    for (int i = first_word; i <= last_word && !found; ++i) {
      Word fits = ~Word{0};
      if (i == first_word) fits &= ~Word{0} << (window.x_begin % bits);
      if (i == last_word && window.x_end % bits != bits - 1) fits &= (Word{1} << (window.x_end % bits + 1)) - 1;
      for (const CoveredSpan& span : spans) {
        const Word* const word = words(y + span.row, span.level) + i;
        const auto taken = [&](int x) {
          const int shift = x % bits;
          const Word* const at = word + x / bits;
          return shift == 0 ? at[0] : at[0] >> shift | at[1] << (bits - shift);
        };
        fits &= ~(taken(span.first) | taken(span.second));
        looks += 1;
        if (fits == 0) break;
      }
      if (fits != 0) found = CellPosition{i * bits + lowest_bit(fits), y};
    }
  }
  all_looks += looks;
  poll(looks);
  return found;
}

}  // namespace spectral_conformal
