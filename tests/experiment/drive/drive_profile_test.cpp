// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/drive/drive_profile.hpp"

#include <gmock/gmock.h>

#include "bridges/control/spawned_vehicles.hpp"
#include "experiment/drive/drive_mapping.hpp"
#include "sim/device/device_registry.hpp"

namespace {

using testing::HasSubstr;

std::string profile_error(const std::string& text) {
  try {
    experiment::parse_drive_profile(text, "pad.yaml");
  } catch (const sim::ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(DriveProfile, SaysLineColumnAndRule) {
  EXPECT_THAT(profile_error("rate_hz: 1\n"), HasSubstr("pad.yaml:1:10: drive profile: 'rate_hz' must be >= 5"));
  EXPECT_THAT(profile_error("hold_s: 0.5\n"), HasSubstr("pad.yaml:1:9: drive profile: 'hold_s' must be"));
  EXPECT_THAT(profile_error("keys:\n  steps: [{key: w, axis: up}]\n"), HasSubstr("pad.yaml:2:26:"));
  EXPECT_THAT(profile_error("keys:\n  steps: [{key: space, axis: turn}]\n"), HasSubstr("key 'space' has two meanings"));
  EXPECT_THAT(profile_error("keys: {hold: control}\n"), HasSubstr("'hold' must be one character"));
  EXPECT_THAT(profile_error("gamepad: {axes: [{code: 1, axis: turn, low: 5, high: 5}]}\n"),
              HasSubstr("'high' must be above 'low'"));
  EXPECT_THAT(profile_error("spede: 1\n"), HasSubstr("unknown key 'spede'"));
  EXPECT_THAT(profile_error("crafts: [{name: a}]\n"), HasSubstr("missing key 'devices'"));
}

}  // namespace
