// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "shoal/joint_command_t.hpp"
#include "shoal/wheel_encoder_t.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

/// One wheel is driven, so that the rover goes around and its wheels slip: the encoder does not care.
std::string encoder(const std::string& more) {
  return "        - {name: motor, type: joint_motor, joint: left, max_velocity: 100}\n"
         "        - {name: encoder, type: wheel_encoder, joints: [left, right], rate_hz: 100, truth: true" +
         more + "}\n";
}

void turn(test::TestWorld& test, double radps) {
  shoal::joint_command_t command{};
  command.velocity = radps;
  test.send("r1.motor.cmd", command);
}

TEST(WheelEncoder, CountsTheTurnsOfTheJointInWholeTicks) {
  test::TestWorld test(test::rover_world(encoder(", ticks_per_revolution: 500")));
  test::Listener<shoal::wheel_encoder_t> reports(test, "r1.encoder"), truths(test, "r1.encoder.truth");
  for (const double radps : {7.0, -9.0}) {
    turn(test, radps);
    test.run_for(2.0);
    const auto report = reports.last(), truth = truths.last();
    const sim::Vehicle& rover = *test.world.find_vehicle("r1");
    ASSERT_EQ(report.count, 2);
    EXPECT_THAT(report.joint, testing::ElementsAre("left", "right"));
    // The last sample may be up to 10 ms old.
    const double ticks = rover.joint("left").position() / (2 * std::numbers::pi) * 500;
    EXPECT_NEAR(static_cast<double>(report.ticks[0]), ticks, 1 + std::abs(radps) * 0.01 / (2 * std::numbers::pi) * 500);
    EXPECT_NEAR(report.rate_radps[0], radps, 2 * std::numbers::pi / 500 / 0.01);  // one tick in a period
    EXPECT_EQ(truth.ticks, report.ticks);                                         // nothing is missed
    EXPECT_NEAR(truth.rate_radps[0], radps, 0.05);
  }
}

TEST(WheelEncoder, MissesTicksWithTheProbabilityAskedFor) {
  test::TestWorld test(test::rover_world(encoder(", ticks_per_revolution: 1000, missed_ticks: 0.1")));
  test::Listener<shoal::wheel_encoder_t> reports(test, "r1.encoder"), truths(test, "r1.encoder.truth");
  turn(test, 20);
  test.run_for(10);
  const auto passed = static_cast<double>(truths.last().ticks[0]);
  ASSERT_GT(passed, 25000);
  // Four standard deviations of a binomial number.
  EXPECT_NEAR(static_cast<double>(reports.last().ticks[0]) / passed, 0.9, 4 * std::sqrt(0.1 * 0.9 / passed));
}

TEST(WheelEncoder, ErrorsOfTheAngleAddUp) {
  test::TestWorld test(test::rover_world(encoder(", ticks_per_revolution: 100000, noise: {gaussian_std: 0.01}")));
  test::Listener<shoal::wheel_encoder_t> reports(test, "r1.encoder"), truths(test, "r1.encoder.truth");
  test.run_for(20);
  const auto measured = reports.take_all(), truth = truths.take_all();
  double squares = 0, before = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double error = static_cast<double>(measured[i].ticks[1] - truth[i].ticks[1]) * 2 * std::numbers::pi / 100000;
    squares += std::pow(error - before, 2);
    before = error;
  }
  const auto count = static_cast<double>(truth.size());
  EXPECT_NEAR(std::sqrt(squares / count), 0.01, 4 * 0.01 / std::sqrt(2 * count));  // four standard deviations
}

TEST(WheelEncoder, SaysWhatIsWrongWithItsParameters) {
  const auto error_of = [](const std::string& keys) -> std::string {
    try {
      test::TestWorld test(test::rover_world("        - {name: encoder, type: wheel_encoder" + keys + "}\n"));
      return "";
    } catch (const sim::ConfigError& error) {
      return error.what();
    }
  };
  EXPECT_THAT(error_of(""), testing::HasSubstr("device 'encoder': missing key 'joints'"));
  EXPECT_THAT(error_of(", joints: []"), testing::HasSubstr("'joints' must name a joint"));
  EXPECT_THAT(error_of(", joints: [left], ticks_per_revolution: 0"),
              testing::HasSubstr("'ticks_per_revolution' must be >= 1"));
  EXPECT_THAT(error_of(", joints: [middle]"), testing::HasSubstr("'joints' names no joint 'middle'"));
}

}  // namespace
