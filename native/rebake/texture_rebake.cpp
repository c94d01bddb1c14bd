#include "spectral_conformal/texture_rebake.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>

#include "concurrency/cancellation_scope.h"
#include "concurrency/parallel_calls.h"
#include "concurrency/work_counter.h"
#include "graph/grouped.h"
#include "rebake/border_sides.h"
#include "rebake/tangent_turn.h"
#include "rebake/texel_coding.h"
#include "rebake/texture_lookup.h"
#include "rebake/triangle_samples.h"
#include "spectral_conformal/polygon_mesh.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {
namespace {

/// The sums of a tile of this side fit into a processor's second cache.
constexpr int tile_side = 64;

Complex uv_of(const double* uv, int corner) {
  const double* const entry = uv + 2 * static_cast<std::size_t>(corner);
  return {entry[0], entry[1]};
}

/// The place of a corner of a triangle in the target, in texels.
Complex place_in(const TargetImage& target, const MapPair& maps, int corner) {
  const Complex uv = uv_of(maps.new_uv, maps.triangles[corner]);
  return {uv.real() * target.width, (1 - uv.imag()) * target.height};
}

/// The samples of a triangle of the new map in the target.
TriangleSamples samples_of(const MapPair& maps, int triangle, const TargetImage& target) {
  std::array<Complex, 3> corners;
  for (int k = 0; k < 3; ++k) corners[static_cast<std::size_t>(k)] = place_in(target, maps, 3 * triangle + k);
  return TriangleSamples::of(corners);
}

/// An image as the source.
template <class Pixel>
class ImageSource {
 public:
  ImageSource(const ImageView& image, const MapPair& maps, const RebakeOptions& options, const TexelCoding& coding)
      : maps_(maps), size_(image.width, image.height), lookup_(image, coding, options) {
    turns_ = options.content == TextureContent::normals && image.n_channels >= 3;
  }

  /// The part of the source under a triangle.
  class Part {
   public:
    /// Sets the rates of the samples.
    Part(const ImageSource& source, int triangle, TriangleSamples& samples) : source_(source) {
      const int* const corners = source.maps_.triangles + 3 * static_cast<std::size_t>(triangle);
      for (std::size_t k = 0; k < 3; ++k) uv_[k] = uv_of(source.maps_.old_uv, corners[k]);
      const auto texels = [&](const PlaceInTriangle& change) {
        const Complex along = change.second * (uv_[1] - uv_[0]) + change.third * (uv_[2] - uv_[0]);
        return std::hypot(along.real() * source.size_.real(), along.imag() * source.size_.imag());
      };
      samples.set_rates(TriangleSamples::rate_for(texels(samples.change(0))),
                        TriangleSamples::rate_for(texels(samples.change(1))));
      if (source.turns_) turn_.emplace(source.maps_, corners);
    }
    bool exists() const { return is_finite(uv_[0]) && is_finite(uv_[1]) && is_finite(uv_[2]); }
    TexelValue at(PlaceInTriangle place) const {
      const Complex uv = place.between(uv_[0], uv_[1], uv_[2]);
      const TexelValue value = source_.lookup_.at(uv.real(), uv.imag());
      return turn_ ? turn_->turned(value, place) : value;
    }

   private:
    const ImageSource& source_;
    std::array<Complex, 3> uv_;
    std::optional<TangentTurn> turn_;
  };

 private:
  const MapPair& maps_;
  Complex size_;
  TextureLookup<Pixel> lookup_;
  bool turns_ = false;
};

/// Values at corners as the source.
class CornerSource {
 public:
  CornerSource(const float* values, const MapPair& maps, const TexelCoding& coding)
      : values_(values), maps_(maps), coding_(coding) {}

  class Part {
   public:
    /// Samples are at most the triangle's size apart, so that each of many small triangles counts.
    Part(const CornerSource& source, int triangle, TriangleSamples& samples) : n_(source.coding_.n_channels()) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto corner =
            static_cast<std::size_t>(source.maps_.triangles[3 * static_cast<std::size_t>(triangle) + k]);
        std::copy_n(source.values_ + corner * static_cast<std::size_t>(n_), n_, values_[k].begin());
        values_[k] = source.coding_.weighted(values_[k]);
      }
      const auto length = [](const PlaceInTriangle& change) {
        return std::max({std::abs(change.second), std::abs(change.third), std::abs(change.second + change.third)});
      };
      samples.set_rates(TriangleSamples::rate_for(length(samples.change(0))),
                        TriangleSamples::rate_for(length(samples.change(1))));
    }
    bool exists() const { return true; }
    TexelValue at(PlaceInTriangle place) const {
      TexelValue value{};
      for (std::size_t c = 0; c < static_cast<std::size_t>(n_); ++c) {
        value[c] = static_cast<float>(place.between<double>(values_[0][c], values_[1][c], values_[2][c]));
      }
      return value;
    }

   private:
    int n_;
    std::array<TexelValue, 3> values_{};
  };

 private:
  const float* values_;
  const MapPair& maps_;
  const TexelCoding& coding_;
};

/// The tiles of an image, row by row, and which of some items, such as triangles, have windows that meet each.
class Tiles {
 public:
  /// window_of(item): from 0 to n_items - 1, within the image.
  template <class WindowOf>
  Tiles(int n_items, const TargetImage& target, const WindowOf& window_of)
      : width_(target.width), height_(target.height), n_columns_((width_ + tile_side - 1) / tile_side) {
    const int n_rows = (height_ + tile_side - 1) / tile_side;
    double n_pairs = 0;
    const auto for_each_pair = [&](const auto& visit) {
      for_each_polled(n_items, [&](int item) {
        const TexelWindow box = window_of(item);
        if (box.x_begin >= box.x_end || box.y_begin >= box.y_end) return;
        for (int row = box.y_begin / tile_side; row <= (box.y_end - 1) / tile_side; ++row) {
          for (int column = box.x_begin / tile_side; column <= (box.x_end - 1) / tile_side; ++column) {
            if (++n_pairs > 2.0 * size_limit) throw std::length_error("too many triangles lie on each other");
            visit(row * n_columns_ + column, item);
          }
        }
      });
    };
    items_ = Grouped<int>(n_rows * n_columns_, for_each_pair);
  }

  int count() const { return items_.n_keys(); }
  TexelWindow window(int tile) const {
    const int x = tile % n_columns_ * tile_side;
    const int y = tile / n_columns_ * tile_side;
    return {x, std::min(x + tile_side, width_), y, std::min(y + tile_side, height_)};
  }
  auto items(int tile) const { return items_[tile]; }

 private:
  int width_;
  int height_;
  int n_columns_;
  Grouped<int> items_;
};

/// A weighted sum of samples.
struct TexelSum {
  TexelValue values{};
  float weight = 0;
};

/// Draws one tile of the target and marks its covered texels.
template <class Source>
void draw_tile(const Source& source, const MapPair& maps, const Tiles& tiles, int tile, const TexelCoding& coding,
               const TargetImage& target, std::vector<unsigned char>& covered) {
  const TexelWindow window = tiles.window(tile);
  std::vector<TexelSum> sums(tile_side * tile_side);
  const auto index = [&](int x, int y) {
    return static_cast<std::size_t>(y - window.y_begin) * tile_side + static_cast<std::size_t>(x - window.x_begin);
  };
  for (const int triangle : tiles.items(tile)) {
    TriangleSamples samples = samples_of(maps, triangle, target);
    const typename Source::Part part(source, triangle, samples);
    if (!part.exists()) continue;
    const auto weight = static_cast<float>(samples.weight());
    int n_samples = 0;
    samples.for_each(window, [&](int x, int y, PlaceInTriangle place) {
      const TexelValue value = part.at(place);
      TexelSum& sum = sums[index(x, y)];
      for (std::size_t c = 0; c < value.size(); ++c) sum.values[c] += weight * value[c];
      sum.weight += weight;
      ++n_samples;
    });
    count_steps(n_samples);
    poll(10 + n_samples);
  }
  for (int y = window.y_begin; y < window.y_end; ++y) {
    for (int x = window.x_begin; x < window.x_end; ++x) {
      TexelSum& sum = sums[index(x, y)];
      if (!(sum.weight > 0)) continue;
      for (float& value : sum.values) value /= sum.weight;
      const std::size_t texel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(target.width) + static_cast<std::size_t>(x);
      coding.encode(sum.values, target.pixels, texel);
      target.coverage[texel] = full_coverage;
      covered[texel] = 1;
    }
  }
}

/// A side of a triangle of the new map in the target.
class BorderSide {
 public:
  BorderSide(const MapPair& maps, int number, const TargetImage& target)
      : triangle_(number / 3),
        from_(place_in(target, maps, number)),
        along_(place_in(target, maps, number % 3 == 2 ? number - 2 : number + 1) - from_) {}

  int triangle() const { return triangle_; }
  /// The part of a window whose texels have centers up to 1 beyond the side along either axis.
  TexelWindow part_of(const TexelWindow& window) const {
    const auto [left, right] = std::minmax({from_.real(), (from_ + along_).real()});
    const auto [low, high] = std::minmax({from_.imag(), (from_ + along_).imag()});
    return {bounded(left - 1.5, window.x_begin, window.x_end), bounded(right + 1.5, window.x_begin, window.x_end),
            bounded(low - 1.5, window.y_begin, window.y_end), bounded(high + 1.5, window.y_begin, window.y_end)};
  }
  /// Likewise in one row of a window.
  TexelWindow in_row(int y, const TexelWindow& window) const {
    double first = 0;
    double last = 1;
    if (along_.imag() != 0) {
      const auto [begin, end] =
          std::minmax({(y - 0.5 - from_.imag()) / along_.imag(), (y + 1.5 - from_.imag()) / along_.imag()});
      first = std::max(first, begin);
      last = std::min(last, end);
    }
    if (!(first <= last)) return {};
    const auto [left, right] = std::minmax({from_.real() + first * along_.real(), from_.real() + last * along_.real()});
    return {bounded(left - 1.5, window.x_begin, window.x_end), bounded(right + 1.5, window.x_begin, window.x_end), y,
            y + 1};
  }
  /// The point of the side that is nearest to another.
  Complex nearest(Complex point) const {
    const double share = (std::conj(along_) * (point - from_)).real() / std::norm(along_);
    return from_ + std::min(std::max(0.0, share), 1.0) * along_;
  }

 private:
  static int bounded(double t, int low, int high) {
    return static_cast<int>(std::min(std::max(static_cast<double>(low), std::ceil(t)), static_cast<double>(high)));
  }

  int triangle_;
  Complex from_;
  Complex along_;
};

/// Of the texels that a border draws, in squared distances from it: points of islands are between four centers.
constexpr double squared_reach = 2;

/// The coverage of a texel without samples at a squared distance below `squared_reach`.
unsigned char coverage_at(double distance) {
  return static_cast<unsigned char>(full_coverage - 1 -
                                    static_cast<int>((full_coverage - 1) * distance / squared_reach));
}

/// Gives the texels of one tile that have no samples, but lie beside islands, what the source has at the nearest point
/// of a border, so that what is shown there stays the same up to the border. Those nearer to a border that was drawn
/// before stay.
template <class Source>
void draw_borders(const Source& source, const MapPair& maps, const std::vector<int>& sides, const Tiles& tiles,
                  int tile, const TexelCoding& coding, const TargetImage& target) {
  const TexelWindow window = tiles.window(tile);
  std::vector<TexelValue> values(tile_side * tile_side);
  std::vector<double> distances(tile_side * tile_side, squared_reach);
  for (const int number : tiles.items(tile)) {
    const BorderSide side(maps, sides[static_cast<std::size_t>(number)], target);
    // Most sides of meshes with corners for each triangle are inside an island: nothing is computed for them.
    std::optional<TriangleSamples> samples;
    std::optional<typename Source::Part> part;
    int n_samples = 0;
    const TexelWindow box = side.part_of(window);
    for (int y = box.y_begin; y < box.y_end; ++y) {
      const TexelWindow row = side.in_row(y, box);
      for (int x = row.x_begin; x < row.x_end; ++x) {
        const std::size_t texel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(target.width) + static_cast<std::size_t>(x);
        if (target.coverage[texel] == full_coverage) continue;
        const std::size_t here =
            static_cast<std::size_t>(y - window.y_begin) * tile_side + static_cast<std::size_t>(x - window.x_begin);
        const Complex center{x + 0.5, y + 0.5};
        const Complex point = side.nearest(center);
        const double distance = std::norm(center - point);
        if (!(distance < distances[here])) continue;
        if (!samples) {
          samples = samples_of(maps, side.triangle(), target);
          part.emplace(source, side.triangle(), *samples);
        }
        if (!samples->has_area() || !part->exists()) break;
        distances[here] = distance;
        values[here] = part->at(samples->place(point.real(), point.imag()));
        ++n_samples;
      }
    }
    count_steps(n_samples);
    poll(10 + n_samples);
  }
  for (int y = window.y_begin; y < window.y_end; ++y) {
    for (int x = window.x_begin; x < window.x_end; ++x) {
      const std::size_t here =
          static_cast<std::size_t>(y - window.y_begin) * tile_side + static_cast<std::size_t>(x - window.x_begin);
      if (!(distances[here] < squared_reach)) continue;
      const std::size_t texel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(target.width) + static_cast<std::size_t>(x);
      const unsigned char coverage = coverage_at(distances[here]);
      if (coverage <= target.coverage[texel]) continue;
      coding.encode(values[here], target.pixels, texel);
      target.coverage[texel] = coverage;
    }
  }
}

template <class Source>
std::vector<unsigned char> draw(const Source& source, const MapPair& maps, const TexelCoding& coding,
                                const TargetImage& target, const Progress& progress) {
  const CancellationScope scope(progress, "rebake");
  std::vector<unsigned char> covered(static_cast<std::size_t>(target.width) * static_cast<std::size_t>(target.height));
  const Tiles tiles(maps.n_triangles, target, [&](int triangle) {
    return samples_of(maps, triangle, target).window(target.width, target.height);
  });
  std::atomic<int> n_done{0};
  run_in_parallel(
      tiles.count(),
      [&](int tile, const Progress& heard) {
        draw_tile(source, maps, tiles, tile, coding, target, covered);
        const int percent = 100 * n_done / tiles.count();
        if (100 * ++n_done / tiles.count() > percent) report(heard, 0.009 * percent, "rebake");
      },
      scope.progress(), "rebake");
  report(scope.progress(), 0.9, "rebake");
  const std::vector<int> sides = border_sides(maps.triangles, maps.n_triangles);
  const TexelWindow whole{0, target.width, 0, target.height};
  const Tiles beside(static_cast<int>(sides.size()), target, [&](int number) {
    return BorderSide(maps, sides[static_cast<std::size_t>(number)], target).part_of(whole);
  });
  run_in_parallel(
      beside.count(),
      [&](int tile, const Progress&) { draw_borders(source, maps, sides, beside, tile, coding, target); },
      scope.progress(), "rebake");
  report(scope.progress(), 1.0, "rebake");
  return covered;
}

}  // namespace

std::vector<unsigned char> rebake_texture(const ImageView& source, const MapPair& maps, const RebakeOptions& options,
                                          const TargetImage& target, const Progress& progress) {
  const TexelCoding coding = TexelCoding::of(source.type, source.n_channels, options);
  const TexelCoding target_coding = TexelCoding::of(target.type, target.n_channels, options);
  const auto drawn = [&](auto pixel) {
    return draw(ImageSource<decltype(pixel)>(source, maps, options, coding), maps, target_coding, target, progress);
  };
  if (source.type == PixelType::uint8) return drawn(std::uint8_t{});
  if (source.type == PixelType::uint16) return drawn(std::uint16_t{});
  return drawn(float{});
}

std::vector<unsigned char> bake_corner_values(const float* values, const MapPair& maps, const RebakeOptions& options,
                                              const TargetImage& target, const Progress& progress) {
  const TexelCoding given = TexelCoding::of(PixelType::float32, target.n_channels, options);
  const TexelCoding coding = TexelCoding::of(target.type, target.n_channels, options);
  return draw(CornerSource(values, maps, given), maps, coding, target, progress);
}

}  // namespace spectral_conformal
