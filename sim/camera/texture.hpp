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

/// Linear red, green, blue.
using LinearColor = Eigen::Vector3f;

LinearColor linear_color(const Color& srgb);

/// An image with smaller and smaller copies of itself, so that it does not shimmer from afar.
class ImagePyramid {
 public:
  explicit ImagePyramid(Image8 image);
  int width() const { return levels_.front().width; }
  int height() const { return levels_.front().height; }
  /// At a place from its top left corner, in pixels of the largest image, repeated without end.  `footprint_px`: how
  /// large what looks at it is.
  LinearColor sample(double u_px, double v_px, double footprint_px) const;

 private:
  std::vector<Image8> levels_;
};

/// A pattern on a surface.
class Texture {
 public:
  /// `image` is null unless the pattern is one.
  Texture(const TextureConfig& config, std::shared_ptr<const ImagePyramid> image);
  /// The color at a point of the part, where its surface has this normal, both in the frame P of the part.  The
  /// pattern lies in the plane across the axis that the normal goes along most: on top and bottom u is along x and v
  /// along y, on the sides towards x u is along y, on those towards y along x, and v is along z.  The first field, and
  /// the lower left corner of the image, begin at the origin of P.  `footprint_m`: size of what looks at it.
  LinearColor color(const Vector3d& p_P, const Vector3d& normal_P, double footprint_m) const;

 private:
  TextureConfig::Pattern pattern_;
  double size_m_;
  LinearColor colors_[2];
  std::shared_ptr<const ImagePyramid> image_;
};

/// Decodes each image file once, however many materials and cameras use it.  May be used from several threads.
class TextureLibrary {
 public:
  /// Null for pattern `none`.  Throws ConfigError at the place of the texture when its file cannot be read.
  std::shared_ptr<const Texture> get(const TextureConfig& config, const std::string& who);

 private:
  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<const ImagePyramid>> images_;
};

}  // namespace sim
