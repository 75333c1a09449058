// SPDX-License-Identifier: BSD-3-Clause
#include "sim/camera/texture.hpp"

#include <algorithm>
#include <filesystem>

#include "sim/image/image_file.hpp"

namespace sim {

namespace {

/// Returns the image at half width and height, rounded up, averaged in linear light.
Image8 halved(const Image8& image) {
  Image8 half((image.width + 1) / 2, (image.height + 1) / 2, 3);
  for (int row = 0; row < half.height; ++row)
    for (int column = 0; column < half.width; ++column)
      for (int channel = 0; channel < 3; ++channel) {
        float sum = 0;
        for (int i = 0; i < 4; ++i)
          sum += linear_from_srgb(image.at(std::min(2 * column + i % 2, image.width - 1),
                                           std::min(2 * row + i / 2, image.height - 1))[channel]);
        half.at(column, row)[channel] = srgb_from_linear(0.25F * sum);
      }
  return half;
}

LinearColor pixel(const Image8& image, long column, long row) {
  const auto wrap = [](long i, int n) { return static_cast<int>(i < 0 ? i % n + (i % n == 0 ? 0 : n) : i % n); };
  const std::uint8_t* rgb = image.at(wrap(column, image.width), wrap(row, image.height));
  return {linear_from_srgb(rgb[0]), linear_from_srgb(rgb[1]), linear_from_srgb(rgb[2])};
}

/// Returns the share of the second color between x - w/2 and x + w/2, where fields of length 1 alternate.
double share_of_second(double x, double w) {
  // Integral of the square wave that is 0 in [0, 1) and 1 in [1, 2).
  const auto integral = [](double t) {
    const double whole = std::floor(t / 2);
    return whole + std::max(0.0, t - 2 * whole - 1);
  };
  w = std::max(w, 1e-6);
  return std::clamp((integral(x + 0.5 * w) - integral(x - 0.5 * w)) / w, 0.0, 1.0);
}

}  // namespace

LinearColor linear_color(const Color& srgb) {
  return {linear_from_srgb(srgb[0]), linear_from_srgb(srgb[1]), linear_from_srgb(srgb[2])};
}

ImagePyramid::ImagePyramid(Image8 image) {
  levels_.push_back(std::move(image));
  while (levels_.back().width > 1 || levels_.back().height > 1) levels_.push_back(halved(levels_.back()));
}

LinearColor ImagePyramid::sample(double u_px, double v_px, double footprint_px) const {
  // Choose the level whose pixels match the footprint.
  std::size_t level = 0;
  double scale = 1;
  for (; level + 1 < levels_.size() && footprint_px * scale > 1.5; ++level) scale *= 0.5;
  const Image8& image = levels_[level];
  // Reduce the position to one period before the conversion to integers.
  const double u = std::fmod(u_px, width()) * scale - 0.5, v = std::fmod(v_px, height()) * scale - 0.5;
  // Bilinear interpolation.
  const double column = std::floor(u), row = std::floor(v);
  const auto a = static_cast<float>(u - column), b = static_cast<float>(v - row);
  const long i = static_cast<long>(column), j = static_cast<long>(row);
  return (1 - b) * ((1 - a) * pixel(image, i, j) + a * pixel(image, i + 1, j)) +
         b * ((1 - a) * pixel(image, i, j + 1) + a * pixel(image, i + 1, j + 1));
}

Texture::Texture(const TextureConfig& config, std::shared_ptr<const ImagePyramid> image)
    : pattern_(config.pattern), size_m_(config.size_m), image_(std::move(image)) {
  for (std::size_t i = 0; i < 2; ++i)
    colors_[i] =
        i < config.colors.size() ? linear_color(parse_color(config.colors[i]).value_or(Color{})) : LinearColor::Zero();
}

LinearColor Texture::color(const Vector3d& p_P, const Vector3d& normal_P, double footprint_m) const {
  // Project along the axis closest to the normal.
  int axis = 0;
  normal_P.cwiseAbs().maxCoeff(&axis);
  const double u = (axis == 0 ? p_P.y() : p_P.x()) / size_m_;
  const double v = (axis == 2 ? p_P.y() : p_P.z()) / size_m_;
  const double footprint = footprint_m / size_m_;
  // Share of the second color, averaged over the footprint.
  double second = 0;
  switch (pattern_) {
    case TextureConfig::Pattern::none:
      break;
    case TextureConfig::Pattern::checker: {
      const double a = share_of_second(u, footprint), b = share_of_second(v, footprint);
      second = a * (1 - b) + b * (1 - a);
      break;
    }
    case TextureConfig::Pattern::stripes:
      second = share_of_second(u, footprint);
      break;
    case TextureConfig::Pattern::image:
      return image_->sample(u * image_->width(), -v * image_->width(), footprint * image_->width());
  }
  return static_cast<float>(1 - second) * colors_[0] + static_cast<float>(second) * colors_[1];
}

std::shared_ptr<const Texture> TextureLibrary::get(const TextureConfig& config, const std::string& who) {
  if (config.pattern == TextureConfig::Pattern::none) return nullptr;
  std::shared_ptr<const ImagePyramid> image;
  if (config.pattern == TextureConfig::Pattern::image) {
    const std::string path = (std::filesystem::path(config.directory) / config.file).lexically_normal().string();
    // Cameras of all vehicles share an image, which is read by the first one.
    const std::lock_guard lock(mutex_);
    auto& known = images_[path];
    try {
      if (!known) known = std::make_shared<ImagePyramid>(read_image(path));
    } catch (const ImageError& error) {
      throw_config_error(config.place, who, "texture '" + path + "': " + error.what());
    }
    image = known;
  }
  return std::make_shared<Texture>(config, std::move(image));
}

}  // namespace sim
