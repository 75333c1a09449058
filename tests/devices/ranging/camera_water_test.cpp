// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <set>

#include "devices/ranging/camera.hpp"
#include "shoal/image_t.hpp"
#include "sim/image/image.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/ranging/camera_worlds.hpp"
#include "tests/devices/state_fixture.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

using namespace camera_worlds;

using testing::HasSubstr;

/// A vehicle that floats 4 m under water without weight, before a gray wall at this distance of its camera.
std::string diver(const std::string& keys, double distance_m = 3, const std::string& medium = "medium: {water: {}}\n") {
  return "shoal: 1\nrun: {seed: 5}\nphysics: {gravity_mps2: " +
         std::string(medium.find("waves") == std::string::npos ? "0" : "9.81") + ", step_s: 0.005}\n" + medium +
         "objects:\n  - {name: wall, fixed: true, position_m: [" + std::to_string(distance_m + 0.5) +
         ", 0, -4], parts: [{shape: box, size_m: [1, 50, 50], color: \"#a0a0a0\"}]}\n"
         "vehicles:\n  - name: r1\n    position_m: [0, 0, -4]\n"
         "    model:\n      shoal: 1\n      vehicle: diver\n"
         "      bodies: [{name: hull, parts: [{shape: sphere, radius_m: 0.1, mass_kg: 1e6}]}]\n"
         "      devices:\n        - {name: camera, type: camera, width: 41, height: 31, rate_hz: 10, phase_s: 0" +
         keys + "}\n";
}

struct Dive : test::TestWorld {
  explicit Dive(const std::string& yaml, double run_s = 0.21) : TestWorld(yaml), images(*this, "r1.camera") {
    run_for(run_s);
  }
  const devices::Camera& camera() {
    return dynamic_cast<const devices::Camera&>(*world.find_device("r1/camera")->sensor());
  }
  test::Listener<shoal::image_t> images;
};

const std::string plain = ", water: {jerlov: II, details: false}";

TEST(CameraWater, IsInvisibleUnlessAskedFor) {
  const auto dry = Dive(diver("", 3, "")).images.last(), wet = Dive(diver("")).images.last();
  EXPECT_EQ(dry.data, wet.data);
  const auto seen = Dive(diver(plain)).images.last();
  EXPECT_NE(wet.data, seen.data);
  // One key switches off what the others switch on.
  const auto without = Dive(diver(", water: {jerlov: II, caustics: false, particles_per_m3: 0}")).images.last();
  const auto details = Dive(diver(", water: {jerlov: II}")).images.last();
  EXPECT_EQ(seen.data, without.data);
  EXPECT_NE(seen.data, details.data);
}

TEST(CameraWater, HasTheLevelsOfBeerAndLambert) {
  const sim::LightConfig light;
  const double day = light.sky + light.to_sun_W().z() * light.sun;
  const sim::WaterOptics water = sim::water_optics(sim::JerlovType::II);
  for (const double distance_m : {1.0, 3.0, 10.0}) {
    Dive dry(diver("", distance_m)), wet(diver(plain, distance_m));
    const float* before = dry.camera().light().at(20, 15);
    const float* after = wet.camera().light().at(20, 15);
    for (int i = 0; i < 3; ++i) {
      const double c = water.attenuation[i], at_depth = std::exp(-4.0 * water.downward[i]);
      const double left = std::exp(-c * distance_m);
      const double expected =
          before[i] * at_depth * left + 0.25 * day * water.scattering[i] * at_depth * (1 - left) / c;
      EXPECT_NEAR(after[i], expected, 0.01 * expected) << distance_m << " m, color " << i;
      EXPECT_NEAR(int{wet.camera().levels().at(20, 15)[i]}, int{sim::srgb_from_linear(static_cast<float>(expected))}, 1)
          << distance_m << " m, color " << i;
    }
  }
}

TEST(CameraWater, IsTheSameForAnyNumberOfThreads) {
  std::set<std::uint64_t> hashes;
  for (const int threads : {1, 2, 8}) {
    test::TestWorld test(diver(", water: {jerlov: III}, lamps: [{position_m: [0, 0.2, 0]}], readout_s: 0.05", 3,
                               "medium: {water: {}, waves: {type: jonswap, hs_m: 0.5, tp_s: 4}}\n"));
    test.world.use_threads(threads);
    test.run_for(0.33);
    hashes.insert(test.world.state().hash());
  }
  EXPECT_EQ(hashes.size(), 1u);
}

TEST(CameraWater, GoesOnAlikeAfterASnapshot) {
  test::SavedRun run(
      diver(", water: {jerlov: III}, exposure: {auto: true, white_balance: gray_world}, lamps: "
            "[{position_m: [0, 0.2, 0]}], exposure_time_s: 0.05",
            3, "medium: {water: {}, waves: {type: jonswap, hs_m: 0.5, tp_s: 4}}\n"));
  run.expect_restored_worlds_go_on_alike({17, 40}, 40);
}

TEST(CameraWater, BalancesItsColors) {
  const auto means = [](const shoal::image_t& image) {
    std::array<double, 3> sums{};
    for (std::size_t i = 0; i < image.data.size(); ++i)
      sums[i % 3] += static_cast<double>(sim::linear_from_srgb(static_cast<std::uint8_t>(image.data[i])));
    for (double& sum : sums) sum /= static_cast<double>(image.data.size()) / 3;
    return sums;
  };
  const auto blue = means(Dive(diver(plain + ", exposure: {auto: true}")).images.last());
  EXPECT_LT(blue[0], 0.5 * blue[2]);
  const auto gray = means(Dive(diver(plain + ", exposure: {auto: true, white_balance: gray_world}")).images.last());
  for (const double mean : gray) EXPECT_NEAR(mean, 0.18, 0.01);
  const auto fixed = means(Dive(diver(plain + ", exposure: {color_gains: [2, 1, 1]}")).images.last());
  const auto raw = means(Dive(diver(plain)).images.last());
  EXPECT_NEAR(fixed[0], 2 * raw[0], 0.03 * fixed[0]);
  EXPECT_NEAR(fixed[2], raw[2], 1e-9);
}

TEST(CameraWater, ShotNoiseKeepsTheLevelsOfBalancedColors) {
  // At 60 m the blue of the clearest water is far above the mean: 1e9 electrons have no noise that shows.
  const std::string deep = "medium: {water: {surface_m: 56}}\n";
  const std::string keys = ", water: {jerlov: I, details: false}, exposure: {auto: true, white_balance: gray_world}";
  Dive without(diver(keys, 3, deep)), with(diver(keys + ", full_well_electrons: 1e9", 3, deep));
  const auto& expected = without.camera().levels().data;
  const auto& levels = with.camera().levels().data;
  ASSERT_EQ(levels.size(), expected.size());
  EXPECT_GT(*std::max_element(expected.begin(), expected.end()), 50);
  for (std::size_t i = 0; i < levels.size(); ++i) EXPECT_NEAR(int{levels[i]}, int{expected[i]}, 1) << i;
}

TEST(CameraWater, LampsBringBackRedInTheDark) {
  const std::string deep = "medium: {water: {surface_m: 200}}\n", lamp = ", lamps: [{strength: 5, beam_deg: 100}]";
  Dive dark(diver(plain, 2, deep)), lit(diver(plain + lamp, 2, deep));
  EXPECT_EQ(int{dark.camera().levels().at(20, 15)[0]}, 0);
  const float* rgb = lit.camera().light().at(20, 15);
  EXPECT_GT(rgb[0], 0.1F);
  EXPECT_LT(rgb[0], rgb[2]);
}

TEST(CameraWater, GivesNormalsInItsFrame) {
  Dive dive(diver(", image: normals, rpy_deg: [0, 0, 20]"));
  const auto image = dive.images.last();
  EXPECT_EQ(image.pixelformat, devices::pixel_format_float_3);
  EXPECT_EQ(image.size, 41 * 31 * 12);
  // The wall faces -x of the world.
  const float* normal = dive.camera().vectors().at(20, 15);
  EXPECT_NEAR(normal[0], -std::cos(sim::degrees_to_radians(20)), 1e-6);
  EXPECT_NEAR(normal[1], std::sin(sim::degrees_to_radians(20)), 1e-6);
  EXPECT_NEAR(normal[2], 0, 1e-6);
  EXPECT_EQ(Dive(diver(", image: normals, encoding: png")).images.last().pixelformat, devices::pixel_format_png);
}

TEST(CameraWater, GivesOpticalFlowOfItsMotion) {
  // Sideways to the left at 0.4 m/s, and ahead at 0.3 m/s, 3 m before a wall: u' = f Y' / Z, v' = (v - cy) Z' / Z.
  Dive dive(diver(", image: flow, focal_px: [50]"), 0.02);
  dive.world.find_vehicle("r1")->base().set_velocity_W({0.3, 0.4, 0}, sim::Vector3d::Zero());
  dive.run_for(0.1);
  const auto image = dive.images.last();
  EXPECT_EQ(image.pixelformat, devices::pixel_format_float_2);
  const double depth_m = 3 - dive.world.find_vehicle("r1")->base().X_WB().translation().x();
  const float* middle = dive.camera().vectors().at(20, 15);
  EXPECT_NEAR(middle[0], 50 * 0.4 / depth_m, 0.05);
  EXPECT_NEAR(middle[1], 0, 1e-4);
  const float* low = dive.camera().vectors().at(20, 30);
  EXPECT_NEAR(low[1], 15 * 0.3 / depth_m, 0.02);
}

TEST(CameraWater, RefractsAtAFlatPort) {
  // A thin port at the pupil: the tangent of a ray in the water is that of asin(sin / n).
  const std::string port = ", image: depth, depth_along: ray, focal_px: [30], flat_port: {distance_m: 0, glass_m: 0}";
  Dive wet(diver(port)), dry(diver(port, 3, ""));
  const double angle = std::atan(20 / 30.0), in_water = std::asin(std::sin(angle) / sim::water_index);
  EXPECT_NEAR(*wet.camera().depth_m().at(40, 15), 3 / std::cos(in_water), 1e-4);
  EXPECT_NEAR(*dry.camera().depth_m().at(40, 15), 3 / std::cos(angle), 1e-4);
}

TEST(CameraWater, SaysWhatIsWrongWithItsParameters) {
  const std::pair<const char*, const char*> cases[] = {
      {"water: {}", "needs exactly one of 'jerlov', 'chlorophyll_mgpm3' and 'visibility_m'"},
      {"water: {jerlov: II, visibility_m: 3}", "needs exactly one of"},
      {"water: {jerlov: IV}", "'jerlov' must be one of: unset, I, IA, IB, II, III, 1C"},
      {"water: {visibility_m: 0}", "'visibility_m' must be >= 0.1 and <= 1000000"},
      {"water: {jerlov: I}, image: depth", "'water' is for images rgb and grey"},
      {"lamps: [{beam_deg: 0}]", "'beam_deg' must be >= 1 and <= 180"},
      {"lamps: [{color: white}]", "'color' must be in the form \"#rrggbb\""},
      {"exposure: {white_balance: gray_world, color_gains: [2, 1, 1]}", "either 'white_balance' or 'color_gains'"},
      {"image: grey, exposure: {white_balance: gray_world}", "white_balance and color_gains are for images rgb"},
      {"image: flow, antialias: 2", "'antialias' is not for images normals and flow"},
      {"image: normals, exposure: {auto: true}", "'exposure' is not for images normals and flow"},
      {"flat_port: {distance_m: 0.5}", "'distance_m' must be >= 0 and <= 0.3"},
      {"image: flow, encoding: png", "must be raw for images flow"},
      {"flat_port: {glass_index: 0.5}", "'glass_index' must be >= 1 and <= 3"}};
  for (const auto& [keys, error] : cases)
    EXPECT_THAT(test::error_of_world(diver(std::string(", ") + keys)), HasSubstr(error)) << keys;
  EXPECT_THAT(test::error_of_world(diver(", water: {jerlov: I}", 3, "")), HasSubstr("'water': the world has no water"));
}

}  // namespace
