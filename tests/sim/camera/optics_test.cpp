// SPDX-License-Identifier: BSD-3-Clause
#include "sim/camera/optics.hpp"

#include <gmock/gmock.h>

#include "sim/config/param_reader.hpp"

namespace {

using sim::degrees_to_radians;
using sim::Optics;
using sim::OpticsConfig;
using sim::Vector2d;
using sim::Vector3d;

using Lens = OpticsConfig::Lens;

OpticsConfig lens(Lens kind, double fov_deg, std::vector<double> distortion = {}) {
  OpticsConfig config;
  config.lens = kind;
  config.fov_rad = degrees_to_radians(fov_deg);
  config.distortion = std::move(distortion);
  return config;
}

/// The largest distance, px, between a pixel and the image of its own direction.
double worst_round_trip(const Optics& optics) {
  double worst = 0;
  for (int row = 0; row < optics.height(); row += 7)
    for (int column = 0; column < optics.width(); column += 7) {
      const Vector2d pixel(column + 0.5, row + 0.5);
      const auto direction = optics.direction_S(pixel.x(), pixel.y());
      if (!direction) return INFINITY;
      worst = std::max(worst, (*optics.project(*direction * 3) - pixel).norm());
    }
  return worst;
}

TEST(Optics, TheMiddleOfTheImageLooksAlongX) {
  for (const auto& [word, kind] : OpticsConfig::lens_words)
    EXPECT_LT((*Optics(lens(kind, 60)).direction_S(160, 120) - Vector3d::UnitX()).norm(), 1e-15) << word;
}

TEST(Optics, TheSidesOfTheImageAreHalfTheFieldOfViewAway) {
  for (const auto& [word, kind] : OpticsConfig::lens_words) {
    const Optics optics(lens(kind, 90));
    const double root = std::sqrt(0.5);
    EXPECT_LT((*optics.direction_S(0, 120) - Vector3d(root, root, 0)).norm(), 1e-12) << word;     // left is +y
    EXPECT_LT((*optics.direction_S(320, 120) - Vector3d(root, -root, 0)).norm(), 1e-12) << word;  // right
  }
}

TEST(Optics, TheTopRowLooksUp) {
  const Optics optics(lens(Lens::pinhole, 90));
  // f = 160 px, 120 px above the middle.
  EXPECT_LT((*optics.direction_S(160, 0) - Vector3d(160, 0, 120).normalized()).norm(), 1e-12);
}

TEST(Optics, AFisheyeSeesAnglesInProportionToTheDistanceFromTheMiddle) {
  const Optics optics(lens(Lens::fisheye, 180));
  // 160 px for 90 degrees.
  for (const double u : {10.0, 80.0, 160.0}) {
    const Vector3d direction = *optics.direction_S(160 - u, 120);
    EXPECT_NEAR(std::atan2(direction.y(), direction.x()), std::numbers::pi / 2 * u / 160, 1e-12);
  }
  // Behind the camera, which a pinhole never sees.
  const Optics wide(lens(Lens::fisheye, 300));
  EXPECT_LT(wide.direction_S(1, 120)->x(), -0.8);
}

TEST(Optics, DistortionFollowsOpenCvsFormula) {
  const double k1 = -0.3, k2 = 0.1, p1 = 0.002, p2 = -0.001, k3 = -0.01;
  OpticsConfig config = lens(Lens::pinhole, 60, {k1, k2, p1, p2, k3});
  config.focal_px = {300, 310};
  config.principal_px = {150, 125};
  const double x = 0.3, y = -0.2, s = x * x + y * y;
  const double radial = 1 + k1 * s + k2 * s * s + k3 * s * s * s;
  const double u = 150 + 300 * (x * radial + 2 * p1 * x * y + p2 * (s + 2 * x * x));
  const double v = 125 + 310 * (y * radial + p1 * (s + 2 * y * y) + 2 * p2 * x * y);
  const Optics optics(config);
  EXPECT_LT((*optics.project({1, -x, -y}) - Vector2d(u, v)).norm(), 1e-10);
  EXPECT_LT((*optics.direction_S(u, v) - Vector3d(1, -x, -y).normalized()).norm(), 1e-10);
}

TEST(Optics, AFisheyesDistortionFollowsOpenCvsFormula) {
  const std::vector<double> k = {-0.02, 0.004, -0.001, 0.0002};
  OpticsConfig config = lens(Lens::fisheye, 180, k);
  config.focal_px = {100};
  const double angle = 1.1, s = angle * angle;
  const double radius = angle * (1 + s * (k[0] + s * (k[1] + s * (k[2] + s * k[3]))));
  const Vector2d place = *Optics(config).project({std::cos(angle), -std::sin(angle), 0});
  EXPECT_LT((place - Vector2d(160 + 100 * radius, 120)).norm(), 1e-10);
}

TEST(Optics, PixelsSurviveTheWayOutAndBack) {
  EXPECT_LT(worst_round_trip(Optics(lens(Lens::pinhole, 60))), 1e-9);
  EXPECT_LT(worst_round_trip(Optics(lens(Lens::pinhole, 80, {-0.28, 0.07, 2e-4, 2e-5, 0}))), 1e-6);
  EXPECT_LT(worst_round_trip(Optics(lens(Lens::pinhole, 60, {0.2, 0.1, -1e-3, 1e-3, 0.05}))), 1e-6);
  EXPECT_LT(worst_round_trip(Optics(lens(Lens::fisheye, 200, {-0.01, 0.002, 0, 0}))), 1e-6);
}

TEST(Optics, AFisheyeIsBlackBeyondItsLargestAngle) {
  OpticsConfig config = lens(Lens::fisheye, 180);
  config.max_angle_rad = degrees_to_radians(80);
  const Optics optics(config);
  EXPECT_FALSE(optics.direction_S(1, 120));  // 89 degrees
  EXPECT_TRUE(optics.direction_S(40, 120));  // 67 degrees
  EXPECT_FALSE(optics.project(Vector3d::UnitY()));
  EXPECT_EQ(config.problem(), "");
  EXPECT_TRUE(sim::make_pixel_rays(optics, 1)->row(120)[1].isZero());
}

TEST(Optics, APinholeDoesNotSeeBehindItself) {
  EXPECT_FALSE(Optics(lens(Lens::pinhole, 120)).project({-1, 0.1, 0}));
}

TEST(Optics, RaysAreSpreadEvenlyInAPixel) {
  const Optics optics(lens(Lens::pinhole, 60));
  const auto rays = sim::make_pixel_rays(optics, 2);
  ASSERT_EQ(rays->directions_S.size(), 4u * 320 * 240);
  EXPECT_LT((rays->row(1)[4].cast<double>() - *optics.direction_S(2.25, 0.75)).norm(), 1e-7);  // float
}

/// What is wrong with a lens as a user writes it.
std::string error_of(const std::string& yaml) {
  sim::Diagnostics diagnostics;
  const auto node = sim::parse_config_text(yaml, "lens.yaml", diagnostics);
  OpticsConfig config;
  sim::ParamReader reader(node, "camera", diagnostics);
  config.read(reader);
  reader.finish();
  return diagnostics.lines().empty() ? "" : testing::PrintToString(diagnostics.lines());
}

TEST(Optics, SaysWhatIsWrongWithALensOnce) {
  using testing::HasSubstr;
  const std::pair<const char*, const char*> cases[] = {
      {"{fov_deg: 0}", "'fov_deg' must be > 0 and <= 359, got 0"},
      {"{fov_deg: 360, lens: fisheye}", "'fov_deg' must be > 0 and <= 359, got 360"},
      {"{fov_deg: 180}", "'fov_deg' of a pinhole must be > 0 and < 180, got 180"},
      {"{width: 0}", "'width' must be >= 1 and <= 8192, got 0"},
      {"{height: 100000}", "'height' must be >= 1 and <= 8192, got 100000"},
      {"{width: 8000, height: 8000}", "'width' x 'height' must be at most 16000000 pixels, got 8000 x 8000"},
      {"{fov_deg: 90, distortion: [-0.5]}", "'distortion' folds the image over at pixel (0, 0)"},
      {"{fov_deg: 90, distortion: [0, 0, 0, 0, 0, 1]}", "'distortion' of a pinhole must have at most 5 numbers, got 6"},
      {"{lens: fisheye, distortion: [0, 0, 0, 0, 0]}", "'distortion' of a fisheye must have at most 4 numbers, got 5"},
      {"{lens: fisheye, fov_deg: 180, distortion: [-0.3]}", "'distortion' folds the image over"},
      {"{focal_px: [1, 2, 3]}", "'focal_px' must have 1 or 2 numbers, got 3"},
      {"{focal_px: [300], fov_deg: 40}", "needs either 'fov_deg' or 'focal_px', not both"},
      {"{principal_px: [3]}", "'principal_px' must have 2 numbers, got 1"},
      {"{lens: mirror}", "'lens' must be one of: pinhole, fisheye"}};
  for (const auto& [yaml, error] : cases) {
    const std::string reported = error_of(yaml);
    EXPECT_THAT(reported, HasSubstr(error)) << yaml;
    EXPECT_EQ(reported.find("lens.yaml", reported.find("lens.yaml") + 1), std::string::npos) << reported;
  }
  EXPECT_EQ(error_of("{lens: fisheye, fov_deg: 220}"), "");
  EXPECT_EQ(error_of("{focal_px: [458.654, 457.296], principal_px: [367.2, 248.4], width: 752, height: 480, "
                     "distortion: [-0.2834, 0.0740, 0.000194, 0.0000176]}"),  // EuRoC's left camera
            "");
}

}  // namespace
