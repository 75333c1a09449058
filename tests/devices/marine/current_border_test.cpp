// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <fstream>

#include "tests/devices/world_fixture.hpp"
#include "tests/scratch_folder.hpp"

// Vehicles that leave the file of a current.

namespace {

using testing::HasSubstr;

class CurrentBorder : public ::testing::Test {
 protected:
  /// A current of 1 m/s to the east, from a file that ends at x = 10 m; the vehicle starts at x = 9.
  std::string said_by(const std::string& body, const std::string& devices) {
    std::ofstream(folder.file("flow.csv")) << "x_m,y_m,east_mps,north_mps\n0,-9,1,0\n10,-9,1,0\n0,9,1,0\n10,9,1,0\n";
    test::TestWorld test(
        "shoal: 1\nphysics: {step_s: 0.02}\nmedium: {water: {}, current: [{type: grid, outside: edge, file: " +
        folder.file("flow.csv") +
        "}]}\nvehicles:\n  - name: a\n    position_m: [9, 0, -10]\n    model:\n      shoal: 1\n"
        "      vehicle: drifter\n      bodies: [{name: hull, " +
        body + "}]\n      devices: [" + devices + "]\n");
    testing::internal::CaptureStdout();
    test.run_for(10);
    const std::string reported = testing::internal::GetCapturedStdout();
    EXPECT_GT(test.world.vehicles()[0]->X_WV().translation().x(), 10.5);
    EXPECT_EQ(test.world.counts().bad_messages, 0) << "nobody sent a message";
    return reported;
  }
  const test_support::ScratchFolder folder;
};

const std::string left = "body 'a/hull': has left the file of the current at 10";

TEST_F(CurrentBorder, ABodyInWaterThatLeavesItIsReportedWithTheTime) {
  const std::string reported = said_by(
      "parts: [{shape: sphere, radius_m: 0.1, density_kgpm3: 1025}], hydrodynamics: {mass_kg: 4, inertia_kgm2: [1, 1, "
      "1], linear_damping: [40, 40, 40, 1, 1, 1]}",
      "");
  EXPECT_THAT(reported, HasSubstr(left));
  EXPECT_THAT(reported, HasSubstr("(at 1."));
  EXPECT_EQ(reported.find("ignored"), std::string::npos) << reported;
  EXPECT_EQ(reported.find(left), reported.rfind(left)) << "once";
}

TEST_F(CurrentBorder, ANaiveVehicleThatLeavesItIsReportedToo) {
  const std::string body = "kinematic: true, parts: [{shape: sphere, radius_m: 0.1}]";
  const std::string reported = said_by(body, "{name: drive, type: naive_drive}");
  EXPECT_THAT(reported, HasSubstr(left));
  EXPECT_EQ(reported.find(left), reported.rfind(left)) << "once";
  EXPECT_EQ(said_by(body, "{name: drive, type: naive_drive, drifts: false, start_speed_mps: 1}"), "");
}

}  // namespace
