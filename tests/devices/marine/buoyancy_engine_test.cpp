// SPDX-License-Identifier: BSD-3-Clause
#include "devices/marine/buoyancy_engine.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "sim/world/world_editor.hpp"
#include "tests/devices/marine/marine_fixture.hpp"

namespace {

using devices::BuoyancyEngine;
using test::wet_device;
using test::WetBox;
using testing::HasSubstr;

const char* deep = "{water: {density_kgpm3: 1000, surface_m: 50}}";

/// Lift on top of the weight of the box.
double lift(WetBox& box) {
  return box.force_W().z() + 10 * 9.81;
}

TEST(BuoyancyEngine, LiftsByTheWeightOfTheWaterThatItDisplaces) {
  WetBox box(wet_device("type: buoyancy_engine, max_m3: 0.001, min_m3: -0.002, rate_m3ps: 1000"), deep, 9.81);
  EXPECT_NEAR(lift(box), 0, 1e-9);
  box.command(0.0005);
  EXPECT_NEAR(lift(box), 0.0005 * 1000 * 9.81, 1e-9);
  box.command(-0.01);
  EXPECT_NEAR(lift(box), -0.002 * 1000 * 9.81, 1e-9);
}

TEST(BuoyancyEngine, TakesFractionsOfItsLimits) {
  WetBox box(wet_device("type: buoyancy_engine, command: fraction, max_m3: 0.001, min_m3: -0.002, rate_m3ps: 1000"),
             deep, 9.81);
  box.command(0.5);
  EXPECT_NEAR(lift(box), 0.0005 * 1000 * 9.81, 1e-9);
  box.command(-0.5);
  EXPECT_NEAR(lift(box), -0.001 * 1000 * 9.81, 1e-9);
}

TEST(BuoyancyEngine, PumpsAtItsRateAndPaysForThePressure) {
  WetBox box(wet_device("type: buoyancy_engine, rate_m3ps: 1e-5, efficiency: 0.4"), deep, 9.81);
  box.set_velocity({0, 0, 0});
  box.command(1e-4);
  box.run_for(0.5);
  EXPECT_NEAR(box.device<BuoyancyEngine>().volume_m3(), 5e-6, 1e-15);
  const double depth = 50 - box.body.X_WB().translation().z();
  EXPECT_NEAR(box.device<BuoyancyEngine>().power_W(), 1000 * 9.81 * depth * 1e-5 / 0.4, 1e-3 * 12);
  box.command(-1e-4);
  box.run_for(0.01);
  EXPECT_EQ(box.device<BuoyancyEngine>().power_W(), 0);
}

TEST(BuoyancyEngine, TurnsTheVehicleByItsPlaceAndFadesAtTheSurface) {
  WetBox box(wet_device("type: buoyancy_engine, position_m: [0.4, 0, 0], rate_m3ps: 1000"), deep, 9.81);
  box.command(2e-4);
  EXPECT_NEAR(box.torque_W().y(), -0.4 * 2e-4 * 1000 * 9.81, 1e-9);
  WetBox afloat(wet_device("type: buoyancy_engine, rate_m3ps: 1000"), "{water: {density_kgpm3: 1000}}", 9.81);
  afloat.command(2e-4);
  EXPECT_NEAR(lift(afloat), 1e-4 * 1000 * 9.81, 1e-9);
  WetBox dry(wet_device("type: buoyancy_engine, rate_m3ps: 1000"), "{}", 9.81);
  dry.command(2e-4);
  EXPECT_NEAR(lift(dry), 0, 1e-9);
}

TEST(BuoyancyEngine, HoldsParksOrEmptiesWhenItsCommandsAreStale) {
  for (const auto& [safe, volume] : {std::pair{"hold", 1e-6}, {"park", 2.5e-4}, {"stop", 0.0}}) {
    WetBox box(wet_device("type: buoyancy_engine, rate_m3ps: 1e-3, watchdog_s: 0.0005, safe: " + std::string(safe)));
    box.command(1e-5);
    box.run_for(1);
    EXPECT_NEAR(box.device<BuoyancyEngine>().volume_m3(), volume, 1e-12) << safe;
  }
}

TEST(BuoyancyEngine, WithoutEffortItsVolumeStays) {
  WetBox box(wet_device("type: buoyancy_engine, initial_m3: 1e-4"));
  box.world.editor().set_fault("v/d", {.kind = sim::FaultKind::dead});
  box.command(0);
  box.run_for(0.1);
  EXPECT_EQ(box.device<BuoyancyEngine>().volume_m3(), 1e-4);
}

TEST(BuoyancyEngine, SaysWhatIsWrongWithItsParameters) {
  const auto error = [](const std::string& keys) { return test::error_of_device("type: buoyancy_engine, " + keys); };
  EXPECT_THAT(error("initial_m3: 1"), HasSubstr("'initial_m3' must lie between 'min_m3' and 'max_m3'"));
  EXPECT_THAT(error("park_m3: -1"), HasSubstr("'park_m3' must lie between 'min_m3' and 'max_m3'"));
  EXPECT_THAT(error("min_m3: 1"), HasSubstr("'min_m3' must be"));
  EXPECT_THAT(error("rate_m3ps: 0"), HasSubstr("'rate_m3ps' must be > 0, got 0"));
  EXPECT_EQ(error("initial_m3: 1e-4"), "");
}

}  // namespace
