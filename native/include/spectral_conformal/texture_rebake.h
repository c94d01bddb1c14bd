#pragma once

#include <array>
#include <vector>

#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// How a number is stored; integers stand for 0 to 1.
enum class PixelType { uint8, uint16, float32 };

/// An image in the caller's memory: rows from the top, channels side by side.
template <class Pixels>
struct ImageOf {
  Pixels* pixels = nullptr;
  PixelType type = PixelType::uint8;
  int width = 0;
  int height = 0;
  int n_channels = 0;
};
using ImageView = ImageOf<const void>;

/// An image that is drawn piece by piece.
struct TargetImage : ImageOf<void> {
  /// (height, width): full_coverage for texels with samples; for those without, beside an island, at least 1, the more
  /// the nearer its border is; 0 for others.
  unsigned char* coverage = nullptr;
};
constexpr unsigned char full_coverage = 255;

constexpr int max_channels = 4;
constexpr int max_image_side = 65535;

/// What a texture means, which decides how its texels are averaged.
enum class TextureContent {
  data,     ///< numbers, such as roughness: as they are
  color,    ///< colors: as light. Integers are coded by sRGB, except a fourth channel or that of two
  normals,  ///< a tangent-space normal (2 c - 1) in the first three channels: turned into the new tangent frame
};
enum class TextureWrap {
  repeat,
  mirror,
  clamp,
  black,  ///< beyond the border all channels are 0, also the opacity
};

struct RebakeOptions {
  TextureContent content = TextureContent::data;
  /// The second or fourth channel is the opacity; other channels count in proportion to it.
  bool has_opacity = false;
  bool is_nearest = false;  ///< look up the nearest texel instead of interpolating
  std::array<TextureWrap, 2> wrap{TextureWrap::repeat, TextureWrap::repeat};  ///< along u and v, outside [0, 1]
};

/// Two UV maps of the same triangles. UVs begin at the lower left of the image. A triangle with a UV that is not
/// finite, or without area in the new map, is left out.
struct MapPair {
  const double* old_uv = nullptr;  ///< (C, 2)
  const double* new_uv = nullptr;  ///< (C, 2)
  const int* triangles = nullptr;  ///< (n_triangles, 3) corners
  int n_triangles = 0;
  /// For TextureContent::normals, at each corner: the normal (C, 3), and (C, 4) the tangents of both maps: the
  /// direction of growing u, and the side of growing v, 1 or -1, as in glTF.
  const float* normals = nullptr;
  const float* old_tangents = nullptr;
  const float* new_tangents = nullptr;
};

/// Draws a texture anew, for another map of the same surface: every texel of the target gets what the source has at the
/// same points of the surface. A texel is the mean of samples, so close that neighbors are at most a texel of the
/// source apart, but at most 32 by 32; only samples within a triangle count. Texels without samples show beside an
/// island what its border does, unless those of an earlier piece are nearer; others stay. target: of the same number of
/// channels, at most max_channels; sides at most max_image_side.
/// Returns which texels have samples, (height, width). Throws Cancelled.
std::vector<unsigned char> rebake_texture(const ImageView& source, const MapPair& maps, const RebakeOptions& options,
                                          const TargetImage& target, const Progress& progress);

/// Likewise draws values given at corners, (C, target.n_channels), linear between them. Colors are linear light.
/// Of the maps, only new_uv and triangles are used, and of the options, content (data or color) and has_opacity.
std::vector<unsigned char> bake_corner_values(const float* values, const MapPair& maps, const RebakeOptions& options,
                                              const TargetImage& target, const Progress& progress);

}  // namespace spectral_conformal
