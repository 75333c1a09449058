// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/world_warnings.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "sim/vehicle/step_clock.hpp"
#include "tests/sim/medium/log_capture.hpp"

namespace {

using testing::ElementsAre;

TEST(WorldWarnings, EachKindOfBadMessageIsLoggedOnceAndAllAreCounted) {
  const test_support::LogCapture log;
  sim::StepClock clock{};
  sim::WorldWarnings warnings(clock);
  for (int i = 0; i < 3; ++i) warnings.bad_message("device 'r1/drive'", "too short");
  warnings.bad_message("device 'r1/drive'", "too long");
  EXPECT_EQ(warnings.bad_messages(), 4);
  EXPECT_EQ(log.text(),
            "device 'r1/drive': too short (ignored, at 0.000 s)\ndevice 'r1/drive': too long (ignored, at 0.000 s)\n");
}

TEST(WorldWarnings, AFloodOfKindsIsLoggedAHundredTimes) {
  const test_support::LogCapture log;
  sim::StepClock clock{};
  sim::WorldWarnings warnings(clock);
  for (int i = 0; i < 300; ++i) warnings.bad_message("client", std::to_string(i));
  const std::string text = log.text();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 100);
  EXPECT_EQ(warnings.bad_messages(), 300);
}

TEST(WorldWarnings, TheFirstOfEachIsKeptForTheEnd) {
  sim::StepClock clock{};
  sim::WorldWarnings warnings(clock);
  warnings.keep_for_end("a", "touched the ground");
  warnings.keep_for_end("a", "touched the wall");
  warnings.keep_for_end("b", "left the current");
  EXPECT_THAT(warnings.kept(), ElementsAre("a: touched the ground (at 0.00 s)", "b: left the current (at 0.00 s)"));
}

TEST(WorldWarnings, AFaultOfADeviceReachesTheListener) {
  const test_support::LogCapture log;
  sim::StepClock clock{};
  sim::WorldWarnings warnings(clock);
  std::vector<std::string> heard;
  warnings.listen_to_device_faults(
      [&](const std::string& device, const std::string& text) { heard.push_back(device + ": " + text); });
  warnings.device_fault("r1/servo", "overload");
  warnings.listen_to_device_faults(nullptr);
  warnings.device_fault("r1/servo", "again");
  EXPECT_THAT(heard, ElementsAre("r1/servo: overload"));
  EXPECT_THAT(log.text(), testing::HasSubstr("r1/servo: again"));
}

}  // namespace
