// SPDX-License-Identifier: BSD-3-Clause
#include "sim/camera/optics.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "sim/image/image.hpp"

namespace sim {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Largest undistorted radius of a pinhole: 89.4 degrees off the axis.
constexpr double widest_pinhole = 100;

constexpr double min_focal_px = 1e-3, max_focal_px = 1e9;

/// Returns fx and fy in pixels.
Vector2d focal_px_of(const OpticsConfig& config) {
  if (!config.focal_px.empty()) return {config.focal_px.front(), config.focal_px.back()};
  const double half_rad = 0.5 * config.fov_rad;
  const double half_width_px = 0.5 * config.width;
  switch (config.lens) {
    case OpticsConfig::Lens::pinhole:
      return Vector2d::Constant(half_width_px / std::tan(half_rad));
    case OpticsConfig::Lens::fisheye:
      break;
  }
  return Vector2d::Constant(half_width_px / half_rad);
}

bool in_form(const std::vector<double>& values, std::size_t min, std::size_t max) {
  return values.empty() || (values.size() >= min && values.size() <= max);
}

}  // namespace

void OpticsConfig::read(ParamReader& in) {
  in.read("width", width, between(1, max_image_side_px), "pixels in a row");
  in.read("height", height, between(1, max_image_side_px), "rows");
  in.read_choice("lens", lens, lens_words, "projection of angles onto the image");
  in.read_deg("fov_deg", fov_rad, above_to(0, 359),
              "horizontal field of view, without the distortion; a pinhole's is < 180");
  in.read("focal_px", focal_px, above(0), "focal length, or fx and fy, instead of fov_deg");
  in.read("principal_px", principal_px, between(-max_image_side_px, 2 * max_image_side_px),
          "principal point, from the outer corner of the image; unset: its middle");
  in.read("distortion", distortion, any_number(),
          "pinhole: k1, k2, p1, p2, k3 (Brown-Conrady); fisheye: k1 to k4 (Kannala-Brandt); both as OpenCV has them");
  in.read_deg("max_angle_deg", max_angle_rad, above_to(0, 180), "fisheye: pixels farther off the axis are black");
  if (in.describing()) return;
  if (in.has("fov_deg") && in.has("focal_px")) in.error("focal_px", "needs either 'fov_deg' or 'focal_px', not both");
  // problem() knows values, not keys; the key that it quotes decides at which line of the file the error is reported.
  const std::string wrong = problem();
  if (wrong.empty()) return;
  for (const char* key : {"distortion", "principal_px", "focal_px", "fov_deg", "width"})
    if (wrong.find(std::string("'") + key + "'") != std::string::npos && in.has(key)) return in.error(key, wrong);
  in.error(wrong);
}

std::string OpticsConfig::problem() const {
  // Check sizes of the image and of the lists.
  if (width < 1 || height < 1 || width > max_image_side_px || height > max_image_side_px ||
      width * height > max_image_pixels)
    return fmt::format("'width' x 'height' must be at most {} pixels, got {} x {}", max_image_pixels, width, height);
  if (!in_form(focal_px, 1, 2)) return fmt::format("'focal_px' must have 1 or 2 numbers, got {}", focal_px.size());
  if (!in_form(principal_px, 2, 2))
    return fmt::format("'principal_px' must have 2 numbers, got {}", principal_px.size());
  const bool fisheye = lens == Lens::fisheye;
  const std::size_t max = fisheye ? 4 : 5;
  if (distortion.size() > max)
    return fmt::format("'distortion' of a {} must have at most {} numbers, got {}", word_of(lens_words, lens), max,
                       distortion.size());
  // Check the field of view and the focal length.
  if (focal_px.empty() && !fisheye && !(fov_rad > 0 && fov_rad < std::numbers::pi))
    return fmt::format("'fov_deg' of a pinhole must be > 0 and < 180, got {:g}", radians_to_degrees(fov_rad));
  if (!(fov_rad > 0 && fov_rad < 2 * std::numbers::pi))
    return fmt::format("'fov_deg' must be > 0 and < 360, got {:g}", radians_to_degrees(fov_rad));
  const Vector2d focal = focal_px_of(*this);
  for (const double f : focal)
    if (!(f >= min_focal_px && f <= max_focal_px))
      return fmt::format("'{}' must make a focal length >= {:g} and <= {:g} pixels, got {:g}",
                         focal_px.empty() ? "fov_deg" : "focal_px", min_focal_px, max_focal_px, f);
  const Optics optics(*this);
  // Check the border of the image: the distortion is smooth and grows outwards, so its inside is then valid too.
  for (int i = 0; i <= 16; ++i)
    for (const Vector2d& uv : {Vector2d(width * i / 16.0, 0), Vector2d(width * i / 16.0, height),
                               Vector2d(0, height * i / 16.0), Vector2d(width, height * i / 16.0)}) {
      if (optics.direction_S(uv.x(), uv.y())) continue;
      if (fisheye && !std::isfinite(optics.fold_radius())) continue;  // outside the image circle
      return fmt::format("'distortion' folds the image over at pixel ({:.0f}, {:.0f})", uv.x(), uv.y());
    }
  return {};
}

std::string OpticsConfig::text() const {
  const Optics optics(*this);
  const double cx = principal_px.empty() ? 0.5 * width : principal_px[0];
  const double cy = principal_px.empty() ? 0.5 * height : principal_px[1];
  return fmt::format(
      "{{lens: {}, width: {}, height: {}, focal_px: [{}, {}], principal_px: [{}, {}], distortion: [{}]{}}}",
      word_of(lens_words, lens), width, height, optics.focal_x_px(), optics.focal_y_px(), cx, cy,
      fmt::join(distortion, ", "),
      lens == Lens::fisheye ? fmt::format(", max_angle_deg: {}", radians_to_degrees(max_angle_rad)) : "");
}

Optics::Optics(const OpticsConfig& config) : config_(config), fisheye_(config.lens == OpticsConfig::Lens::fisheye) {
  // Sort the coefficients of OpenCV by their meaning.
  const std::vector<double>& k = config_.distortion;
  const auto number = [&](std::size_t i) { return i < k.size() ? k[i] : 0.0; };
  if (fisheye_) {
    for (std::size_t i = 0; i < 4; ++i) radial_[i] = number(i);
  } else {
    radial_[0] = number(0), radial_[1] = number(1), radial_[2] = number(4);
    p1_ = number(2), p2_ = number(3);
  }
  distorted_ = std::any_of(k.begin(), k.end(), [](double value) { return value != 0; });
  const Vector2d focal = focal_px_of(config_);
  fx_ = focal.x(), fy_ = focal.y();
  cx_ = config_.principal_px.empty() ? 0.5 * config_.width : config_.principal_px[0];
  cy_ = config_.principal_px.empty() ? 0.5 * config_.height : config_.principal_px[1];
  if (!(fx_ > 0 && fy_ > 0 && std::isfinite(fx_) && std::isfinite(fy_)))
    throw std::invalid_argument("a lens needs a focal length > 0");
  find_fold();
}

double Optics::distorted_radius(double r) const {
  const double s = r * r;
  return r * (1 + s * (radial_[0] + s * (radial_[1] + s * (radial_[2] + s * radial_[3]))));
}

double Optics::distorted_slope(double r) const {
  const double s = r * r;
  return 1 + s * (3 * radial_[0] + s * (5 * radial_[1] + s * (7 * radial_[2] + s * 9 * radial_[3])));
}

void Optics::find_fold() {
  const double end = fisheye_ ? config_.max_angle_rad : widest_pinhole;
  constexpr int steps = 4096;
  last_good_ = end;
  fold_radius_ = infinity;
  for (int i = 1; distorted_ && i <= steps; ++i) {
    // Steps of a pinhole are finer near the axis, because its radius grows as the tangent of the angle.
    const double share = static_cast<double>(i) / steps;
    const double r = fisheye_ ? end * share : end * share * share;
    if (distorted_slope(r) > 0) continue;
    last_good_ = fisheye_ ? end * (i - 1) / steps : end * (i - 1) / steps * (i - 1) / steps;
    fold_radius_ = distorted_radius(last_good_);
    return;
  }
}

double Optics::undistorted_radius(double distorted) const {
  if (!distorted_) return distorted;
  double low = 0, high = last_good_;
  // Bisection, then Newton's method to full precision; the curve is monotonic up to last_good_.
  for (int i = 0; i < 20; ++i) {
    const double middle = 0.5 * (low + high);
    (distorted_radius(middle) < distorted ? low : high) = middle;
  }
  double r = 0.5 * (low + high);
  for (int i = 0; i < 8; ++i) r = std::clamp(r - (distorted_radius(r) - distorted) / distorted_slope(r), low, high);
  return r;
}

Vector2d Optics::distort(const Vector2d& p) const {
  const double x = p.x(), y = p.y(), s = p.squaredNorm();
  const double factor = 1 + s * (radial_[0] + s * (radial_[1] + s * radial_[2]));
  return {x * factor + 2 * p1_ * x * y + p2_ * (s + 2 * x * x), y * factor + p1_ * (s + 2 * y * y) + 2 * p2_ * x * y};
}

Eigen::Matrix2d Optics::distort_slope(const Vector2d& p) const {
  const double x = p.x(), y = p.y(), s = p.squaredNorm();
  const double factor = 1 + s * (radial_[0] + s * (radial_[1] + s * radial_[2]));
  const double by_s = radial_[0] + s * (2 * radial_[1] + s * 3 * radial_[2]);  // d factor / d s
  Eigen::Matrix2d slope;
  slope << factor + 2 * x * x * by_s + 2 * p1_ * y + 6 * p2_ * x, 2 * x * y * by_s + 2 * p1_ * x + 2 * p2_ * y,
      2 * x * y * by_s + 2 * p1_ * x + 2 * p2_ * y, factor + 2 * y * y * by_s + 6 * p1_ * y + 2 * p2_ * x;
  return slope;
}

std::optional<Vector2d> Optics::undistort(const Vector2d& distorted) const {
  if (!distorted_) return distorted;
  const double radius = distorted.norm();
  if (radius == 0) return distorted;
  if (radius >= fold_radius_) return std::nullopt;
  // Newton's method from the solution for radial distortion.
  Vector2d p = distorted * (undistorted_radius(radius) / radius);
  for (int i = 0; i < 50; ++i) {
    const Vector2d error = distort(p) - distorted;
    const Eigen::Matrix2d slope = distort_slope(p);
    if (!(slope.determinant() > 0)) return std::nullopt;
    if (error.norm() < 1e-12 * (1 + radius)) return p;
    p -= slope.inverse() * error;
  }
  if ((distort(p) - distorted).norm() > 1e-9) return std::nullopt;
  return p;
}

std::optional<Vector3d> Optics::direction_S(double u, double v) const {
  const Vector2d distorted((u - cx_) / fx_, (v - cy_) / fy_);
  if (!fisheye_) {
    const auto p = undistort(distorted);
    if (!p) return std::nullopt;
    return Vector3d(1, -p->x(), -p->y()).normalized();
  }
  const double radius = distorted.norm();
  // Beyond the fold of the distortion two directions share a pixel; such pixels stay black.
  if (radius >= fold_radius_ || radius > distorted_radius(last_good_)) return std::nullopt;
  // sin(angle) / radius below would be 0 / 0.
  if (radius == 0) return Vector3d::UnitX();
  const double angle = undistorted_radius(radius);
  const double side = std::sin(angle) / radius;
  return Vector3d(std::cos(angle), -distorted.x() * side, -distorted.y() * side);
}

std::optional<Vector2d> Optics::project(const Vector3d& p_S) const {
  Vector2d place;
  if (fisheye_) {
    const double across = std::hypot(p_S.y(), p_S.z());
    const double angle = std::atan2(across, p_S.x());
    if (angle > last_good_) return std::nullopt;
    const double radius = distorted_radius(angle);
    place = across > 0 ? Vector2d(Vector2d(-p_S.y(), -p_S.z()) * (radius / across)) : Vector2d::Zero();
  } else {
    // Behind the camera the division would mirror the point into the image.
    if (!(p_S.x() > 0)) return std::nullopt;
    const Vector2d ideal(-p_S.y() / p_S.x(), -p_S.z() / p_S.x());
    if (distorted_ && ideal.norm() > last_good_) return std::nullopt;
    place = distort(ideal);
  }
  return Vector2d(cx_ + fx_ * place.x(), cy_ + fy_ * place.y());
}

void FlatPortConfig::read(ParamReader& in) {
  in.read("distance_m", distance_m, between(0, 0.3), "from the entrance pupil of the lens to the glass");
  in.read("glass_m", glass_m, between(0, 0.2), "thickness of the glass");
  in.read("glass_index", glass_index, between(1, 3), "refractive index of the glass; acrylic: 1.49");
}

std::shared_ptr<const PixelRays> make_pixel_rays(const Optics& optics, int per_side, const FlatPortConfig& port) {
  auto rays = std::make_shared<PixelRays>(*make_pixel_rays(optics, per_side));
  rays->refraction = water_index;
  rays->starts_S.assign(rays->directions_S.size(), Eigen::Vector3f::Zero());
  for (std::size_t i = 0; i < rays->directions_S.size(); ++i) {
    const Vector3d in_air = rays->directions_S[i].cast<double>();
    const double sine = std::hypot(in_air.y(), in_air.z());
    // What does not look through the glass sees nothing.
    if (in_air.x() < 1e-3) rays->directions_S[i].setZero();
    if (in_air.x() < 1e-3 || sine == 0) {
      rays->starts_S[i].x() = static_cast<float>(port.distance_m + port.glass_m);
      continue;
    }
    const Vector2d across(in_air.y() / sine, in_air.z() / sine);
    const double in_glass = sine / port.glass_index, in_water = sine / water_index;
    const double radius_m =
        port.distance_m * sine / in_air.x() + port.glass_m * in_glass / std::sqrt(1 - in_glass * in_glass);
    rays->starts_S[i] =
        Vector3d(port.distance_m + port.glass_m, radius_m * across.x(), radius_m * across.y()).cast<float>();
    rays->directions_S[i] =
        Vector3d(std::sqrt(1 - in_water * in_water), in_water * across.x(), in_water * across.y()).cast<float>();
  }
  return rays;
}

std::shared_ptr<const PixelRays> make_pixel_rays(const Optics& optics, int per_side) {
  auto rays = std::make_shared<PixelRays>();
  rays->optics.emplace(optics);
  rays->width = optics.width();
  rays->height = optics.height();
  rays->per_side = per_side;
  rays->pixel_angle = static_cast<float>(1 / (optics.focal_x_px() * per_side));
  rays->directions_S.reserve(std::size_t(rays->columns()) * std::size_t(rays->height) * std::size_t(per_side));
  for (int row = 0; row < optics.height() * per_side; ++row)
    for (int column = 0; column < rays->columns(); ++column) {
      const auto direction = optics.direction_S((column + 0.5) / per_side, (row + 0.5) / per_side);
      rays->directions_S.push_back(direction.value_or(Vector3d::Zero()).cast<float>());
    }
  return rays;
}

}  // namespace sim
