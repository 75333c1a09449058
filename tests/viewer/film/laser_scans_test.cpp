// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/film/laser_scans.hpp"

#include <gtest/gtest.h>

#include <map>

#include "sim/bus/in_process_bus.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world_file/load_world.hpp"

namespace {

/// A robot that falls beside a wall whose face is the plane x = 3, with a laser of these keys.
struct Falling {
  explicit Falling(const std::string& laser)
      : loaded(sim::load_world_text(
            "shoal: 1\nphysics: {step_s: 0.01}\n"
            "objects:\n"
            "  - {name: wall, fixed: true, position_m: [3.5, 0, 0], parts: [{shape: box, size_m: [1, 100, 200]}]}\n"
            "vehicles:\n"
            "  - name: robot\n"
            "    position_m: [0, 0, 50]\n"
            "    model:\n"
            "      shoal: 1\n"
            "      bodies: [{name: body, parts: [{shape: box, size_m: [0.2, 0.2, 0.2], mass_kg: 1}]}]\n"
            "      devices: [{name: laser, rate_hz: 10, phase_s: 0, range_max_m: 20, " +
                laser + "}]\n",
            "test", {})),
        world(loaded.config, bus),
        scans(world) {
    scans.observe();
  }

  /// Runs steps, and notes the height of the robot after each.
  void run(int steps) {
    for (int i = 0; i < steps; ++i) {
      world.step();
      scans.observe();
      heights_m[world.now()] = world.find_vehicle("robot")->X_WV().translation().z();
    }
  }

  sim::LoadedWorld loaded;
  sim::InProcessBus bus;
  sim::World world;
  viewer::LaserScans scans;
  std::map<sim::Time, double> heights_m;
};

TEST(LaserScans, BeginWhereTheSensorWasWhenItMeasured) {
  Falling falling("type: lidar, beams: 3, fov_deg: 90");
  EXPECT_TRUE(falling.scans.scans().empty());
  falling.run(17);
  const auto scans = falling.scans.scans();
  ASSERT_EQ(scans.size(), 1U);
  const viewer::LaserScans::Scan& scan = *scans.at("robot/laser");
  EXPECT_EQ(scan.at, sim::from_seconds(0.1));
  ASSERT_EQ(scan.rays.size(), 3U);
  const double height_m = falling.heights_m.at(scan.at);
  EXPECT_LT(falling.heights_m.at(falling.world.now()), height_m - 0.05);  // it has fallen on since
  // At -45, 0 and 45 degrees: the face is met at y = -3, 0 and 3.
  for (int i = 0; i < 3; ++i) {
    const viewer::LaserScans::Ray& ray = scan.rays[static_cast<std::size_t>(i)];
    EXPECT_NEAR((ray.from_W - sim::Vector3d(0, 0, height_m)).norm(), 0, 1e-9);
    EXPECT_NEAR((ray.to_W - sim::Vector3d(3, 3 * (i - 1), height_m)).norm(), 0, 1e-6);
  }
}

TEST(LaserScans, HaveThePoseOfEachColumnOfARotation) {
  Falling falling("type: lidar3d, ring_angles_deg: [0], columns: 40");
  falling.run(45);
  const viewer::LaserScans::Scan& scan = *falling.scans.scans().at("robot/laser");
  EXPECT_EQ(scan.at, sim::from_seconds(0.4));
  // Azimuths from -180 degrees on, 9 degrees and 2.5 ms apart: those within 20 m of the face, |angle| < 81.4 degrees.
  ASSERT_EQ(scan.rays.size(), 19U);
  for (const viewer::LaserScans::Ray& ray : scan.rays) {
    EXPECT_NEAR(ray.to_W.x(), 3, 1e-3);
    EXPECT_NEAR(ray.to_W.z(), ray.from_W.z(), 1e-9);
  }
  // It falls while the head turns: 81 to -81 degrees are 45 ms at about 3.4 m/s.
  const double fallen_m = scan.rays.front().from_W.z() - scan.rays.back().from_W.z();
  EXPECT_NEAR(fallen_m, 0.045 * 9.80665 * 0.35, 0.01);
}

TEST(LaserScans, EndWhenTheSensorIsSilent) {
  Falling falling("type: lidar, beams: 1");
  falling.run(20);
  EXPECT_EQ(falling.scans.scans().at("robot/laser")->at, sim::from_seconds(0.2));
  falling.world.editor().set_fault("robot/laser", {.kind = sim::FaultKind::silent});
  falling.run(150);
  EXPECT_EQ(falling.scans.scans().at("robot/laser")->at, sim::from_seconds(0.2));
  falling.run(60);  // 2.1 s after the last one
  EXPECT_TRUE(falling.scans.scans().empty());
}

}  // namespace
