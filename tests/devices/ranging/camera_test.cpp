// SPDX-License-Identifier: BSD-3-Clause
#include "devices/ranging/camera.hpp"

#include <gmock/gmock.h>

#include <cstring>

#include "shoal/image_t.hpp"
#include "sim/base/number.hpp"
#include "sim/image/image_file.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/ranging/camera_worlds.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

using namespace camera_worlds;

using testing::HasSubstr;

TEST(Camera, TakesUberSimsImagesUnlessToldOtherwise) {
  test::TestWorld test(test::rover_world(camera()));
  test::Listener<shoal::image_t> images(test, "r1.camera");
  test.run_for(1);
  const auto all = images.take_all();
  ASSERT_EQ(all.size(), 20u);
  const shoal::image_t& image = all.back();
  EXPECT_EQ(image.width, 320);
  EXPECT_EQ(image.height, 240);
  EXPECT_EQ(image.row_stride, 960);
  EXPECT_EQ(image.size, 320 * 240 * 3);
  EXPECT_EQ(image.pixelformat, 859981650);  // RGB
  // 160 / tan(22.5 degrees)
  EXPECT_THAT(metadata(image, "optics"), HasSubstr("lens: pinhole, width: 320, height: 240, focal_px: [386.27"));
}

/// Mean and variance of the levels of a wall that fills the image, which is grey.
std::pair<double, double> levels_of_a_wall(const std::string& keys) {
  test::TestWorld test(
      test::rover_world(camera(std::string(small) + ", image: grey, fov_deg: 1, truth: true" + keys), wall_ahead));
  test::Listener<shoal::image_t> images(test, "r1.camera"), truths(test, "r1.camera.truth");
  test.run_for(0.4);
  const auto image = images.last(), truth = truths.last();
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    const double error = static_cast<std::uint8_t>(image.data[i]) - static_cast<std::uint8_t>(truth.data[i]);
    sum += error, squares += error * error;
  }
  const double n = static_cast<double>(image.data.size());
  return {sum / n, squares / n - sum / n * sum / n};
}

TEST(Camera, NoiseHasTheMeanAndVarianceAskedFor) {
  const auto [mean, variance] = levels_of_a_wall(", noise: {gaussian_std: 5, bias: 3}");
  constexpr double n = 64 * 48, rounding = 1 / 12.0;
  EXPECT_NEAR(mean, 3, 4 * 5 / std::sqrt(n));
  EXPECT_NEAR(variance, 25 + rounding, 4 * 25 * std::sqrt(2 / n));
  EXPECT_EQ(levels_of_a_wall(""), std::pair(0.0, 0.0));
}

TEST(Camera, ShotNoiseHasTheVarianceOfItsElectrons) {
  const auto level =
      static_cast<std::uint8_t>(image_of(std::string(small) + ", image: grey, fov_deg: 1", wall_ahead).data[1000]);
  const double light = sim::linear_from_srgb(level);
  const double full = 2000, read = 10;
  // From linear light to levels by the slope of the sRGB curve there.
  const double slope = 1.0 / (sim::linear_from_srgb(static_cast<std::uint8_t>(level + 1)) - light);
  const double expected = (light / full + read * read / (full * full)) * slope * slope + 1 / 12.0;
  const auto [mean, variance] = levels_of_a_wall(", full_well_electrons: 2000, read_noise_electrons: 10");
  EXPECT_NEAR(mean, 0, 0.3);  // the curve is bent
  EXPECT_NEAR(variance, expected, 0.12 * expected);
}

TEST(Camera, DepthNoiseGrowsWithTheSquareOfDepth) {
  const auto image = image_of(std::string(small) + ", image: depth, depth_noise_per_m: 0.002", wall_ahead);
  double sum = 0, squares = 0;
  constexpr int n = 64 * 20;  // the upper rows see nothing but the wall
  for (int row = 0; row < 20; ++row)
    for (int column = 0; column < 64; ++column) {
      const double depth = value_at<float>(image, column, row);
      sum += depth, squares += depth * depth;
    }
  EXPECT_NEAR(std::sqrt(squares / n - sum / n * sum / n), 0.002 * 9, 4 * 0.018 / std::sqrt(2.0 * n));
}

TEST(Camera, AutoExposureMakesTheMeanAMiddleGrey) {
  const auto image = image_of(std::string(small) + ", image: grey, fov_deg: 1, exposure: {auto: true}", wall_ahead);
  EXPECT_NEAR(static_cast<std::uint8_t>(image.data[0]), 118, 2);  // 18 % in sRGB
}

TEST(Camera, SeesItsOwnVehicleOnlyWhenAsked) {
  const std::string down = std::string(small) + ", image: segmentation_vehicles, rpy_deg: [0, 60, 0]";
  EXPECT_EQ(metadata(image_of(down), "labels"), "1 ground\n");
  EXPECT_THAT(metadata(image_of(down + ", sees_own_vehicle: true"), "labels"), HasSubstr("2 r1\n"));
}

/// A table that turns at 2 rad/s, and whose camera looks at a pole at 0.2 s.
std::string turntable_world(const std::string& keys, double step_s = 0.001) {
  return R"(
shoal: 1
physics: {gravity_mps2: 0, step_s: )" +
         std::to_string(step_s) + R"(}
objects:
  - {name: pole, fixed: true, position_m: [4, 0, 0], parts: [{shape: cylinder, radius_m: 0.05, length_m: 10}]}
vehicles:
  - name: r1
    rpy_deg: [0, 0, -23]
    model:
      shoal: 1
      vehicle: table
      bodies:
        - {name: base, parts: [{shape: box, mass_kg: 1e6, size_m: [0.1, 0.1, 0.1], position_m: [0, 0, -3]}]}
        - {name: table, parts: [{shape: cylinder, radius_m: 0.1, length_m: 0.1, mass_kg: 1, position_m: [0, 0, -2]}]}
      joints: [{name: axle, type: hinge, bodies: [base, table], axis: [0, 0, 1],
                motor_velocity: 2, motor_max_force: 1000}]
      devices:
        - {name: camera, type: camera, body: table, width: 200, height: 101)" +
         keys + "}\n";
}

const std::string at_5_hz = ", rate_hz: 5, phase_s: 0.2, focal_px: [200]";

shoal::image_t image_from_a_turntable(const std::string& keys, double step_s = 0.001) {
  test::TestWorld test(turntable_world(keys, step_s));
  test::Listener<shoal::image_t> images(test, "r1.camera");
  test.run_for(0.205);
  return images.last();
}

double middle_of_pole(const shoal::image_t& image, int row) {
  double sum = 0;
  int pixels = 0;
  for (int column = 0; column < image.width; ++column)
    if (value_at<std::uint16_t>(image, column, row) == 1) sum += column + 0.5, ++pixels;
  return pixels > 0 ? sum / pixels : NAN;
}

TEST(Camera, RollingShutterTiltsAPoleByTheAngleOfTheReadout) {
  const auto global = image_from_a_turntable(at_5_hz + labels);
  const double middle = middle_of_pole(global, 50);
  ASSERT_FALSE(std::isnan(middle));
  EXPECT_NEAR(middle_of_pole(global, 0), middle, 0.6);  // upright
  const auto rolling = image_from_a_turntable(at_5_hz + labels + ", readout_s: 0.05");
  // The last row is at the time of the sample; the first one 0.05 s before: 0.1 rad of turning.
  const double last = middle_of_pole(rolling, 100), first = middle_of_pole(rolling, 0);
  EXPECT_NEAR(last, middle, 0.6);
  const double angle_last = std::atan((last - 100) / 200), angle_first = std::atan((first - 100) / 200);
  EXPECT_NEAR(std::abs(angle_first - angle_last), 0.1, 1.0 / 200);  // a pixel
}

/// Angle by which the camera turned from the first row to the last one, as the pole shows it.
double tilt_rad(const shoal::image_t& image, double focal_px) {
  const auto angle_rad = [&](int row) { return std::atan((middle_of_pole(image, row) - 100) / focal_px); };
  return std::abs(angle_rad(100) - angle_rad(0));
}

TEST(Camera, RollingShutterTakesItsTimeAtARateThatDoesNotDivideTheStep) {
  // 33.3 ms in steps of 10 ms: the image at 0.2 s follows the one at 0.17 s, and its first row is at 0.167 s.
  const auto image =
      image_from_a_turntable(labels + ", rate_hz: 30, phase_s: 0, focal_px: [800], readout_s: 0.033", 0.01);
  EXPECT_NEAR(tilt_rad(image, 800), 2 * 0.033, 1.0 / 800);  // a pixel
}

TEST(Camera, RollingShutterTakesItsTimeAfterAChangeOfTheRate) {
  test::TestWorld test(turntable_world(labels + ", rate_hz: 20, phase_s: 0, focal_px: [400], readout_s: 0.05"));
  test::Listener<shoal::image_t> images(test, "r1.camera");
  test.run_for(0.2);
  EXPECT_THAT(test.change("r1/camera", "{rate_hz: 100}"), HasSubstr("'readout_s' must be at most 1 / rate_hz"));
  EXPECT_THAT(test.change("r1/camera", "{rate_hz: every_step}"),
              HasSubstr("'readout_s' needs a 'rate_hz', not every_step"));
  // Four periods of 50.25 ms: the next image is in the next step, and begins long before the last one was finished.
  ASSERT_EQ(test.change("r1/camera", "{rate_hz: 19.9}"), "");
  images.take_all();
  test.run_for(0.0015);
  EXPECT_NEAR(tilt_rad(images.last(), 400), 2 * 0.05, 1.0 / 400);
}

/// Columns of the middle row that are not like the sky at its ends.
int width_of_pole(const shoal::image_t& image) {
  const auto level = [&](int column) { return int{value_at<std::uint8_t>(image, column, 50)}; };
  int columns = 0;
  for (int column = 0; column < image.width; ++column) columns += std::abs(level(column) - level(0)) > 2;
  return columns;
}

TEST(Camera, MotionBlurSmearsAnEdgeByTheWayOfTheExposure) {
  const std::string grey = at_5_hz + ", image: grey";
  const auto sharp = image_from_a_turntable(grey);
  const auto blurred = image_from_a_turntable(grey + ", exposure_time_s: 0.05, blur_samples: 32");
  ASSERT_NEAR(width_of_pole(sharp), 5, 1);  // 0.1 m at 4 m
  // 2 rad/s for 0.05 s at 200 px: 20 px.
  EXPECT_NEAR(width_of_pole(blurred) - width_of_pole(sharp), 20, 2);
}

TEST(Camera, MotionBlurOfACameraThatStandsStillIsASharpImage) {
  const auto sharp = image_of(small, wall_ahead, 0.4),
             blurred = image_of(std::string(small) + ", exposure_time_s: 0.01, blur_samples: 4", wall_ahead, 0.4);
  double error = 0;
  for (std::size_t i = 0; i < sharp.data.size(); ++i)
    error += std::abs(static_cast<std::uint8_t>(sharp.data[i]) - static_cast<std::uint8_t>(blurred.data[i]));
  EXPECT_LT(error / static_cast<double>(sharp.data.size()), 0.5);
}

TEST(Camera, CountsTheRaysThatTheNextStepCasts) {
  const auto rays_of = [](const std::string& keys, double run_s) {
    test::TestWorld test(test::rover_world(camera(std::string(small) + ", phase_s: 0" + keys)));
    test.run_for(run_s);
    return test.world.find_device("r1/camera")->rays();
  };
  EXPECT_EQ(rays_of("", 0.05), 0);
  EXPECT_EQ(rays_of("", 0.099), 64 * 48);
  EXPECT_EQ(rays_of("", 0.1), 0);
  EXPECT_EQ(rays_of(", antialias: 2", 0.099), 64 * 48 * 4);
  // A row each ms.
  EXPECT_EQ(rays_of(", readout_s: 0.047", 0.04), 0);
  EXPECT_EQ(rays_of(", readout_s: 0.047", 0.07), 64);
}

TEST(Camera, RefusesAStereoPairWhoseImagesDoNotFit) {
  const std::pair<const char*, const char*> cases[] = {
      {"right_of: middle", "'right_of': the vehicle has no other camera 'middle'"},
      {"right_of: right", "'right_of': the vehicle has no other camera 'right'"},
      {"width: 320", "'right_of': its lens and size must be those of 'left'"},
      {"phase_s: 0.01", "'right_of': it needs rate_hz and phase_s, equal to those of 'left'"},
      {"lens: fisheye", "'right_of': a stereo pair needs pinholes without distortion"},
      {"readout_s: 0.02", "'right_of': its readout_s and exposure_time_s must be those of 'left'"},
      {"body: left_wheel", "'right_of': it must be on the body of 'left'"},
      {"position_m: [0, 0.2, 0.4]", "in its frame it is at [0, 0.14, 0], turned by 0 deg"},
      {"rpy_deg: [0, 0, 1]", "'right_of': it must look as 'left' does, from a place to the right of it"}};
  for (const auto& [key, error] : cases) {
    // The key replaces the one that the pair has.
    std::string pair = stereo_pair();
    const std::string text(key), name = text.substr(0, text.find(':') + 1);
    if (const auto at = pair.find(name); at != std::string::npos) {
      std::size_t end = at;
      for (int depth = 0; depth > 0 || (pair[end] != ',' && pair[end] != '}'); ++end)
        depth += pair[end] == '[' ? 1 : pair[end] == ']' ? -1 : 0;
      pair.replace(at, end - at, text);
    } else {
      pair.insert(pair.find("}"), ", " + text);
    }
    EXPECT_THAT(test::error_of_world(test::rover_world(pair)), HasSubstr(error)) << key;
  }
}

TEST(Camera, IsTheSameForAnyNumberOfThreads) {
  const std::string cameras =
      "        - {name: a, type: camera, width: 64, height: 48, position_m: [0, 0, 0.4], noise: {gaussian_std: 2}}\n"
      "        - {name: b, type: camera, width: 64, height: 48, position_m: [0, 0, 0.4], image: depth, readout_s: "
      "0.02}\n";
  std::set<std::uint64_t> hashes;
  for (const int threads : {1, 2, 8}) {
    test::TestWorld test(test::rover_world(cameras, wall_ahead));
    test.world.use_threads(threads);
    test.run_for(0.33);
    hashes.insert(test.world.state().hash());
  }
  EXPECT_EQ(hashes.size(), 1u);
}

TEST(Camera, SaysWhatIsWrongWithItsParameters) {
  const std::pair<const char*, const char*> cases[] = {
      {"width: 0", "'width' must be >= 1 and <= 8192, got 0"},
      {"height: 100000", "'height' must be >= 1 and <= 8192, got 100000"},
      {"fov_deg: 0", "'fov_deg' must be > 0 and <= 359, got 0"},
      {"fov_deg: 200", "'fov_deg' of a pinhole must be > 0 and < 180, got 200"},
      {"image: infrared", "'image' must be one of: rgb, grey, depth"},
      {"encoding: raw16", "'raw16' is for images of depth"},
      {"image: depth, encoding: jpeg", "'jpeg' is for images rgb and grey"},
      {"width: 4000, height: 4000, antialias: 2", "'antialias' makes more than 16000000 rays"},
      {"readout_s: 0.01, exposure_time_s: 0.01", "either 'readout_s' or 'exposure_time_s'"},
      {"readout_s: 0.2", "'readout_s' must be at most 1 / rate_hz, got 0.2 s at 20 Hz"},
      {"exposure_time_s: 0.1, rate_hz: every_step", "'exposure_time_s' needs a 'rate_hz', not every_step"},
      {"fov_deg: 1e-310", "'fov_deg' must make a focal length >= 0.001 and <= 1e+09 pixels, got inf"},
      {"focal_px: [1e-320]", "'focal_px' must make a focal length >= 0.001 and <= 1e+09 pixels, got 9.99989e-321"},
      {"width: 4000, height: 1400", "must have at most 16711680 bytes, got 16800000"},
      {"image: depth, width: 2400, height: 1800", "must have at most 16711680 bytes, got 17280000"},
      {"exposure: {gain: 0}", "'gain' must be > 0"},
      {"see_through: [fog]", "category 'fog'"},
      {"distortion: [-3]", "'distortion' folds the image over"}};
  for (const auto& [keys, error] : cases)
    EXPECT_THAT(test::error_of_world(test::rover_world(camera(std::string(", ") + keys))), HasSubstr(error)) << keys;
}

}  // namespace
