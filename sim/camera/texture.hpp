// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/image/image.hpp"
#include "sim/scene/material.hpp"

namespace sim {

/// Red, green and blue in linear light.
using LinearColor = Eigen::Vector3f;

/// Converts an sRGB color to linear light.
LinearColor linear_color(const Color& srgb);

/// Image with filtered copies at half, a quarter, ... of its size, against aliasing at a distance (Williams 1983).
class ImagePyramid {
 public:
  explicit ImagePyramid(Image8 image);
  int width() const { return levels_.front().width; }
  int height() const { return levels_.front().height; }
  /// Returns the color at a position in pixels of the largest image, from its top left corner.  The image repeats
  /// periodically.  `footprint_px`: size of the projected pixel.
  LinearColor sample(double u_px, double v_px, double footprint_px) const;

 private:
  std::vector<Image8> levels_;
};

/// Pattern on a surface.
class Texture {
 public:
  /// `image` is null unless the pattern is an image.
  Texture(const TextureConfig& config, std::shared_ptr<const ImagePyramid> image);
  /// Returns the color at a surface point with the given normal, both in the frame P of the part.  The pattern is
  /// projected along the axis of P closest to the normal.  Along z, u is x and v is y; along x, u is y and v is z;
  /// along y, u is x and v is z.  The first field, and the lower left corner of an image, begin at the origin of P.
  /// `footprint_m`: size of the projected pixel on the surface.
  LinearColor color(const Vector3d& p_P, const Vector3d& normal_P, double footprint_m) const;

 private:
  TextureConfig::Pattern pattern_;
  double size_m_;
  LinearColor colors_[2];
  std::shared_ptr<const ImagePyramid> image_;
};

/// Cache of decoded image files, shared by materials and cameras.  Thread-safe.
class TextureLibrary {
 public:
  /// Returns the texture; null for the pattern `none`.  Throws ConfigError, with the position of the texture in its
  /// YAML file, when the image cannot be read.
  std::shared_ptr<const Texture> get(const TextureConfig& config, const std::string& who);

 private:
  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<const ImagePyramid>> images_;
};

}  // namespace sim
