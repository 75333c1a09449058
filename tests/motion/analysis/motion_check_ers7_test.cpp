// SPDX-License-Identifier: BSD-3-Clause
// `shoal motion check` against Sony's sheet for the ERS-7: each limit broken once is found once.

#include <gmock/gmock.h>

#include <filesystem>
#include <span>

#include "motion/analysis/motion_check.hpp"
#include "motion/analysis/motion_stage.hpp"
#include "motion/analysis/motion_tracking.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "tests/devices/joint/ers7_table.hpp"
#include "tests/project_paths.hpp"

namespace test::ers7 {
namespace {

using motion::MotionFinding;
using motion::MotionRule;

const sim::VehicleConfig& loaded_dog() {
  static const sim::VehicleConfig vehicle = sim::load_vehicle(test_support::source_path("vehicles/ers7.yaml"), {});
  return vehicle;
}

/// The findings of one rule in a motion of a few keys; angles in degrees.
std::vector<MotionFinding> findings_of(const std::vector<std::pair<double, sim::JointValues>>& keys_deg,
                                       MotionRule rule) {
  sim::JointMotion motion;
  motion.name = "m";
  for (const auto& [at_s, values] : keys_deg) {
    sim::MotionKey& key = motion.keys.emplace_back();
    key.at_s = at_s;
    for (const auto& [joint, value_deg] : values) key.joints.emplace_back(joint, value_deg / degrees);
  }
  std::vector<MotionFinding> found = motion::check_motion(motion, loaded_dog());
  std::erase_if(found, [&](const MotionFinding& one) { return one.rule != rule; });
  return found;
}

TEST(MotionCheckOfErs7, FindsEachOfTheTwentyRangesBrokenOnBothSides) {
  int joints = 0;
  for (const auto& row : axes) {
    SCOPED_TRACE(row.name);
    ++joints;
    const double middle = (row.low + row.high) / 2;
    for (const bool is_high : {false, true}) {
      const MotionRule rule = is_high ? MotionRule::high : MotionRule::low;
      const double limit = is_high ? row.high : row.low, outwards = is_high ? 1 : -1;
      const auto beyond = [&](double by_deg) {
        return findings_of(
            {{0, {{row.name, middle}}}, {8, {{row.name, limit + outwards * by_deg}}}, {16, {{row.name, middle}}}},
            rule);
      };
      EXPECT_THAT(beyond(0), testing::IsEmpty());
      const std::vector<MotionFinding> found = beyond(0.01);
      ASSERT_EQ(found.size(), 1u);
      EXPECT_EQ(found[0].joint, row.name);
      EXPECT_NEAR(found[0].at_s, 8, 1e-9);
      EXPECT_NEAR(found[0].limit * degrees, limit, 0.001);  // the file has five decimals of a radian
    }
  }
  EXPECT_EQ(joints, 20);
}

/// Least flap (J2) by the swing (J1), in whole degrees from and to which a row holds: table 2.1.2 of the sheet.  J1 of
/// rear legs is positive backward.
struct FlapRow {
  double from_deg, to_deg, low_deg;
};
constexpr FlapRow front_rows[] = {{-115, -76, -1}, {-75, -55, -2}, {-54, -46, -3}, {-45, -36, -4}, {-35, -31, -5},
                                  {-30, -26, -6},  {-25, -21, -7}, {-20, -16, -8}, {-15, -11, -9}, {-10, 20, -10},
                                  {21, 25, -9},    {26, 30, -8},   {31, 40, -7},   {41, 45, -6},   {46, 50, -5},
                                  {51, 55, -4},    {56, 65, -3},   {66, 130, -2}};
constexpr FlapRow rear_rows[] = {
    {-130, -71, 0}, {-70, -56, -1}, {-55, -46, -2}, {-45, -41, -3}, {-40, -36, -4}, {-35, -31, -5}, {-30, -26, -6},
    {-25, -21, -7}, {-20, -16, -8}, {-15, -11, -9}, {-10, 15, -10}, {16, 20, -9},   {21, 25, -8},   {26, 30, -7},
    {31, 35, -6},   {36, 40, -5},   {41, 45, -4},   {46, 50, -3},   {51, 60, -2},   {61, 70, -1},   {71, 115, 0}};

TEST(MotionCheckOfErs7, FindsEachOfThe39RowsOfTwoJointsBrokenAtBothOfItsEnds) {
  int rows = 0;
  for (const std::string leg : {"lf_", "rf_", "lh_", "rh_"}) {
    const std::span<const FlapRow> table = leg[1] == 'f' ? std::span<const FlapRow>(front_rows) : std::span(rear_rows);
    for (const FlapRow& row : table) {
      rows += leg[0] == 'l' ? 1 : 0;
      for (const double swing_deg : {row.from_deg, row.to_deg}) {
        SCOPED_TRACE(leg + " at " + std::to_string(swing_deg));
        const auto at = [&](double flap_deg) {
          return findings_of({{0, {{leg + "swing", swing_deg}, {leg + "flap", 0}}},
                              {8, {{leg + "flap", flap_deg}}},
                              {16, {{leg + "flap", 0}}}},
                             MotionRule::two_joint_low);
        };
        EXPECT_THAT(at(row.low_deg), testing::IsEmpty());
        const std::vector<MotionFinding> found = at(row.low_deg - 0.01);
        ASSERT_EQ(found.size(), 1u);
        EXPECT_EQ(found[0].joint, leg + "flap");
        EXPECT_NEAR(found[0].at_s, 8, 1e-9);
        EXPECT_NEAR(found[0].limit * degrees, row.low_deg, 1e-9);
      }
    }
  }
  EXPECT_EQ(rows, 39);
}

TEST(MotionCheckOfErs7, TakesTheMouthClosedWhereAMotionDoesNotNameIt) {
  // Table 2.1.2: while the mouth is between -30 and -3 degrees, the head nods at least to 5 degrees with the neck from
  // -75 degrees on, to -5 from -40 on.  0 is beyond the range of the mouth, which ends at -3.
  const auto nod = [](double neck_deg, double nod_deg, const sim::JointValues& mouth) {
    sim::JointValues first{{"neck_tilt", neck_deg}, {"head_nod", 10}};
    first.insert(first.end(), mouth.begin(), mouth.end());
    return findings_of({{0, first}, {8, {{"head_nod", nod_deg}}}, {16, {{"head_nod", 10}}}}, MotionRule::two_joint_low);
  };
  EXPECT_THAT(nod(0, -5, {}), testing::IsEmpty());
  const std::vector<MotionFinding> found = nod(0, -6, {});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].joint, "head_nod");
  EXPECT_NEAR(found[0].limit * degrees, -5, 1e-9);
  EXPECT_EQ(nod(-50, 4, {}).size(), 1u);
  EXPECT_THAT(nod(0, -6, {{"mouth", -40}}), testing::IsEmpty());
}

TEST(MotionCheckOfErs7, FindsEachSpeedBrokenOnce) {
  int joints = 0;
  for (const auto& row : axes) {
    if (row.frame_deg <= 0) continue;  // ears
    SCOPED_TRACE(row.name);
    ++joints;
    const double middle = (row.low + row.high) / 2;
    const auto frame_of = [&](double moved_deg) {
      return findings_of({{0, {{row.name, middle}}}, {0.008, {{row.name, middle + moved_deg}}}}, MotionRule::velocity);
    };
    EXPECT_THAT(frame_of(row.frame_deg * 0.999), testing::IsEmpty());
    const std::vector<MotionFinding> found = frame_of(-row.frame_deg * 1.001);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].joint, row.name);
    EXPECT_NEAR(found[0].limit * degrees * 0.008, row.frame_deg, 0.001);
  }
  EXPECT_EQ(joints, 18);
}

/// The dog of the thesis, of 15 axes, plays all of the twelve motions but the one of the tail and ears.
TEST(Ers7Seed, PlaysTheMotionsOfItsJoints) {
  motion::StageOptions options;
  options.world = test_support::source_path("worlds/ers7_seed_studio.yaml");
  options.kept_s = 0;
  int played = 0;
  for (const auto& file : std::filesystem::directory_iterator(test_support::source_path("vehicles/motions/ers7"))) {
    const sim::JointMotion motion = sim::load_motion(file.path().string());
    SCOPED_TRACE(motion.name);
    if (motion.name == "wag") {
      try {
        motion::MotionStage stage(options, motion);
        FAIL();
      } catch (const sim::ConfigError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("motion 'wag' names joint 'tail_tilt', which is not a servo"));
      }
      continue;
    }
    motion::MotionStage stage(options, motion);
    motion::MotionTracking tracking;
    stage.after_step = [&](motion::MotionStage& now) { tracking.add(now); };
    EXPECT_TRUE(stage.play_out(0, motion::end_limit_s(motion)));
    EXPECT_FALSE(tracking.has_fallen());
    EXPECT_LT(tracking.greatest_tilt_rad() * degrees, 25);  // the bound of ers7_show
    ++played;
  }
  EXPECT_EQ(played, 11);
}

}  // namespace
}  // namespace test::ers7
